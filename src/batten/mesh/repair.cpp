#include "batten/mesh/repair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "batten/error.h"
#include "batten/mesh/repair_draft.h"
#include "batten/mesh/repair_tags.h"
#include "batten/progress.h"

namespace batten {

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::BadShape, what + "; it cannot be repaired");
}

void require_shape(const Mesh& mesh) {
  const auto& offsets = mesh.face_offsets;
  const auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  // Splitting may give each corner a vertex of its own.
  if (mesh.face_vertices.size() + static_cast<std::size_t>(mesh.points.rows()) > most) {
    throw Error(ErrorCode::TooLarge, "the mesh has more than 2^31 - 1 vertices and corners; split it");
  }
  if (offsets.empty() || offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end()) ||
      static_cast<std::size_t>(offsets.back()) != mesh.face_vertices.size()) {
    refuse("face_offsets must start with 0, not decrease, and end with the number of corners");
  }
  for (const Attribute& attribute : mesh.attributes) {
    const std::string name = "attribute '" + attribute.name + "'";
    if (!attribute.per_corner()) {
      if (attribute.values.rows() != mesh.points.rows()) refuse(name + " must have one row a vertex");
      continue;
    }
    const auto fits = [&](Index row) { return row >= -1 && row < attribute.values.rows(); };
    if (attribute.corner_rows.size() != mesh.face_vertices.size() ||
        !std::all_of(attribute.corner_rows.begin(), attribute.corner_rows.end(), fits)) {
      refuse(name + " must have one existing row a corner");
    }
  }
  for (std::size_t i = 0; i < mesh.groups.size(); ++i) {
    if (mesh.groups[i].first_face < (i == 0 ? 0 : mesh.groups[i - 1].first_face)) {
      refuse("groups must be in the order of their first faces");
    }
  }
}

double diagonal_of(const Draft& draft) {
  if (draft.vertices.empty()) return 0.0;
  Eigen::Vector3d low = draft.point(draft.vertices[0]);
  Eigen::Vector3d high = low;
  for (const Index v : draft.vertices) {
    low = low.cwiseMin(draft.point(v));
    high = high.cwiseMax(draft.point(v));
  }
  return (high - low).norm();
}

void weld(Draft& draft, const RepairOptions& options, RepairLog& log, const Progress& progress) {
  double left = 1.0;
  // The loop ends, because each collapse removes corners and each stitch removes open edges. The diagonal is that of
  // the current draft, so that the last round does what another repair would do.
  for (;;) {
    // The number of rounds is unknown; usually one round welds and one finds nothing.
    report_progress(progress, 1.0 - left);
    left *= 0.5;
    const Rim rim(draft, options.weld > 0.0 ? options.weld * diagonal_of(draft) : 0.0);
    if (collapse(draft, rim, log)) {
      drop_repeated_faces(draft, log);
      split(draft, log);
    } else if (!stitch(draft, rim)) {
      return;
    }
  }
}

void mend(Draft& draft, const RepairOptions& options, RepairLog& log, const Progress& progress) {
  simplify_faces(draft, log);
  drop_repeated_faces(draft, log);
  report_progress(progress, 0.25);
  split(draft, log);
  if (options.weld >= 0.0) weld(draft, options, log, progress_within(progress, 0.5, 0.9));
  turn_outwards(draft);
  report_progress(progress, 0.9);
}

/// Numbers the vertices that a face uses, in order, and records what became of the input's vertices.
void number_vertices(const Draft& draft, RepairResult& result, RepairLog& log) {
  const auto input_count = static_cast<std::size_t>(draft.input.vertex_count());
  result.vertex_targets.assign(input_count, -1);
  Buffer<Index> numbers(draft.vertex_sources.size(), -1);
  for (const Index v : draft.vertices) numbers[v] = 0;
  // Points of a mesh without faces are its content and are not isolated.
  const bool only_points = draft.input.face_count() == 0;
  for (Index v = 0; v < draft.input.vertex_count() && only_points; ++v) {
    if (draft.input.points.row(v).allFinite()) numbers[v] = 0;
  }
  for (Index v = 0; v < draft.vertex_count(); ++v) {
    if (numbers[v] < 0) continue;
    numbers[v] = static_cast<Index>(result.vertex_sources.size());
    result.vertex_sources.push_back(draft.source(v));
    if (only_points) result.vertex_targets[v] = numbers[v];
  }
  result.mesh.face_offsets = draft.offsets;
  result.mesh.face_vertices.resize(draft.vertices.size());
  Buffer<std::uint8_t> split(input_count, 0);
  Buffer<std::uint8_t> welded(input_count, 0);
  for (std::size_t c = 0; c < draft.vertices.size(); ++c) {
    const Index number = numbers[draft.vertices[c]];
    const Index v = draft.input.face_vertices[draft.corner_sources[c]];
    result.mesh.face_vertices[c] = number;
    Index& target = result.vertex_targets[v];
    if (target >= 0 && target != number) split[v] = 1;
    target = target < 0 ? number : std::min(target, number);
    if (result.vertex_sources[number] != v) welded[v] = 1;
  }
  for (Index v = 0; v < draft.input.vertex_count(); ++v) {
    if (result.vertex_targets[v] < 0) log.add(RepairKind::IsolatedVertices, v);
    if (split[v] != 0) log.add(RepairKind::SplitVertices, v);
    if (welded[v] != 0) log.add(RepairKind::WeldedVertices, v);
  }
}

void number_faces(const Draft& draft, RepairResult& result, RepairLog& log) {
  result.face_sources = draft.face_sources;
  result.face_targets.assign(static_cast<std::size_t>(draft.input.face_count()), -1);
  for (Index f = 0; f < draft.face_count(); ++f) {
    Index& target = result.face_targets[draft.face_sources[f]];
    if (target < 0) target = f;
    if (draft.reversed[f] != 0) log.add(RepairKind::ReversedFaces, draft.face_sources[f]);
  }
}

}  // namespace

RepairResult repair(const Mesh& mesh, const RepairOptions& options, const Progress& progress) {
  if (!(options.weld <= 1.0) || !std::isfinite(options.weld)) {
    throw Error(ErrorCode::BadArgument, "the welding distance must be at most 1, the bounding box's diagonal");
  }
  require_shape(mesh);
  RepairResult result;
  RepairLog log;
  report_progress(progress, 0.0);
  Draft draft = draft_of(mesh, log);
  mend(draft, options, log, progress);
  number_vertices(draft, result, log);
  number_faces(draft, result, log);
  carry_over(draft, result, log);
  result.changes = log.take();
  if (result.changes.empty()) result.mesh = mesh;
  return result;
}

}  // namespace batten
