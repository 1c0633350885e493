/// Repairs of single faces: indices, numbers, repeated vertices, repeated faces.
#include <algorithm>
#include <numeric>

#include "batten/mesh/face_normal.h"
#include "batten/mesh/repair_draft.h"

namespace batten {

Eigen::Vector3d Draft::normal(Index face) const {
  const Index first = offsets[face];
  return polygon_normal<Eigen::Vector3d>(offsets[face + 1] - first,
                                         [&](Index i) -> Eigen::Vector3d { return point(vertices[first + i]); });
}

EdgeFace Draft::edge_face(Index side, const SideTable& sides, const Orientation& orientation, bool forward) const {
  const Index face = sides.face(side);
  return {side, orientation.component[face], forward != (orientation.reversed[face] != 0), normal(face), forward};
}

void Draft::add_corner(Index vertex, Index corner_source) {
  vertices.push_back(vertex);
  corner_sources.push_back(corner_source);
}

void Draft::end_face(Index face_source, bool is_reversed) {
  offsets.push_back(static_cast<Index>(vertices.size()));
  face_sources.push_back(face_source);
  reversed.push_back(is_reversed ? 1 : 0);
}

Draft Draft::without_faces() const {
  Draft empty(input);
  empty.vertex_sources = vertex_sources;
  return empty;
}

void Draft::take_faces(Draft& other) {
  std::swap(offsets, other.offsets);
  std::swap(vertices, other.vertices);
  std::swap(corner_sources, other.corner_sources);
  std::swap(face_sources, other.face_sources);
  std::swap(reversed, other.reversed);
}

void Draft::drop_faces(const Buffer<std::uint8_t>& dropped) {
  Draft kept = without_faces();
  for (Index f = 0; f < face_count(); ++f) {
    if (dropped[f] == 0) kept.copy_face(*this, f);
  }
  take_faces(kept);
}

void Draft::copy_face(const Draft& other, Index face) {
  for (Index c = other.offsets[face]; c < other.offsets[face + 1]; ++c) {
    add_corner(other.vertices[c], other.corner_sources[c]);
  }
  end_face(other.face_sources[face], other.reversed[face] != 0);
}

void Draft::reverse(const Buffer<std::uint8_t>& faces) {
  for (Index f = 0; f < face_count(); ++f) {
    if (faces[f] == 0) continue;
    reversed[f] ^= 1;
    // The first corner is kept.
    std::reverse(vertices.begin() + offsets[f] + 1, vertices.begin() + offsets[f + 1]);
    std::reverse(corner_sources.begin() + offsets[f] + 1, corner_sources.begin() + offsets[f + 1]);
  }
}

Draft draft_of(const Mesh& input, RepairLog& log) {
  Draft draft(input);
  draft.vertex_sources.resize(static_cast<std::size_t>(input.vertex_count()));
  std::iota(draft.vertex_sources.begin(), draft.vertex_sources.end(), 0);
  Buffer<std::uint8_t> finite(draft.vertex_sources.size());
  for (Index v = 0; v < input.vertex_count(); ++v) finite[v] = input.points.row(v).allFinite() ? 1 : 0;
  const auto usable = [&](Index v) { return v >= 0 && v < input.vertex_count() && finite[v] != 0; };
  for (Index f = 0; f < input.face_count(); ++f) {
    const Index begin = input.face_offsets[f];
    const Index end = input.face_offsets[f + 1];
    if (!std::all_of(input.face_vertices.begin() + begin, input.face_vertices.begin() + end, usable)) {
      log.add(RepairKind::BadFaces, f);
      continue;
    }
    for (Index c = begin; c < end; ++c) draft.add_corner(input.face_vertices[c], c);
    draft.end_face(f, false);
  }
  return draft;
}

namespace {

bool is_simple(const Index* first, const Index* last, Buffer<Index>& sorted) {
  if (last - first < 3) return false;
  sorted.assign(first, last);
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

/// Cuts a face into loops without a repeated vertex. Walking along the face, each vertex that was met before closes a
/// loop.
class LoopCutter {
 public:
  LoopCutter(const Draft& draft, Index face, Buffer<Index> sorted) : draft_(draft), names_(std::move(sorted)) {
    names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
    depth_.assign(names_.size(), -1);
    for (Index c = draft.offsets[face]; c < draft.offsets[face + 1]; ++c) meet(c);
    close(0);
  }
  const std::vector<std::vector<Index>>& loops() const { return loops_; }  ///< the loops of three corners or more

 private:
  Index name(Index corner) const {
    const auto place = std::lower_bound(names_.begin(), names_.end(), draft_.vertices[corner]);
    return static_cast<Index>(place - names_.begin());
  }

  void meet(Index corner) {
    Index& depth = depth_[name(corner)];
    if (depth >= 0) {
      const Index kept = depth;
      close(kept);
      depth = kept;
    } else {
      depth = static_cast<Index>(path_.size());
    }
    path_.push_back(corner);
  }

  void close(Index depth) {
    if (static_cast<Index>(path_.size()) - depth >= 3) loops_.emplace_back(path_.begin() + depth, path_.end());
    for (auto i = static_cast<std::size_t>(depth); i < path_.size(); ++i) depth_[name(path_[i])] = -1;
    path_.resize(static_cast<std::size_t>(depth));
  }

  const Draft& draft_;
  Buffer<Index> names_;
  std::vector<Index> depth_;  ///< the position of each name in the path, or -1
  std::vector<Index> path_;
  std::vector<std::vector<Index>> loops_;
};

}  // namespace

bool simplify_faces(Draft& draft, RepairLog& log) {
  bool changed = false;
  Buffer<Index> sorted;
  Draft kept = draft.without_faces();
  for (Index f = 0; f < draft.face_count(); ++f) {
    const Index begin = draft.offsets[f];
    const Index end = draft.offsets[f + 1];
    if (is_simple(draft.vertices.data() + begin, draft.vertices.data() + end, sorted)) {
      kept.copy_face(draft, f);
      continue;
    }
    changed = true;
    sorted.assign(draft.vertices.begin() + begin, draft.vertices.begin() + end);
    std::sort(sorted.begin(), sorted.end());
    const LoopCutter cutter(draft, f, sorted);
    for (const std::vector<Index>& loop : cutter.loops()) {
      for (const Index c : loop) kept.add_corner(draft.vertices[c], draft.corner_sources[c]);
      kept.end_face(draft.face_sources[f], draft.reversed[f] != 0);
    }
    log.add(cutter.loops().empty() ? RepairKind::DegenerateFaces : RepairKind::SimplifiedFaces, draft.face_sources[f]);
  }
  if (changed) draft.take_faces(kept);
  return changed;
}

}  // namespace batten
