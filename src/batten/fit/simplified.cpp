#include "batten/fit/simplified.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

#include "batten/fit/plane_quadric.h"
#include "batten/fit/point_tree.h"
#include "batten/mesh/topology.h"

namespace batten {

namespace {

struct EdgeCollapse {
  double cost;
  Index kept;
  Index gone;
  Index version;  ///< of both ends together
  bool operator>(const EdgeCollapse& other) const {
    if (cost != other.cost) return cost > other.cost;
    return kept != other.kept ? kept > other.kept : gone > other.gone;
  }
};

class Simplifier {
 public:
  Simplifier(const Mesh& mesh, const SamplePlanes* planes) : points_(mesh.points) {
    const auto vertices = static_cast<std::size_t>(mesh.vertex_count());
    fans_.resize(vertices);
    versions_.assign(vertices, 0);
    quadrics_.resize(vertices);
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Index begin = mesh.face_offsets[f];
      triangles_.push_back({mesh.face_vertices[begin], mesh.face_vertices[begin + 1], mesh.face_vertices[begin + 2]});
      for (const Index v : triangles_.back()) fans_[v].push_back(f);
    }
    mark_boundary(Topology(mesh));
    // Beside the planes of samples those of the triangles only hold what no sample is near to.
    constexpr double kBesideSamples = 0.02;
    for (Index f = 0; f < mesh.face_count(); ++f) add_quadrics(f, planes != nullptr ? kBesideSamples : 1.0);
    if (planes != nullptr) add_samples(*planes);
  }

  /// Edges that could not collapse may do so later, where others have changed their surroundings: they wait for the
  /// next round.
  Mesh run(Index wanted, const Progress& progress) {
    const auto all = static_cast<Index>(points_.rows());
    Index left = all;
    for (Index before = all + 1; left > wanted && left < before;) {
      before = left;
      propose_all();
      left = collapse_waiting(all, left, wanted, progress);
    }
    return result();
  }

 private:
  Eigen::Vector3d point(Index v) const { return points_.row(v).transpose(); }
  Eigen::Vector3d area_vector(const std::array<Index, 3>& t) const {
    return 0.5 * (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }

  void mark_boundary(const Topology& topology) {
    on_boundary_.assign(fans_.size(), 0);
    for (Index e = 0; e < topology.edge_count(); ++e) {
      if (!topology.is_boundary_edge(e)) continue;
      const Index h = topology.edge_half_edge(e);
      const Index a = topology.origin(h);
      const Index b = topology.destination(h);
      on_boundary_[a] = on_boundary_[b] = 1;
      const Eigen::Vector3d along = point(b) - point(a);
      const Eigen::Vector3d side = along.cross(area_vector(triangles_[topology.face(h)])).normalized();
      for (const Index v : {a, b}) quadrics_[v].add_plane(side, point(a), along.squaredNorm());
    }
  }

  /// Each sample's plane counts at the nearest vertices within its reach, or at the nearest one, in equal shares.
  void add_samples(const SamplePlanes& planes) {
    constexpr Index kMost = 12;
    const PointTree tree(points_);
    const double square = planes.reach * planes.reach;
    std::array<Index, kMost> near{};
    std::array<double, kMost> squares{};
    for (Eigen::Index i = 0; i < planes.points.rows(); ++i) {
      const Index found = tree.nearest(planes.points.row(i), kMost, near.data(), squares.data());
      const auto beyond = std::upper_bound(squares.begin() + 1, squares.begin() + found, square);
      const auto count = static_cast<Index>(beyond - squares.begin());
      for (Index k = 0; k < count; ++k) {
        quadrics_[near[k]].add_plane(planes.normals.row(i).transpose(), planes.points.row(i).transpose(),
                                     planes.areas[i] / count);
      }
    }
  }

  void add_quadrics(Index f, double share) {
    constexpr double kPointWeight = 0.003;
    const Eigen::Vector3d vector = area_vector(triangles_[f]);
    const double area = vector.norm();
    if (!(area > 0.0)) return;
    for (const Index v : triangles_[f]) {
      quadrics_[v].add_plane(vector / area, point(v), share * area / 3.0);
      quadrics_[v].add_point(point(v), kPointWeight * area / 3.0);
    }
  }

  std::vector<Index> ring(Index v) const {
    std::vector<Index> others;
    for (const Index f : fans_[v]) {
      for (const Index other : triangles_[f]) {
        if (other != v) others.push_back(other);
      }
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    return others;
  }

  /// Where the cost is least, near the edge.
  Eigen::Vector3d best_place(const Quadric& sum, Index a, Index b) const {
    Eigen::Vector3d middle = 0.5 * (point(a) + point(b));
    Eigen::Vector3d place = sum.a.inverse() * -sum.b;
    const double length = (point(a) - point(b)).norm();
    if (place.allFinite() && (place - middle).norm() <= 2.0 * length) return place;
    return middle;
  }

  void propose(Index a, Index b) {
    Quadric sum = quadrics_[a];
    sum.add(quadrics_[b]);
    const double cost = std::max(0.0, sum.at(best_place(sum, a, b)));
    const Index kept = std::min(a, b);
    waiting_.push({cost, kept, a + b - kept, versions_[a] + versions_[b]});
  }

  void propose_all() {
    for (Index v = 0; v < static_cast<Index>(points_.rows()); ++v) {
      for (const Index other : ring(v)) {
        if (v < other) propose(v, other);
      }
    }
  }

  Index collapse_waiting(Index all, Index left, Index wanted, const Progress& progress) {
    constexpr Index kBetweenCalls = 4096;
    for (Index step = 0; left > wanted && !waiting_.empty(); ++step) {
      if (step % kBetweenCalls == 0) report_progress(progress, static_cast<double>(all - left) / (all - wanted));
      const EdgeCollapse next = waiting_.top();
      waiting_.pop();
      const bool outdated = next.version != versions_[next.kept] + versions_[next.gone];
      if (outdated || fans_[next.gone].empty() || fans_[next.kept].empty()) continue;
      if (collapse(next)) --left;
    }
    return left;
  }

  bool keeps_topology(Index a, Index b) const {
    constexpr std::size_t kMostNeighbours = 12;
    const std::vector<Index> around_a = ring(a);
    const std::vector<Index> around_b = ring(b);
    std::vector<Index> common;
    std::set_intersection(around_a.begin(), around_a.end(), around_b.begin(), around_b.end(),
                          std::back_inserter(common));
    Index faces = 0;
    for (const Index f : fans_[a]) faces += std::count(triangles_[f].begin(), triangles_[f].end(), b);
    if (static_cast<Index>(common.size()) != faces) return false;
    if (on_boundary_[a] != 0 && on_boundary_[b] != 0 && faces != 1) return false;
    if (around_a.size() + around_b.size() - common.size() - 2 > kMostNeighbours) return false;
    if (around_a.size() + around_b.size() - common.size() - 2 < 3) return false;
    for (const Index v : common) {
      if (ring(v).size() < (on_boundary_[v] != 0 ? 4U : 5U) - 1U) return false;
    }
    return true;
  }

  /// True where no triangle that stays is turned over or squashed by moving `v`, and the other one, to `place`.
  bool keeps_sides(Index v, Index other, const Eigen::Vector3d& place) const {
    for (const Index f : fans_[v]) {
      const std::array<Index, 3>& t = triangles_[f];
      if (std::find(t.begin(), t.end(), other) != t.end()) continue;
      const Eigen::Vector3d before = area_vector(t);
      std::array<Eigen::Vector3d, 3> p;
      for (int c = 0; c < 3; ++c) p[c] = t[c] == v ? place : point(t[c]);
      const Eigen::Vector3d after = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
      const double longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
      if (before.dot(after) < 0.3 * before.norm() * after.norm()) return false;
      if (after.norm() < 0.04 * longest * longest) return false;
    }
    return true;
  }

  bool collapse(const EdgeCollapse& edge) {
    const Index a = edge.kept;
    const Index b = edge.gone;
    if (!keeps_topology(a, b)) return false;
    Quadric sum = quadrics_[a];
    sum.add(quadrics_[b]);
    const Eigen::Vector3d place = best_place(sum, a, b);
    if (!keeps_sides(a, b, place) || !keeps_sides(b, a, place)) return false;
    points_.row(a) = place.transpose();
    quadrics_[a] = sum;
    on_boundary_[a] = on_boundary_[a] != 0 || on_boundary_[b] != 0 ? 1 : 0;
    const std::vector<Index> moved = fans_[b];
    for (const Index f : moved) {
      std::array<Index, 3>& t = triangles_[f];
      if (std::find(t.begin(), t.end(), a) != t.end()) {
        for (const Index v : t) fans_[v].erase(std::find(fans_[v].begin(), fans_[v].end(), f));
        t = {-1, -1, -1};
        continue;
      }
      std::replace(t.begin(), t.end(), b, a);
      fans_[a].push_back(f);
    }
    fans_[b].clear();
    ++versions_[a];
    for (const Index other : ring(a)) propose(a, other);
    return true;
  }

  Mesh result() const {
    Mesh mesh;
    std::vector<Index> number(fans_.size(), -1);
    Index count = 0;
    for (std::size_t v = 0; v < fans_.size(); ++v) {
      if (!fans_[v].empty()) number[v] = count++;
    }
    mesh.points.resize(count, 3);
    for (std::size_t v = 0; v < fans_.size(); ++v) {
      if (number[v] >= 0) mesh.points.row(number[v]) = points_.row(static_cast<Eigen::Index>(v));
    }
    for (const std::array<Index, 3>& t : triangles_) {
      if (t[0] >= 0) mesh.add_face({number[t[0]], number[t[1]], number[t[2]]});
    }
    return mesh;
  }

  Points points_;
  std::vector<std::array<Index, 3>> triangles_;
  std::vector<std::vector<Index>> fans_;
  std::vector<Index> versions_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint8_t> on_boundary_;
  std::priority_queue<EdgeCollapse, std::vector<EdgeCollapse>, std::greater<>> waiting_;
};

}  // namespace

Mesh simplified(const Mesh& mesh, Index vertices, const Progress& progress) {
  if (mesh.vertex_count() <= vertices) return mesh;
  return Simplifier(mesh, nullptr).run(vertices, progress);
}

Mesh simplified(const Mesh& mesh, const SamplePlanes& planes, Index vertices, const Progress& progress) {
  if (mesh.vertex_count() <= vertices) return mesh;
  return Simplifier(mesh, &planes).run(vertices, progress);
}

}  // namespace batten
