#include "batten/fit/quad_turns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

double quad_badness(const Points& points, const Index* corners) {
  double worst = 0.0;
  std::array<Eigen::RowVector3d, 4> normals;
  for (int c = 0; c < 4; ++c) {
    const Eigen::RowVector3d next = (points.row(corners[(c + 1) % 4]) - points.row(corners[c])).normalized();
    const Eigen::RowVector3d last = (points.row(corners[(c + 3) % 4]) - points.row(corners[c])).normalized();
    worst = std::max(worst, std::abs(next.dot(last)));
    normals[c] = next.cross(last).normalized();
  }
  for (int c = 0; c < 4; ++c) worst = std::max(worst, 1.0 - normals[c].dot(normals[(c + 1) % 4]));
  return worst;
}

namespace {

using Hexagon = std::array<Index, 6>;

/// A turn of the edge between the quads of a half-edge.
struct EdgeTurn {
  double gain;
  Index half_edge;
  int steps;  ///< 1: from corners 0 and 3 of the hexagon to 1 and 4; 2: to 2 and 5
};

class QuadTurner {
 public:
  explicit QuadTurner(Mesh& mesh)
      : mesh_(mesh), topology_(mesh), degrees_(static_cast<std::size_t>(mesh.vertex_count())) {
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      degrees_[v] = topology_.vertex_face_count(v) + (topology_.is_boundary_vertex(v) ? 1 : 0);
  }

  /// Makes the turns that gain most and do not touch each other; false where there was none.
  bool run() {
    std::vector<EdgeTurn> turns;
    for (Index e = 0; e < topology_.edge_count(); ++e) propose(topology_.edge_half_edge(e), turns);
    std::sort(turns.begin(), turns.end(), [](const EdgeTurn& a, const EdgeTurn& b) {
      if (a.gain != b.gain) return a.gain > b.gain;
      return a.half_edge != b.half_edge ? a.half_edge < b.half_edge : a.steps < b.steps;
    });
    std::vector<std::uint8_t> touched(degrees_.size(), 0);
    for (const EdgeTurn& turn : turns) {
      const Hexagon hexagon = hexagon_of(turn.half_edge);
      if (std::any_of(hexagon.begin(), hexagon.end(), [&](Index v) { return touched[v] != 0; })) continue;
      for (const Index v : hexagon) touched[v] = 1;
      Index* const first = mesh_.face_vertices.data() + topology_.face_begin(topology_.face(turn.half_edge));
      Index* const second =
          mesh_.face_vertices.data() + topology_.face_begin(topology_.face(topology_.twin(turn.half_edge)));
      for (int c = 0; c < 4; ++c) {
        first[c] = hexagon[(turn.steps + c) % 6];
        second[c] = hexagon[(turn.steps + 3 + c) % 6];
      }
    }
    return !turns.empty();
  }

 private:
  bool between_quads(Index h) const {
    const Index twin = topology_.twin(h);
    return twin >= 0 && topology_.face_size(topology_.face(h)) == 4 && topology_.face_size(topology_.face(twin)) == 4;
  }

  /// The corners of the two quads in a circle; the edge runs from corner 0 to corner 3.
  Hexagon hexagon_of(Index h) const {
    const Index twin = topology_.twin(h);
    const Index after = topology_.next(h);
    const Index beyond = topology_.next(twin);
    return {topology_.origin(h),     topology_.destination(beyond), topology_.destination(topology_.next(beyond)),
            topology_.origin(after), topology_.destination(after),  topology_.destination(topology_.next(after))};
  }

  /// How much worse a vertex is with so many edges more.
  double irregularity(Index v, Index more) const {
    const double off = degrees_[v] + more - (topology_.is_boundary_vertex(v) ? 3.0 : 4.0);
    return off * off;
  }

  double shape_cost(const Hexagon& hexagon, int steps) const {
    constexpr double kShapeWeight = 2.0;
    double sum = 0.0;
    for (const int start : {steps, steps + 3}) {
      std::array<Index, 4> quad{};
      for (int c = 0; c < 4; ++c) quad[c] = hexagon[(start + c) % 6];
      const double badness = quad_badness(mesh_.points, quad.data());
      sum += badness * badness;
    }
    return kShapeWeight * sum;
  }

  bool joined(Index a, Index b) const {
    bool found = false;
    topology_.for_each_outgoing(a, [&](Index h) {
      found = found || topology_.destination(h) == b || topology_.origin(topology_.previous(h)) == b;
    });
    return found;
  }

  void propose(Index h, std::vector<EdgeTurn>& turns) const {
    constexpr double kLeastGain = 0.1;
    if (!between_quads(h) || topology_.edge_sharpness(topology_.edge(h)) > 0.0F) return;
    const Hexagon hexagon = hexagon_of(h);
    Hexagon sorted = hexagon;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return;
    for (const int end : {0, 3}) {
      const Index v = hexagon[end];
      if (degrees_[v] <= (topology_.is_boundary_vertex(v) ? 2 : 3)) return;
    }
    for (const int steps : {1, 2}) {
      const Index a = hexagon[steps];
      const Index b = hexagon[steps + 3];
      if (joined(a, b)) continue;
      double gain = shape_cost(hexagon, 0) - shape_cost(hexagon, steps);
      for (const Index v : {hexagon[0], hexagon[3]}) gain += irregularity(v, 0) - irregularity(v, -1);
      for (const Index v : {a, b}) gain += irregularity(v, 0) - irregularity(v, 1);
      if (gain > kLeastGain) turns.push_back({gain, h, steps});
    }
  }

  Mesh& mesh_;
  Topology topology_;
  std::vector<Index> degrees_;
};

}  // namespace

void turn_quad_edges(Mesh& mesh) {
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds && QuadTurner(mesh).run(); ++round) {
  }
}

}  // namespace batten
