#include "batten/fit/sphere_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "batten/fit/vertex_rings.h"

namespace batten {

namespace {

/// More than any stretch: of a triangle that is turned over.
constexpr double kTurned = std::numeric_limits<double>::max();

/// The places in a plane from which all sides of a polygon are seen from the left.
class SeenPlaces {
 public:
  /// Places farther from the origin than so much count as unseen.
  explicit SeenPlaces(double reach) : corners_{{-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}} {}

  /// height(place) is linear and not negative on the left of the side.
  template <typename Height>
  void clip(const Height& height) {
    std::vector<Eigen::Vector2d> kept;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Eigen::Vector2d& from = corners_[i];
      const Eigen::Vector2d& to = corners_[(i + 1) % corners_.size()];
      const double here = height(from);
      const double there = height(to);
      if (here >= 0.0) kept.push_back(from);
      if ((here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0))
        kept.push_back(from + here / (here - there) * (to - from));
    }
    corners_ = std::move(kept);
  }

  Eigen::Vector2d middle() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : corners_) sum += corner;
    return sum / std::max(1.0, static_cast<double>(corners_.size()));
  }

 private:
  std::vector<Eigen::Vector2d> corners_;
};

}  // namespace

struct SphereMap::Parts {
  Points points;
  VertexRings rings;
  Scalars density;
  Points directions;
  double evenness = 0.0;  ///< what the stretch of the surface on the sphere counts

  explicit Parts(const Mesh& mesh)
      : points(mesh.points),
        rings(mesh),
        density(Scalars::Ones(points.rows())),
        directions(Points::Zero(points.rows(), 3)) {}

  Eigen::Vector3d direction(Index v) const { return directions.row(v).transpose(); }
  double stretch(Index v, const Eigen::Vector3d& place, Eigen::Vector3d* slope) const;
  void place_tetrahedron();
  void place(Index v);
  void relax(Index v);
  void relax_all();
  void choose_evenness();
};

/// The sum over the triangles around a vertex at a place of area times the mean of the squares of the singular values
/// of the map from the triangle on the sphere to that of the surface, and of the map back as evenness asks; kTurned
/// where one is turned over.
double SphereMap::Parts::stretch(Index v, const Eigen::Vector3d& place, Eigen::Vector3d* slope) const {
  constexpr double kLeastDeterminant = 1e-12;
  // A triangle of the surface without area has to keep one on the sphere.
  constexpr double kLeastArea = 1e-3;
  const Ring& ring = rings.of(v);
  double sum = 0.0;
  if (slope != nullptr) slope->setZero();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Index one = ring[i];
    const Index two = ring[i + 1 == ring.size() ? 0 : i + 1];
    const Eigen::Vector3d b = direction(one);
    const Eigen::Vector3d c = direction(two);
    const Eigen::Vector3d bc = b.cross(c);
    const double determinant = place.dot(bc);
    if (!(determinant > kLeastDeterminant)) return kTurned;
    const Eigen::RowVector3d s = points.row(one) - points.row(v);
    const Eigen::RowVector3d t = points.row(two) - points.row(v);
    const double dense = (density[v] + density[one] + density[two]) / 3.0;
    const std::array<double, 3> squares{(t - s).squaredNorm(), t.squaredNorm(), s.squaredNorm()};
    const double all = squares[0] + squares[1] + squares[2];
    const double area = dense * dense * std::max(0.5 * s.cross(t).norm(), kLeastArea * all);
    // The sum of cotangents on the sphere times squared lengths on the surface, times four areas.
    const std::array<double, 3> opposite{all - 2.0 * squares[0], all - 2.0 * squares[1], all - 2.0 * squares[2]};
    const Eigen::Vector3d to_b = place - b;
    const Eigen::Vector3d to_c = place - c;
    const double dirichlet =
        opposite[0] * (b - c).squaredNorm() + opposite[1] * to_c.squaredNorm() + opposite[2] * to_b.squaredNorm();
    const double unit = 0.25 * area / (determinant * determinant);
    // The same sum is Dirichlet's energy of the map back, up to a factor.
    const double both = unit + 0.0625 * evenness * dense * dense / area;
    sum += both * dirichlet;
    if (slope != nullptr)
      *slope += 2.0 * (both * (opposite[1] * to_c + opposite[2] * to_b) - unit * dirichlet / determinant * bc);
  }
  return sum;
}

void SphereMap::Parts::place_tetrahedron() {
  Index top = 0;
  while (rings.of(top).empty()) ++top;
  directions.row(top) << 0.0, 0.0, 1.0;
  const double radius = std::sqrt(8.0) / 3.0;
  for (int corner = 0; corner < 3; ++corner) {
    const double angle = corner * 2.0 * std::numbers::pi / 3.0;
    directions.row(rings.of(top)[corner]) << radius * std::cos(angle), radius * std::sin(angle), -1.0 / 3.0;
  }
}

/// Lays a vertex into its ring, in the middle of the places from which all of the ring is seen. Some are always seen
/// near the vertex that it went to.
void SphereMap::Parts::place(Index v) {
  constexpr double kReach = 2.0;
  const Ring& ring = rings.of(v);
  const Eigen::Vector3d axis = direction(ring[0]);
  const Eigen::Vector3d right = axis.unitOrthogonal();
  const Eigen::Vector3d up = axis.cross(right);
  const auto at = [&](const Eigen::Vector2d& place) -> Eigen::Vector3d {
    return axis + place[0] * right + place[1] * up;
  };
  SeenPlaces seen(kReach);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector3d side = direction(ring[i]).cross(direction(ring[(i + 1) % ring.size()])).normalized();
    seen.clip([&](const Eigen::Vector2d& place) { return side.dot(at(place)); });
  }
  directions.row(v) = at(seen.middle()).normalized().transpose();
}

/// Moves a vertex against the slope of the stretch of the triangles around it, to where that is less.
void SphereMap::Parts::relax(Index v) {
  constexpr int kSteps = 2;
  constexpr int kHalvings = 8;
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Vector3d from = direction(v);
    Eigen::Vector3d slope;
    const double before = stretch(v, from, &slope);
    slope -= slope.dot(from) * from;
    const double length = slope.norm();
    if (!(before < kTurned) || !(length > 0.0)) return;
    double reach = std::numeric_limits<double>::max();
    for (const Index other : rings.of(v)) reach = std::min(reach, (direction(other) - from).norm());
    Eigen::Vector3d move = -reach / length * slope;
    for (int halving = 0; halving < kHalvings; ++halving, move *= 0.5) {
      const Eigen::Vector3d to = (from + move).normalized();
      if (!(stretch(v, to, nullptr) < before)) continue;
      directions.row(v) = to.transpose();
      break;
    }
    if (direction(v) == from) return;
  }
}

void SphereMap::Parts::relax_all() {
  for (Index v = 0; v < static_cast<Index>(points.rows()); ++v) {
    if (!rings.of(v).empty()) relax(v);
  }
}

/// In proportion to the square of what both maps would stretch on a sphere, so that both count the same in any unit.
void SphereMap::Parts::choose_evenness() {
  constexpr double kShare = 0.1;
  double area = 0.0;
  for (Index v = 0; v < static_cast<Index>(points.rows()); ++v) {
    const Ring& ring = rings.of(v);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index one = ring[i];
      const Index two = ring[(i + 1) % ring.size()];
      const double dense = (density[v] + density[one] + density[two]) / 3.0;
      const Eigen::RowVector3d side = points.row(one) - points.row(v);
      // Each triangle is met from three corners.
      area += dense * dense * side.cross(points.row(two) - points.row(v)).norm() / 6.0;
    }
  }
  const double square = area / (4.0 * std::numbers::pi);
  evenness = kShare * square * square;
}

SphereMap::SphereMap(const Mesh& mesh, const Progress& progress) : parts_(std::make_unique<Parts>(mesh)) {
  constexpr double kGrowth = 1.4;
  constexpr double kFirst = 8.0;
  constexpr int kSweeps = 4;
  Parts& parts = *parts_;
  const std::vector<RemovedVertex> removed = remove_to_tetrahedron(mesh, parts.rings);
  parts.place_tetrahedron();
  const auto all = static_cast<double>(parts.points.rows());
  double count = all - static_cast<double>(removed.size());
  double next = kFirst;
  for (std::size_t i = removed.size(); i-- > 0;) {
    parts.rings.restore(removed[i]);
    parts.place(removed[i].vertex);
    parts.relax(removed[i].vertex);
    for (const Index other : removed[i].ring) parts.relax(other);
    if (++count < next) continue;
    report_progress(progress, count / all);
    next *= kGrowth;
    for (int sweep = 0; sweep < kSweeps; ++sweep) parts.relax_all();
  }
}

SphereMap::~SphereMap() = default;

const Points& SphereMap::directions() const { return parts_->directions; }

Index SphereMap::turned_triangles() const {
  const Parts& parts = *parts_;
  Index count = 0;
  for (Index v = 0; v < static_cast<Index>(parts.points.rows()); ++v) {
    const Ring& ring = parts.rings.of(v);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index one = ring[i];
      const Index two = ring[(i + 1) % ring.size()];
      // Each triangle once, from its first vertex.
      if (v > one || v > two) continue;
      if (!(parts.direction(v).dot(parts.direction(one).cross(parts.direction(two))) > 0.0)) ++count;
    }
  }
  return count;
}

void SphereMap::relax(const Scalars& density, int sweeps) {
  parts_->density = density;
  parts_->choose_evenness();
  for (int sweep = 0; sweep < sweeps; ++sweep) parts_->relax_all();
}

}  // namespace batten
