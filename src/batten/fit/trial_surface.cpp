#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/fit/loop_trial.h"
#include "batten/fit/triangle_point.h"

namespace batten {

namespace {

FreePlace fixed_place(const Eigen::Vector3d& place) { return {{place[0], place[1], place[2]}, {}}; }

/// The neighbours of a vertex, summed over its faces.
struct RingSum {
  FreePlace all;
  FreePlace sharp;
  int count = 0;
  int sharp_count = 0;
  std::int64_t ends = 0;  ///< 0 where the faces close around the vertex

  void add(Index next, Index last, bool is_sharp, const FreePlace& place) {
    add_scaled(1.0, place, all);
    ++count;
    ends += static_cast<std::int64_t>(next) - last;
    if (!is_sharp) return;
    add_scaled(1.0, place, sharp);
    ++sharp_count;
  }
  bool is_open() const { return ends != 0; }
  bool is_corner() const { return sharp_count > 2; }
  FreePlace bend(const FreePlace& own) const {
    FreePlace way = own;
    if (sharp_count == 2) {
      add_scaled(-0.5, sharp, way);
    } else {
      add_scaled(-1.0 / count, all, way);
    }
    return way;
  }
};

}  // namespace

/// The ways of free control points and of their neighbours from the means of what is around them.
void LoopTrial::find_bends() {
  const std::size_t count = vertices_.size();
  std::vector<std::uint8_t> near(count, 0);
  for (Index f = 0; f < local_.asked; ++f) {
    const std::array<Index, 3>& c = local_.faces[static_cast<std::size_t>(f)];
    if (std::none_of(c.begin(), c.end(),
                     [&](Index v) { return std::find(free_.begin(), free_.end(), vertices_[v]) != free_.end(); }))
      continue;
    for (const Index v : c) near[v] = 1;
  }
  std::vector<RingSum> sums(count);
  for (Index f = 0; f < local_.asked; ++f) {
    for (int c = 0; c < 3; ++c) {
      const Index v = local_.faces[f][c];
      const Index next = local_.faces[f][(c + 1) % 3];
      if (near[v] != 0) sums[v].add(next, local_.faces[f][(c + 2) % 3], local_.sharp[3 * f + c] != 0, places_[next]);
    }
  }
  bends_.clear();
  bent_.clear();
  for (Index v = 0; v < static_cast<Index>(count); ++v) {
    if (near[v] == 0) continue;
    bent_.push_back(vertices_[v]);
    if (sums[v].is_open() || sums[v].is_corner()) continue;
    bends_.push_back(sums[v].bend(places_[v]));
  }
  for (const Index v : {move_.a, move_.b}) {
    if (std::find(bent_.begin(), bent_.end(), v) == bent_.end()) bent_.push_back(v);
  }
}

double LoopTrial::bends_before() const {
  double sum = 0.0;
  for (const Index v : bent_) {
    if (v == state_->vertex_end()) continue;
    RingSum ring;
    for (const Index f : state_->fan(v)) {
      const std::array<Index, 3>& c = state_->face(f);
      const std::size_t i = static_cast<std::size_t>(std::find(c.begin(), c.end(), v) - c.begin());
      const Index next = c[(i + 1) % 3];
      ring.add(next, c[(i + 2) % 3], state_->is_sharp(v, next), fixed_place(state_->place(next)));
    }
    if (ring.is_open() || ring.is_corner()) continue;
    for (const double number : ring.bend(fixed_place(state_->place(v))).fixed) sum += number * number;
  }
  return fairness_ * sum;
}

double LoopTrial::bends_after() const {
  double sum = 0.0;
  for (const FreePlace& bend : bends_) sum += at(bend).squaredNorm();
  return fairness_ * sum;
}

Eigen::Vector3d LoopTrial::at(const FreePlace& place) const {
  Eigen::Vector3d sum(place.fixed[0], place.fixed[1], place.fixed[2]);
  for (std::size_t k = 0; k < free_.size(); ++k) sum += place.weights[k] * free_place_[k];
  return sum;
}

/// Computes the corners and normals of the facets.
void LoopTrial::place_facets() {
  const std::span<const FreePlace> places = surface_.places();
  corners_.resize(places.size());
  for (std::size_t v = 0; v < places.size(); ++v) corners_[v] = at(places[v]);
  normals_.resize(static_cast<std::size_t>(surface_.facet_count()));
  for (Index f = 0; f < surface_.facet_count(); ++f) {
    const std::array<Index, 3> c = surface_.facet(f);
    normals_[f] = (corners_[c[1]] - corners_[c[0]]).cross(corners_[c[2]] - corners_[c[0]]);
  }
}

void LoopTrial::project(LocalPoint& point) {
  const Eigen::Vector3d p = state_->points().row(point.point).transpose();
  Eigen::Vector2d shares;
  const auto square_of = [&](Index facet) {
    const std::array<Index, 3> c = surface_.facet(facet);
    const Eigen::Vector3d& from = corners_[c[0]];
    const Eigen::Vector3d u = corners_[c[1]] - from;
    const Eigen::Vector3d v = corners_[c[2]] - from;
    shares = nearest_in_triangle(p - from, u, v);
    return (p - from - shares[0] * u - shares[1] * v).squaredNorm();
  };
  if (point.facet < 0) {
    point.square = std::numeric_limits<double>::infinity();
    for (Index f = 0; f < local_.asked; ++f) {
      if (!edited_[static_cast<std::size_t>(f)].fresh) continue;
      // The middle facet of each quarter tells where to look.
      for (const Index middle : {3, 7, 11, 15}) {
        const double square = square_of(kFacetsOfFace * f + middle);
        if (square >= point.square) continue;
        point.square = square;
        point.facet = kFacetsOfFace * f + middle;
      }
    }
  }
  point.square = square_of(point.facet);
  for (bool nearer = true; nearer;) {
    nearer = false;
    // A point above the inside of a facet has its foot there.
    if (shares[0] > 0.0 && shares[1] > 0.0 && shares[0] + shares[1] < 1.0) return;
    const Eigen::Vector2d here = shares;
    const Index from = point.facet;
    for (int side = 0; side < 3; ++side) {
      const bool on_side = side == 0 ? here[1] <= 0.0 : side == 1 ? here[0] + here[1] >= 1.0 : here[0] <= 0.0;
      const Index other = on_side ? surface_.across(from, side) : -1;
      if (other < 0) continue;
      const Eigen::Vector2d best = shares;
      const double square = square_of(other);
      if (square >= point.square) {
        shares = best;
        continue;
      }
      point.square = square;
      point.facet = other;
      nearer = true;
    }
  }
}

double LoopTrial::project_all() {
  double sum = 0.0;
  for (LocalPoint& point : points_) {
    project(point);
    sum += point.square;
  }
  return sum;
}

/// One step of the free control points: distances along the facets' normals count, and a little those across.
void LoopTrial::step() {
  constexpr double kAcross = 0.05;
  constexpr double kAlongNormal = 0.9;
  constexpr double kDamping = 1e-4;
  const auto count = static_cast<Eigen::Index>(free_.size());
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMostFree, 3 * kMostFree>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMostFree, 1>;
  Matrix left = Matrix::Zero(3 * count, 3 * count);
  Vector right = Vector::Zero(3 * count);
  const std::span<const FreePlace> places = surface_.places();
  for (const LocalPoint& point : points_) {
    const std::array<Index, 3> c = surface_.facet(point.facet);
    const Eigen::Vector3d p = state_->points().row(point.point).transpose();
    const Eigen::Vector2d shares =
        nearest_in_triangle(p - corners_[c[0]], corners_[c[1]] - corners_[c[0]], corners_[c[2]] - corners_[c[0]]);
    const double of[3] = {1.0 - shares[0] - shares[1], shares[0], shares[1]};
    const Eigen::Vector3d offset = p - of[0] * corners_[c[0]] - of[1] * corners_[c[1]] - of[2] * corners_[c[2]];
    std::array<double, kMostFree> weights{};
    double all = 0.0;
    for (int k = 0; k < 3; ++k) {
      for (Eigen::Index j = 0; j < count; ++j) weights[j] += of[k] * places[static_cast<std::size_t>(c[k])].weights[j];
    }
    for (Eigen::Index j = 0; j < count; ++j) all += weights[j];
    if (!(all > 0.0)) continue;
    const Eigen::Vector3d normal = normals_[static_cast<std::size_t>(point.facet)].normalized();
    const double along = normal.dot(offset);
    // Beside boundaries and sharp edges the offset leans away from the normal: then all of it counts.
    const bool leans = along * along < kAlongNormal * offset.squaredNorm();
    const double across = leans ? 1.0 : kAcross;
    Eigen::Matrix3d form = (1.0 - across) * normal * normal.transpose();
    form.diagonal().array() += across;
    const Eigen::Vector3d pull = form * offset;
    for (Eigen::Index j = 0; j < count; ++j) {
      right.segment<3>(3 * j) += weights[j] * pull;
      for (Eigen::Index k = 0; k <= j; ++k) left.block<3, 3>(3 * j, 3 * k) += (weights[j] * weights[k]) * form;
    }
  }
  for (const FreePlace& bend : bends_) {
    const Eigen::Vector3d way = at(bend);
    for (Eigen::Index j = 0; j < count; ++j) {
      right.segment<3>(3 * j) -= fairness_ * bend.weights[j] * way;
      for (Eigen::Index k = 0; k <= j; ++k)
        left.block<3, 3>(3 * j, 3 * k).diagonal().array() += fairness_ * bend.weights[j] * bend.weights[k];
    }
  }
  const double diagonal = left.diagonal().sum() / static_cast<double>(3 * count);
  if (!(diagonal > 0.0)) return;
  left.diagonal().array() += kDamping * diagonal;
  const Vector move = left.template selfadjointView<Eigen::Lower>().ldlt().solve(right);
  for (Eigen::Index j = 0; j < count; ++j) free_place_[static_cast<std::size_t>(j)] += move.segment<3>(3 * j);
}

/// True where facets side by side turn by more than 107 degrees, as SurfaceGuard judges, or at sharp edges by so much
/// that they nearly touch.
bool LoopTrial::folds() const {
  constexpr double kFolded = -0.3;
  constexpr double kClosed = -0.9;
  for (Index f = 0; f < surface_.facet_count(); ++f) {
    for (int side = 0; side < 3; ++side) {
      const Index other = surface_.across(f, side);
      if (other < f) continue;
      const double limit = surface_.is_sharp(f, side) ? kClosed : kFolded;
      const double dot = normals_[f].dot(normals_[other]);
      if (dot < 0.0 && dot * dot > limit * limit * normals_[f].squaredNorm() * normals_[other].squaredNorm())
        return true;
    }
  }
  return false;
}

/// True where only control points move, and the surface folds over where they were too.
bool LoopTrial::folded_before() {
  if (move_.kind != LoopMoveKind::Place) return false;
  const std::vector<Eigen::Vector3d> moved = free_place_;
  free_place_ = {state_->place(move_.a)};
  place_facets();
  const bool folded = folds();
  free_place_ = moved;
  place_facets();
  return folded;
}

/// The squares that are left after so many steps, at the least of all.
double LoopTrial::optimize(int steps) {
  place_facets();
  double least = project_all() + bends_after();
  std::vector<Eigen::Vector3d> best = free_place_;
  for (int i = 0; i < steps; ++i) {
    step();
    place_facets();
    const double sum = project_all() + bends_after();
    if (sum < least) {
      least = sum;
      best = free_place_;
      continue;
    }
    free_place_ = best;
    place_facets();
    return project_all() + bends_after();
  }
  return least;
}

}  // namespace batten
