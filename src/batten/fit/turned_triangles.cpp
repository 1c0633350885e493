#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "batten/fit/sharp_edges.h"
#include "batten/fit/triangle_point.h"
#include "batten/mesh/topology.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr Index kMostEdges = 12;

/// A turn of the edge between two triangles.
struct TriangleTurn {
  double gain;
  Index half_edge;
};

class TriangleTurner {
 public:
  TriangleTurner(Mesh& mesh, const PointTree& tree, const Points& normals)
      : mesh_(mesh), topology_(mesh), points_(tree.points()), normals_(normals) {
    attach();
  }

  /// Makes the turns that gain most and do not touch each other; false where there was none.
  bool run() {
    std::vector<TriangleTurn> turns;
    for (Index e = 0; e < topology_.edge_count(); ++e) {
      if (topology_.is_boundary_edge(e)) continue;
      const double gain = gain_of(topology_.edge_half_edge(e));
      if (gain > 0.0) turns.push_back({gain, topology_.edge_half_edge(e)});
    }
    std::sort(turns.begin(), turns.end(), [](const TriangleTurn& a, const TriangleTurn& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.half_edge < b.half_edge;
    });
    std::vector<std::uint8_t> touched(static_cast<std::size_t>(mesh_.vertex_count()), 0);
    for (const TriangleTurn& turn : turns) {
      const std::array<Index, 4> quad = quad_of(turn.half_edge);
      if (std::any_of(quad.begin(), quad.end(), [&](Index v) { return touched[v] != 0; })) continue;
      for (const Index v : quad) touched[v] = 1;
      const auto set_face = [&](Index h, Index a, Index b, Index c) {
        Index* const corners = mesh_.face_vertices.data() + topology_.face_begin(topology_.face(h));
        corners[0] = a;
        corners[1] = b;
        corners[2] = c;
      };
      set_face(turn.half_edge, quad[2], quad[3], quad[1]);
      set_face(topology_.twin(turn.half_edge), quad[3], quad[2], quad[0]);
    }
    return !turns.empty();
  }

 private:
  /// The ends of the edge and the corners across from it, left and right.
  std::array<Index, 4> quad_of(Index h) const {
    return {topology_.origin(h), topology_.destination(h), topology_.origin(topology_.previous(h)),
            topology_.origin(topology_.previous(topology_.twin(h)))};
  }

  Eigen::Vector3d place(Index v) const { return mesh_.points.row(v).transpose(); }

  /// Each point goes to the nearest triangle around the mesh's nearest vertices.
  void attach() {
    constexpr Index kNear = 4;
    const PointTree vertices(mesh_.points);
    std::vector<Index> found(static_cast<std::size_t>(points_.rows()), -1);
    parallel_for(points_.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      std::array<Index, kNear> near{};
      std::array<double, kNear> squares{};
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        const Eigen::Vector3d p = points_.row(i).transpose();
        double least = std::numeric_limits<double>::infinity();
        const Index count = vertices.nearest(points_.row(i), kNear, near.data(), squares.data());
        for (Index k = 0; k < count; ++k) {
          if (topology_.is_isolated(near[k])) continue;
          topology_.for_each_outgoing(near[k], [&](Index h) {
            const double square =
                squared_distance_to_triangle(p, place(topology_.origin(h)), place(topology_.destination(h)),
                                             place(topology_.origin(topology_.previous(h))));
            if (square >= least) return;
            least = square;
            found[static_cast<std::size_t>(i)] = topology_.face(h);
          });
        }
      }
    });
    attached_.resize(static_cast<std::size_t>(mesh_.face_count()));
    for (Index i = 0; i < static_cast<Index>(found.size()); ++i) {
      if (found[i] >= 0) attached_[found[i]].push_back(i);
    }
  }

  double squares_to(Index face, const std::array<std::array<Index, 3>, 2>& pair) const {
    double sum = 0.0;
    for (const Index i : attached_[face]) {
      const Eigen::Vector3d p = points_.row(i).transpose();
      double least = std::numeric_limits<double>::infinity();
      for (const std::array<Index, 3>& t : pair)
        least = std::min(least, squared_distance_to_triangle(p, place(t[0]), place(t[1]), place(t[2])));
      sum += least;
    }
    return sum;
  }

  /// The normal of the points attached to two triangles.
  Eigen::Vector3d data_normal(Index one, Index other) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Index face : {one, other}) {
      for (const Index i : attached_[face]) sum += normals_.row(i).transpose();
    }
    return sum;
  }

  bool joined(Index a, Index b) const {
    bool found = false;
    topology_.for_each_outgoing(a, [&](Index h) {
      found = found || topology_.destination(h) == b || topology_.origin(topology_.previous(h)) == b;
    });
    return found;
  }

  Index edges_at(Index v) const { return topology_.vertex_face_count(v) + (topology_.is_boundary_vertex(v) ? 1 : 0); }

  /// How much nearer the mesh comes to the points, or 0 where the edge shall stay.
  double gain_of(Index h) const {
    constexpr double kShare = 0.2;
    constexpr double kUpright = 0.2;
    constexpr double kThin = 0.1;
    const auto [a, b, c, d] = quad_of(h);
    const Index one = topology_.face(h);
    const Index other = topology_.face(topology_.twin(h));
    if (attached_[one].empty() && attached_[other].empty()) return 0.0;
    if (c == d || joined(c, d) || edges_at(a) < 4 || edges_at(b) < 4) return 0.0;
    if (edges_at(c) >= kMostEdges || edges_at(d) >= kMostEdges) return 0.0;
    const std::array<std::array<Index, 3>, 2> now{{{a, b, c}, {b, a, d}}};
    const std::array<std::array<Index, 3>, 2> then{{{c, d, b}, {d, c, a}}};
    const Eigen::Vector3d normal = data_normal(one, other).normalized();
    for (const std::array<Index, 3>& t : then) {
      const Eigen::Vector3d area = (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0]));
      const double longest =
          std::max({(place(t[1]) - place(t[0])).squaredNorm(), (place(t[2]) - place(t[1])).squaredNorm(),
                    (place(t[0]) - place(t[2])).squaredNorm()});
      if (area.dot(normal) < kUpright * area.norm() || area.norm() < kThin * longest) return 0.0;
    }
    const double before = squares_to(one, now) + squares_to(other, now);
    const double after = squares_to(one, then) + squares_to(other, then);
    const double least = 1e-6 * (place(a) - place(b)).squaredNorm();
    return before - after > kShare * before + least ? before - after : 0.0;
  }

  Mesh& mesh_;
  Topology topology_;
  const Points& points_;
  const Points& normals_;
  std::vector<std::vector<Index>> attached_;
};

}  // namespace

void turn_to_points(Mesh& mesh, const PointTree& points, const Points& normals) {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds && TriangleTurner(mesh, points, normals).run(); ++round) {
  }
}

}  // namespace batten
