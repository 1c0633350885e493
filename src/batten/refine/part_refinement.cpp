#include "batten/refine/part_refinement.h"

#include <algorithm>
#include <array>
#include <utility>

#include "batten/error.h"
#include "batten/refine/refined_mesh.h"
#include "batten/scheme/scheme.h"

namespace batten {

namespace {

/// The tags of `given` on those vertices for which keep(vertex) is true, moved to place(vertex).
template <typename Keep, typename Place>
void add_tags(const Mesh& given, const Keep& keep, const Place& place, Mesh& mesh) {
  for (const Crease& crease : given.creases) {
    if (keep(crease.a)) mesh.creases.push_back({place(crease.a), place(crease.b), crease.sharpness});
  }
  for (const Corner& corner : given.corners) {
    if (keep(corner.vertex)) mesh.corners.push_back({place(corner.vertex), corner.sharpness});
  }
}

}  // namespace

PartRefinement::PartRefinement(const Topology& topology, const Topology& child, Buffer<std::uint8_t> is_refined)
    : parent_(topology), is_refined_(std::move(is_refined)), part_(topology) {
  if (static_cast<Index>(is_refined_.size()) != topology.face_count() ||
      child.face_count() != topology.half_edge_count()) {
    throw Error(ErrorCode::BadShape, "a refinement of parts needs a flag a face and the whole refinement");
  }
  place_faces();
  place_vertices(child);
  part_ = Topology(tagged_mesh(child));
}

void PartRefinement::place_faces() {
  first_face_.assign(is_refined_.size() + 1, 0);
  for (Index f = 0; f < parent_.face_count(); ++f) {
    first_face_[f + 1] = first_face_[f] + (is_refined_[f] != 0 ? parent_.face_size(f) : 1);
  }
}

void PartRefinement::place_vertices(const Topology& child) {
  places_.assign(static_cast<std::size_t>(child.vertex_count()), -1);
  for (Index v = 0; v < parent_.vertex_count(); ++v) places_[v] = v;
  for (Index f = 0; f < parent_.face_count(); ++f) {
    if (is_refined_[f] == 0) continue;
    // Child h stands at the corner where half-edge h starts.
    for (Index h = parent_.face_begin(f); h < parent_.face_end(f); ++h) {
      for (Index k = child.face_begin(h); k < child.face_end(h); ++k) places_[child.origin(k)] = 0;
    }
  }
  sources_.clear();
  for (Index v = 0; v < child.vertex_count(); ++v) {
    if (v >= parent_.vertex_count() && places_[v] < 0) continue;
    places_[v] = static_cast<Index>(sources_.size());
    sources_.push_back(v);
  }
}

Mesh PartRefinement::tagged_mesh(const Topology& child) const {
  Buffer<std::uint8_t> moved(places_.size(), 0);
  Mesh mesh;
  mesh.points = Points::Zero(static_cast<Eigen::Index>(sources_.size()), 3);
  const auto add_face = [&](const Topology& from, Index face) {
    for (Index h = from.face_begin(face); h < from.face_end(face); ++h) {
      mesh.face_vertices.push_back(places_[from.origin(h)]);
    }
    if (from.is_hole(face)) mesh.holes.push_back(mesh.face_count());
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  };
  for (Index f = 0; f < parent_.face_count(); ++f) {
    if (is_refined_[f] == 0) {
      add_face(parent_, f);
      continue;
    }
    for (Index h = parent_.face_begin(f); h < parent_.face_end(f); ++h) {
      add_face(child, h);
      for (Index k = child.face_begin(h); k < child.face_end(h); ++k) moved[child.origin(k)] = 1;
    }
  }
  const auto place = [&](Index v) { return places_[v]; };
  add_tags(
      mesh_from_topology(parent_), [&](Index v) { return moved[v] == 0; }, place, mesh);
  add_tags(
      mesh_from_topology(child), [&](Index v) { return moved[v] != 0; }, place, mesh);
  return mesh;
}

Values PartRefinement::choose(ConstValuesRef before, ConstValuesRef after) const {
  require_vertex_rows(parent_, before);
  if (after.rows() != static_cast<Eigen::Index>(places_.size()) || after.cols() != before.cols()) {
    throw Error(ErrorCode::BadShape, "refined values must have one row for each vertex of the whole refinement");
  }
  Values chosen(static_cast<Eigen::Index>(sources_.size()), before.cols());
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    chosen.row(static_cast<Eigen::Index>(i)) = after.row(sources_[i]);
  }
  for (Index f = 0; f < parent_.face_count(); ++f) {
    if (is_refined_[f] != 0) continue;
    for (Index h = parent_.face_begin(f); h < parent_.face_end(f); ++h) {
      chosen.row(parent_.origin(h)) = before.row(parent_.origin(h));
    }
  }
  return chosen;
}

namespace {

/// Steps that are not linear change the attribute's own rows, which faces that are left as they are still have.
void put_own_rows_first(const Attribute& attribute, Attribute& all) {
  Values values(attribute.values.rows() + all.values.rows(), attribute.values.cols());
  values << attribute.values, all.values;
  all.values = std::move(values);
  const auto own = static_cast<Index>(attribute.values.rows());
  for (Index& row : all.corner_rows) row = row < 0 ? row : row + own;
}

}  // namespace

Attribute PartRefinement::at_corners(const Scheme& scheme, const Attribute& attribute) const {
  Attribute all = refine_at_corners(parent_, scheme, attribute);
  if (!scheme.has_linear_corners()) put_own_rows_first(attribute, all);
  Attribute part{attribute.name, Values(), Buffer<Index>()};
  for (Index f = 0; f < parent_.face_count(); ++f) {
    const bool refined = is_refined_[f] != 0;
    const Buffer<Index>& rows = refined ? all.corner_rows : attribute.corner_rows;
    const std::ptrdiff_t corners = refined ? 4 : 1;  // of the result for each one of the parent
    part.corner_rows.insert(part.corner_rows.end(), rows.begin() + corners * parent_.face_begin(f),
                            rows.begin() + corners * parent_.face_end(f));
  }
  // The attribute's own rows stay; of the new ones, those that a corner has.
  Buffer<Index> number(static_cast<std::size_t>(all.values.rows()), -1);
  for (const Index row : part.corner_rows) {
    if (row >= 0) number[row] = 0;
  }
  std::fill(number.begin(), number.begin() + attribute.values.rows(), 0);
  std::vector<Index> kept;
  for (Index row = 0; row < static_cast<Index>(number.size()); ++row) {
    if (number[row] < 0) continue;
    number[row] = static_cast<Index>(kept.size());
    kept.push_back(row);
  }
  part.values = all.values(kept, Eigen::all);
  for (Index& row : part.corner_rows) row = row < 0 ? row : number[row];
  return part;
}

std::vector<Group> PartRefinement::groups(std::vector<Group> groups) const {
  for (Group& group : groups) group.first_face = first_face_[group.first_face];
  return groups;
}

}  // namespace batten
