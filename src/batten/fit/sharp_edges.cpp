#include "batten/fit/sharp_edges.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "batten/mesh/face_normal.h"
#include "batten/mesh/topology.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A point beside an edge: along it, across it, above the mean plane of the two faces.
struct BesidePoint {
  double along;
  double across;
  double above;
};

/// How sharp the data is along an edge.
struct EdgeEvidence {
  double turn = 0.0;   ///< of the roof, radians
  double ratio = 0.0;  ///< the squares that the parabola leaves over those that the roof leaves
};

/// The squares that are left by the best combination of the columns; the coefficients.
template <int Columns>
double left_squares(const Eigen::Matrix<double, Eigen::Dynamic, Columns>& columns, const Eigen::VectorXd& values,
                    Eigen::Matrix<double, Columns, 1>& coefficients) {
  Eigen::Matrix<double, Columns, Columns> normal = columns.transpose() * columns;
  normal.diagonal().array() += 1e-9 * normal.trace();
  coefficients = normal.ldlt().solve(columns.transpose() * values);
  return (columns * coefficients - values).squaredNorm();
}

/// Both models have a height, a slope along the edge and two numbers for the section; the roof's ridge may lie beside
/// the edge. Lengths are in the points' spacing.
EdgeEvidence compare_models(const std::vector<BesidePoint>& points) {
  constexpr double kRidges[] = {-0.8, -0.4, 0.0, 0.4, 0.8};
  /// Of this squared part of the spacing data is exact.
  constexpr double kExact = 0.01 * 0.01;
  constexpr int kLeastPerSide = 3;
  const auto count = static_cast<Eigen::Index>(points.size());
  EdgeEvidence evidence;
  Eigen::VectorXd above(count);
  Eigen::Matrix<double, Eigen::Dynamic, 4> parabola(count, 4);
  Eigen::Matrix<double, Eigen::Dynamic, 4> roof(count, 4);
  for (Eigen::Index i = 0; i < count; ++i) {
    const BesidePoint& point = points[static_cast<std::size_t>(i)];
    above[i] = point.above;
    parabola.row(i) << 1.0, point.along, point.across, point.across * point.across;
  }
  Eigen::Vector4d best;
  const double of_parabola = left_squares<4>(parabola, above, best);
  double of_roof = std::numeric_limits<double>::infinity();
  for (const double ridge : kRidges) {
    int left = 0;
    int right = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const BesidePoint& point = points[static_cast<std::size_t>(i)];
      const double off = point.across - ridge;
      (off < 0.0 ? left : right) += 1;
      roof.row(i) << 1.0, point.along, std::min(off, 0.0), std::max(off, 0.0);
    }
    if (std::min(left, right) < kLeastPerSide) continue;
    Eigen::Vector4d coefficients;
    const double squares = left_squares<4>(roof, above, coefficients);
    if (squares >= of_roof) continue;
    of_roof = squares;
    evidence.turn = std::abs(std::atan(coefficients[2]) - std::atan(coefficients[3]));
  }
  const double exact = kExact * static_cast<double>(count);
  evidence.ratio = std::isfinite(of_roof) ? of_parabola / (of_roof + exact) : 0.0;
  return evidence;
}

class SharpEdgeFinder {
 public:
  SharpEdgeFinder(const Mesh& mesh, const PointTree& tree, const Points& normals, double spacing)
      : mesh_(mesh), topology_(mesh), tree_(tree), normals_(normals), spacing_(spacing) {
    evidence_.resize(static_cast<std::size_t>(topology_.edge_count()));
    sharp_.assign(evidence_.size(), 0);
    parallel_for(
        topology_.edge_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          for (auto e = static_cast<Index>(begin); e < static_cast<Index>(end); ++e) evidence_[e] = evidence_at(e);
        },
        64);
  }

  std::vector<Crease> run() {
    mark_lines();
    join_gaps();
    std::vector<Crease> creases;
    for (Index e = 0; e < topology_.edge_count(); ++e) {
      if (sharp_[e] != 0) creases.push_back({start(e), end(e), kInfiniteSharpness});
    }
    return creases;
  }

 private:
  static constexpr double kStrongTurn = 35.0 * kDegree;
  static constexpr double kWeakTurn = 20.0 * kDegree;
  static constexpr double kStrongRatio = 3.0;
  static constexpr double kWeakRatio = 1.3;

  Index start(Index e) const { return topology_.origin(topology_.edge_half_edge(e)); }
  Index end(Index e) const { return topology_.destination(topology_.edge_half_edge(e)); }
  Index across(Index e, Index v) const { return start(e) == v ? end(e) : start(e); }
  Eigen::Vector3d place(Index v) const { return mesh_.points.row(v).transpose(); }
  bool is_strong(Index e) const { return evidence_[e].turn >= kStrongTurn && evidence_[e].ratio >= kStrongRatio; }
  bool is_weak(Index e) const { return evidence_[e].turn >= kWeakTurn && evidence_[e].ratio >= kWeakRatio; }

  template <typename Visit>
  void for_each_edge(Index v, const Visit& visit) const {
    Index last = -1;
    topology_.for_each_outgoing(v, [&](Index h) {
      visit(topology_.edge(h));
      last = topology_.previous(h);
    });
    if (last >= 0 && topology_.twin(last) < 0) visit(topology_.edge(last));
  }

  int sharp_count(Index v) const {
    int count = 0;
    for_each_edge(v, [&](Index e) { count += sharp_[e]; });
    return count;
  }

  EdgeEvidence evidence_at(Index e) const {
    constexpr Index kNear = 64;
    constexpr double kReach = 4.0;
    constexpr double kBesideEnds = 0.6;
    constexpr double kLeastAlong = 1.5;
    constexpr double kAcross = 0.5;  // beyond a corner the data turns to a third side, along the edge
    if (topology_.is_boundary_edge(e)) return {};
    const Index h = topology_.edge_half_edge(e);
    const Eigen::Vector3d one = face_normal(mesh_, topology_.face(h)).normalized();
    const Eigen::Vector3d other = face_normal(mesh_, topology_.face(topology_.twin(h))).normalized();
    const Eigen::Vector3d up = (one + other).normalized();
    const Eigen::Vector3d step = place(end(e)) - place(start(e));
    const Eigen::Vector3d along = (step - step.dot(up) * up).normalized();
    const Eigen::Vector3d side = up.cross(along);
    const Eigen::Vector3d middle = 0.5 * (place(start(e)) + place(end(e)));
    if (!along.allFinite() || !side.allFinite()) return {};
    const double most_along = std::max(kBesideEnds * step.norm(), kLeastAlong * spacing_);
    std::array<Index, kNear> near{};
    std::array<double, kNear> squares{};
    const Index count = tree_.nearest(middle.transpose(), kNear, near.data(), squares.data());
    std::vector<BesidePoint> beside;
    for (Index k = 0; k < count; ++k) {
      const Eigen::RowVector3d normal = normals_.row(near[k]);
      if (normal.dot(up) <= 0.0 || std::abs(normal.dot(along)) > kAcross) continue;
      const Eigen::Vector3d off = tree_.points().row(near[k]).transpose() - middle;
      const BesidePoint point{off.dot(along) / spacing_, off.dot(side) / spacing_, off.dot(up) / spacing_};
      if (std::abs(point.along) * spacing_ <= most_along && std::abs(point.across) <= kReach) beside.push_back(point);
    }
    return compare_models(beside);
  }

  /// Strong edges, and weak ones that carry them on.
  void mark_lines() {
    for (Index e = 0; e < topology_.edge_count(); ++e) sharp_[e] = is_strong(e) ? 1 : 0;
    for (bool any = true; any;) {
      any = false;
      for (Index e = 0; e < topology_.edge_count(); ++e) {
        if (sharp_[e] != 0 || !is_weak(e) || !(carries_on(e, start(e)) || carries_on(e, end(e)))) continue;
        sharp_[e] = 1;
        any = true;
      }
    }
  }

  /// True where a sharp edge ends at v and this one goes on in about its direction.
  bool carries_on(Index e, Index v) const {
    constexpr double kStraight = 0.5;
    if (sharp_count(v) != 1) return false;
    const Eigen::Vector3d on = (place(across(e, v)) - place(v)).normalized();
    bool found = false;
    for_each_edge(v, [&](Index other) {
      if (sharp_[other] != 0) found = (place(v) - place(across(other, v))).normalized().dot(on) > kStraight;
    });
    return found;
  }

  /// Where a line ends beside another, the edge between them is taken that has any evidence.
  void join_gaps() {
    constexpr double kLeastTurn = 10.0 * kDegree;
    for (Index v = 0; v < topology_.vertex_count(); ++v) {
      if (topology_.is_isolated(v) || sharp_count(v) != 1) continue;
      Index best = -1;
      for_each_edge(v, [&](Index e) {
        if (sharp_[e] != 0 || evidence_[e].turn < kLeastTurn || evidence_[e].ratio < 1.0) return;
        if (sharp_count(across(e, v)) == 0 || !carries_on(e, v)) return;
        if (best < 0 || evidence_[e].turn > evidence_[best].turn) best = e;
      });
      if (best >= 0) sharp_[best] = 1;
    }
  }

  const Mesh& mesh_;
  Topology topology_;
  const PointTree& tree_;
  const Points& normals_;
  double spacing_;
  std::vector<EdgeEvidence> evidence_;
  std::vector<std::uint8_t> sharp_;
};

}  // namespace

std::vector<Crease> find_sharp_edges(const Mesh& mesh, const PointTree& points, const Points& normals, double spacing) {
  if (!(spacing > 0.0) || mesh.face_count() == 0) return {};
  Mesh tagged = mesh;
  tagged.creases = SharpEdgeFinder(mesh, points, normals, spacing).run();
  keep_lines(tagged, spacing);
  return tagged.creases;
}

}  // namespace batten
