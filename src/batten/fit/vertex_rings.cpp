#include "batten/fit/vertex_rings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <utility>

#include "batten/fit/plane_quadric.h"

namespace batten {

namespace {

bool holds_vertex(const Ring& ring, Index vertex) { return std::find(ring.begin(), ring.end(), vertex) != ring.end(); }

/// A collapse that waits for its turn.
struct RingCollapse {
  double cost;
  Index gone;
  Index kept;
  Index version;  ///< of both ends together
  bool operator>(const RingCollapse& other) const {
    if (cost != other.cost) return cost > other.cost;
    return gone != other.gone ? gone > other.gone : kept > other.kept;
  }
};

class VertexRemover {
 public:
  VertexRemover(const Mesh& mesh, VertexRings& rings)
      : points_(mesh.points),
        rings_(rings),
        quadrics_(static_cast<std::size_t>(mesh.vertex_count())),
        versions_(static_cast<std::size_t>(mesh.vertex_count()), 0) {
    constexpr double kPointWeight = 0.003;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Index* const corners = mesh.face_vertices.data() + mesh.face_offsets[f];
      const Eigen::Vector3d vector =
          0.5 * (point(corners[1]) - point(corners[0])).cross(point(corners[2]) - point(corners[0]));
      const double area = vector.norm();
      if (!(area > 0.0)) continue;
      for (int c = 0; c < 3; ++c) {
        quadrics_[corners[c]].add_plane(vector / area, point(corners[c]), area / 3.0);
        quadrics_[corners[c]].add_point(point(corners[c]), kPointWeight * area / 3.0);
      }
    }
  }

  std::vector<RemovedVertex> run() {
    constexpr std::size_t kFewNeighbours = 20;
    std::vector<RemovedVertex> removed;
    const std::size_t all = quadrics_.size() - 4;
    // A sphere of more than four vertices has an edge that may collapse, but valences may have to grow for it.
    for (std::size_t most = kFewNeighbours; removed.size() < all; most *= 2) {
      for (Index v = 0; v < static_cast<Index>(points_.rows()); ++v) {
        for (const Index other : rings_.of(v)) propose(v, other);
      }
      while (removed.size() < all && !waiting_.empty()) {
        const RingCollapse next = waiting_.top();
        waiting_.pop();
        const bool outdated = next.version != versions_[next.gone] + versions_[next.kept];
        if (outdated || rings_.of(next.gone).empty() || rings_.of(next.kept).empty()) continue;
        if (rings_.can_collapse(next.gone, next.kept, most)) removed.push_back(collapse(next.gone, next.kept));
      }
    }
    return removed;
  }

 private:
  Eigen::Vector3d point(Index v) const { return points_.row(v).transpose(); }

  void propose(Index gone, Index kept) {
    Quadric sum = quadrics_[gone];
    sum.add(quadrics_[kept]);
    waiting_.push({std::max(0.0, sum.at(point(kept))), gone, kept, versions_[gone] + versions_[kept]});
  }

  RemovedVertex collapse(Index gone, Index kept) {
    RemovedVertex removed = rings_.collapse(gone, kept);
    quadrics_[kept].add(quadrics_[gone]);
    ++versions_[kept];
    for (const Index other : rings_.of(kept)) {
      propose(kept, other);
      propose(other, kept);
    }
    return removed;
  }

  const Points& points_;
  VertexRings& rings_;
  std::vector<Quadric> quadrics_;
  std::vector<Index> versions_;
  std::priority_queue<RingCollapse, std::vector<RingCollapse>, std::greater<>> waiting_;
};

}  // namespace

VertexRings::VertexRings(const Mesh& mesh) : rings_(static_cast<std::size_t>(mesh.vertex_count())) {
  // The two other corners of each triangle at a vertex, one after the other.
  std::vector<std::vector<std::array<Index, 2>>> sides(rings_.size());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* const corners = mesh.face_vertices.data() + mesh.face_offsets[f];
    for (int c = 0; c < 3; ++c) sides[corners[c]].push_back({corners[(c + 1) % 3], corners[(c + 2) % 3]});
  }
  for (std::size_t v = 0; v < rings_.size(); ++v) {
    Index next = sides[v].front()[0];
    for (std::size_t i = 0; i < sides[v].size(); ++i) {
      rings_[v].push_back(next);
      next = std::find_if(sides[v].begin(), sides[v].end(), [&](const auto& side) { return side[0] == next; })->at(1);
    }
  }
}

bool VertexRings::can_collapse(Index gone, Index kept, std::size_t most) const {
  const Ring& ring = rings_[gone];
  if (ring.size() > most || ring.size() + rings_[kept].size() - 4 > most) return false;
  int common = 0;
  for (const Index other : ring) {
    if (!holds_vertex(rings_[kept], other)) continue;
    ++common;
    if (rings_[other].size() < 4) return false;
  }
  return common == 2;
}

RemovedVertex VertexRings::collapse(Index gone, Index kept) {
  RemovedVertex removed{gone, std::exchange(rings_[gone], {})};
  Ring& ring = removed.ring;
  std::rotate(ring.begin(), std::find(ring.begin(), ring.end(), kept), ring.end());
  for (std::size_t i = 1; i < ring.size(); ++i) {
    Ring& other = rings_[ring[i]];
    const auto place = std::find(other.begin(), other.end(), gone);
    if (i == 1 || i + 1 == ring.size())
      other.erase(place);
    else
      *place = kept;
  }
  Ring& own = rings_[kept];
  const auto place = own.erase(std::find(own.begin(), own.end(), gone));
  own.insert(place, ring.begin() + 2, ring.end() - 1);
  return removed;
}

void VertexRings::restore(const RemovedVertex& removed) {
  const Index vertex = removed.vertex;
  const Ring& ring = removed.ring;
  Ring& own = rings_[ring.front()];
  for (std::size_t i = 2; i + 1 < ring.size(); ++i) {
    own.erase(std::find(own.begin(), own.end(), ring[i]));
    Ring& other = rings_[ring[i]];
    *std::find(other.begin(), other.end(), ring.front()) = vertex;
  }
  own.insert(std::find(own.begin(), own.end(), ring.back()), vertex);
  Ring& first = rings_[ring[1]];
  first.insert(std::find(first.begin(), first.end(), ring.front()), vertex);
  Ring& last = rings_[ring.back()];
  last.insert(std::find(last.begin(), last.end(), ring.front()) + 1, vertex);
  rings_[vertex] = ring;
}

std::vector<RemovedVertex> remove_to_tetrahedron(const Mesh& mesh, VertexRings& rings) {
  return VertexRemover(mesh, rings).run();
}

}  // namespace batten
