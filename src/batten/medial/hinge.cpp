#include "batten/medial/hinge.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "batten/error.h"

namespace batten {

namespace {

/// Vertices one after the other, as the faces that were there had them.
using Loop = std::vector<Index>;

class HingeJoiner {
 public:
  HingeJoiner(const MedialModel& model, const std::vector<BoundaryFace>& origins, MedialBoundary& boundary)
      : model_(model), origins_(origins), boundary_(boundary), opened_(origins.size(), 0) {}

  void join_all() {
    std::vector<std::pair<Loop, Loop>> loops;
    for (hinge_ = 0; hinge_ < model_.hinges.size(); ++hinge_) {
      const MedialHinge& hinge = model_.hinges[hinge_];
      Loop child = open(hinge.child);
      loops.emplace_back(std::move(child), open(hinge.parent));
    }
    drop_opened_faces();
    Mesh& mesh = boundary_.mesh;
    if (!mesh.groups.empty()) mesh.groups.push_back({"o", "hinges", mesh.face_count()});
    for (const auto& [child, parent] : loops) add_ring(child, parent);
    drop_vertices_without_face();
  }

 private:
  [[noreturn]] void fail(ErrorCode code, const std::string& message) const {
    throw Error(code, "hinge " + std::to_string(hinge_) + ": " + message);
  }

  /// The faces that a place opens.
  std::vector<Index> faces_at(const HingePlace& place) const {
    if (place.figure < 0 || place.figure >= static_cast<Index>(model_.figures.size()))
      fail(ErrorCode::IndexOutOfRange, "there is no figure " + std::to_string(place.figure));
    if (place.edge.empty() == place.faces.empty())
      fail(ErrorCode::BadArgument, "give either an edge of atoms or faces of the sheet");
    std::set<std::pair<Index, Index>> edges;
    for (std::size_t i = 0; i + 1 < place.edge.size(); ++i) edges.insert(std::minmax(place.edge[i], place.edge[i + 1]));
    const std::set<Index> faces(place.faces.begin(), place.faces.end());
    std::vector<Index> found;
    for (std::size_t i = 0; i < origins_.size(); ++i) {
      const BoundaryFace& origin = origins_[i];
      const bool here = origin.side == SpokeSide::Crest ? edges.count(std::minmax(origin.first, origin.second)) > 0
                                                        : origin.side == place.side && faces.count(origin.first) > 0;
      if (here && origin.figure == place.figure) found.push_back(static_cast<Index>(i));
    }
    if (found.size() != 2 * edges.size() + faces.size() || found.empty())
      fail(ErrorCode::BadArgument,
           "its atoms are not neighbours along the edge of the sheet, or its faces do not exist");
    return found;
  }

  /// Marks the faces of a place as opened; returns the loop around them.
  Loop open(const HingePlace& place) {
    const Mesh& mesh = boundary_.mesh;
    std::set<std::pair<Index, Index>> sides;
    for (const Index face : faces_at(place)) {
      if (opened_[static_cast<std::size_t>(face)] != 0)
        fail(ErrorCode::BadArgument, "another hinge opens the same place");
      opened_[static_cast<std::size_t>(face)] = 1;
      const Index size = mesh.face_size(face);
      const Index* corners = mesh.face_vertices.data() + mesh.face_offsets[face];
      for (Index k = 0; k < size; ++k) sides.insert({corners[k], corners[(k + 1) % size]});
    }
    std::map<Index, Index> next;
    std::size_t count = 0;
    for (const auto& [from, to] : sides) {
      if (sides.count({to, from}) > 0) continue;
      next[from] = to;
      ++count;
    }
    Loop loop;
    const Index start = next.empty() ? -1 : next.begin()->first;
    for (Index at = start; at >= 0 && loop.size() < count;) {
      loop.push_back(at);
      at = next.count(at) > 0 ? next[at] : -1;
      if (at == start) break;
    }
    if (loop.size() != count || next.size() != count)
      fail(ErrorCode::BadArgument, "its place is not one piece without holes");
    return loop;
  }

  void drop_opened_faces() {
    Mesh& mesh = boundary_.mesh;
    Buffer<Index> offsets{0};
    Buffer<Index> vertices;
    std::vector<Index> kept_before(origins_.size() + 1, 0);
    for (std::size_t face = 0; face < origins_.size(); ++face) {
      kept_before[face + 1] = kept_before[face] + (opened_[face] != 0 ? 0 : 1);
      if (opened_[face] != 0) continue;
      vertices.insert(vertices.end(), mesh.face_vertices.begin() + mesh.face_offsets[face],
                      mesh.face_vertices.begin() + mesh.face_offsets[face + 1]);
      offsets.push_back(static_cast<Index>(vertices.size()));
    }
    mesh.face_offsets = std::move(offsets);
    mesh.face_vertices = std::move(vertices);
    for (Group& group : mesh.groups) group.first_face = kept_before[static_cast<std::size_t>(group.first_face)];
  }

  double square_distance(Index a, Index b) const {
    return (boundary_.mesh.points.row(a) - boundary_.mesh.points.row(b)).squaredNorm();
  }

  /// The number of steps along a loop of `count` that belong to the first `done` of `all` steps.
  static std::size_t share(std::size_t done, std::size_t count, std::size_t all) { return done * count / all; }

  /// The turn of `other` for which matched vertices are nearest to each other.
  std::size_t best_turn(const Loop& loop, const Loop& other) const {
    const std::size_t steps = std::max(loop.size(), other.size());
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t turn = 0; turn < other.size(); ++turn) {
      double sum = 0.0;
      for (std::size_t i = 0; i < steps; ++i) {
        sum += square_distance(loop[share(i, loop.size(), steps)],
                               other[(share(i, other.size(), steps) + turn) % other.size()]);
      }
      if (sum >= least) continue;
      least = sum;
      best = turn;
    }
    return best;
  }

  /// Quads, and triangles where only one of the loops goes on. Both loops have the direction of the faces that are
  /// gone, so that the second is gone along backwards.
  void add_ring(const Loop& child, const Loop& parent) {
    Loop back(parent.rbegin(), parent.rend());
    std::rotate(back.begin(), back.begin() + static_cast<std::ptrdiff_t>(best_turn(child, back)), back.end());
    const std::size_t steps = std::max(child.size(), back.size());
    for (std::size_t i = 0; i < steps; ++i) {
      const std::size_t here = share(i, child.size(), steps);
      const std::size_t there = share(i, back.size(), steps);
      const std::size_t next_here = share(i + 1, child.size(), steps);
      const std::size_t next_there = share(i + 1, back.size(), steps);
      const Index a = child[here];
      const Index b = child[next_here % child.size()];
      const Index c = back[next_there % back.size()];
      const Index d = back[there];
      if (next_here == here) {
        boundary_.mesh.add_face({a, c, d});
      } else if (next_there == there) {
        boundary_.mesh.add_face({a, b, d});
      } else {
        boundary_.mesh.add_face({a, b, c, d});
      }
    }
  }

  void drop_vertices_without_face() {
    Mesh& mesh = boundary_.mesh;
    std::vector<Index> numbers(boundary_.ends.size(), -1);
    for (const Index vertex : mesh.face_vertices) numbers[static_cast<std::size_t>(vertex)] = 0;
    std::vector<Index> kept;
    std::vector<SpokeEnd> ends;
    for (std::size_t vertex = 0; vertex < numbers.size(); ++vertex) {
      if (numbers[vertex] < 0) continue;
      numbers[vertex] = static_cast<Index>(kept.size());
      kept.push_back(static_cast<Index>(vertex));
      ends.push_back(boundary_.ends[vertex]);
    }
    for (Index& vertex : mesh.face_vertices) vertex = numbers[static_cast<std::size_t>(vertex)];
    mesh.points = mesh.points(kept, Eigen::all).eval();
    boundary_.origins = boundary_.origins(kept, Eigen::all).eval();
    boundary_.directions = boundary_.directions(kept, Eigen::all).eval();
    boundary_.radii = boundary_.radii(kept).eval();
    boundary_.ends = std::move(ends);
  }

  const MedialModel& model_;
  const std::vector<BoundaryFace>& origins_;
  MedialBoundary& boundary_;
  std::vector<std::uint8_t> opened_;
  std::size_t hinge_ = 0;
};

}  // namespace

void join_figures(const MedialModel& model, const std::vector<BoundaryFace>& origins, MedialBoundary& boundary) {
  HingeJoiner(model, origins, boundary).join_all();
}

}  // namespace batten
