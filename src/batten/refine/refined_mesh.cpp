#include "batten/refine/refined_mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"
#include "batten/refine/face_varying.h"
#include "batten/refine/refined_values.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

/// The refined rows of an attribute at corners, by the parent's half-edges and faces.
class CornerStep {
 public:
  CornerStep(const Topology& topology, SchemeKind kind, const Attribute& attribute)
      : topology_(topology), rows_(attribute.corner_rows), values_(attribute.values) {
    edge_rows_.resize(rows_.size());
    Index next = static_cast<Index>(values_.rows());
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
      const Index twin = topology.twin(h);
      const bool first = twin < 0 || h < twin;
      if (rows_[h] < 0 || rows_[topology.next(h)] < 0) {
        edge_rows_[h] = -1;
      } else if (!first && rows_[h] == rows_[topology.next(twin)] && rows_[topology.next(h)] == rows_[twin]) {
        edge_rows_[h] = edge_rows_[twin];
      } else {
        edge_rows_[h] = next++;
      }
    }
    first_face_row_ = next;
    if (kind == SchemeKind::CatmullClark) next += topology.face_count();
    refined_.resize(next, values_.cols());
    fill(kind);
  }

  Index corner_row(Index h) const { return rows_[h]; }
  Index edge_row(Index h) const { return edge_rows_[h]; }
  Index face_row(Index face) const {
    for (Index h = topology_.face_begin(face); h < topology_.face_end(face); ++h) {
      if (rows_[h] < 0) return -1;
    }
    return first_face_row_ + face;
  }
  Values take_values() { return std::move(refined_); }

 private:
  void fill(SchemeKind kind) {
    refined_.topRows(values_.rows()) = values_;
    parallel_for(topology_.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto f = static_cast<Index>(begin); f < end; ++f) {
        for (Index h = topology_.face_begin(f); h < topology_.face_end(f); ++h) fill_edge(h);
        if (kind == SchemeKind::CatmullClark) fill_face(f);
      }
    });
  }

  void fill_edge(Index h) {
    const Index twin = topology_.twin(h);
    if (edge_rows_[h] < 0 || (twin >= 0 && twin < h && edge_rows_[twin] == edge_rows_[h])) return;
    refined_.row(edge_rows_[h]) = 0.5 * (values_.row(rows_[h]) + values_.row(rows_[topology_.next(h)]));
  }

  void fill_face(Index face) {
    auto centre = refined_.row(first_face_row_ + face);
    centre.setZero();
    if (face_row(face) < 0) return;
    for (Index h = topology_.face_begin(face); h < topology_.face_end(face); ++h) centre += values_.row(rows_[h]);
    centre /= topology_.face_size(face);
  }

  const Topology& topology_;
  const Buffer<Index>& rows_;
  const Values& values_;
  Buffer<Index> edge_rows_;
  Index first_face_row_ = 0;
  Values refined_;
};

/// The children of the faces before `face` come before the children of `face`.
Index first_child(const Topology& topology, SchemeKind kind, Index face) {
  return kind == SchemeKind::CatmullClark ? topology.tables().face_offsets[face] : 4 * face;
}

/// The parts of one level, of equal length; each level takes four times as long as the one before.
class LevelProgress {
 public:
  LevelProgress(const Progress& progress, int levels_left, std::size_t parts)
      : progress_(progress), begin_(std::pow(0.25, levels_left)), end_(4.0 * begin_), parts_(parts) {}

  Progress operator()(std::size_t part) const {
    const double length = (end_ - begin_) / static_cast<double>(parts_);
    return progress_within(progress_, begin_ + length * static_cast<double>(part),
                           begin_ + length * static_cast<double>(part + 1));
  }

 private:
  const Progress& progress_;
  double begin_;
  double end_;
  std::size_t parts_;
};

Mesh mesh_of(const Topology& topology, const Scheme& scheme, const Mesh& control, const Values& points,
             std::vector<Attribute> attributes, std::vector<Group> groups) {
  Mesh mesh = mesh_from_topology(topology);
  mesh.points = points;
  mesh.attributes = std::move(attributes);
  mesh.groups = std::move(groups);
  mesh.material_libraries = control.material_libraries;
  state_scheme(scheme, mesh);
  return mesh;
}

/// An attribute of the mesh, level by level.
class CarriedAttribute {
 public:
  CarriedAttribute(const Topology& topology, const Scheme& scheme, Attribute attribute, int levels)
      : attribute_(std::move(attribute)) {
    if (levels == 0) return;
    if (!attribute_.per_corner()) {
      require_finite(attribute_.values, ("attribute '" + attribute_.name + "'").c_str());
    } else if (!scheme.has_linear_corners()) {
      surface_ = face_varying_surface(topology, scheme, attribute_);
    }
  }

  void refine(const Refinement& step, const Topology& parent, const Progress& progress) {
    const SchemeKind kind = step.scheme().kind;
    if (surface_) {
      surface_ = surface_->refined(progress);
    } else if (attribute_.per_corner()) {
      attribute_ = refine_at_corners(parent, kind, attribute_);
    } else if (attribute_.carry == CarryRule::Midpoint) {
      attribute_.values = refine_midpoints(parent, kind, attribute_.values, progress);
    } else {
      attribute_.values = step.apply(attribute_.values, progress);
    }
  }

  Attribute take() { return surface_ ? surface_->attribute(attribute_.name) : std::move(attribute_); }

 private:
  Attribute attribute_;
  std::optional<FaceVaryingSurface> surface_;  ///< of values at corners that are not linear
};

}  // namespace

Attribute refine_at_corners(const Topology& topology, SchemeKind kind, const Attribute& attribute) {
  if (static_cast<Index>(attribute.corner_rows.size()) != topology.half_edge_count()) {
    throw Error(ErrorCode::BadShape, "attribute '" + attribute.name + "' must have one row number per corner");
  }
  CornerStep step(topology, kind, attribute);
  Buffer<Index> rows(static_cast<std::size_t>(topology.half_edge_count()) * 4);
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index first = topology.face_begin(f);
      const Index face_row = kind == SchemeKind::CatmullClark ? step.face_row(f) : -1;
      for (Index h = first; h < topology.face_end(f); ++h) {
        const Index before = step.edge_row(topology.previous(h));
        if (kind == SchemeKind::CatmullClark) {
          const Index quad[] = {step.corner_row(h), step.edge_row(h), face_row, before};
          std::copy(quad, quad + 4, rows.begin() + std::ptrdiff_t{4} * h);
        } else {
          const Index triangle[] = {step.corner_row(h), step.edge_row(h), before};
          std::copy(triangle, triangle + 3, rows.begin() + std::ptrdiff_t{12} * f + 3 * (h - first));
          rows[std::ptrdiff_t{12} * f + 9 + (h - first)] = step.edge_row(h);
        }
      }
    }
  });
  return {attribute.name, step.take_values(), std::move(rows)};
}

Attribute refine_at_corners(const Topology& topology, const Scheme& scheme, const Attribute& attribute) {
  if (scheme.has_linear_corners()) return refine_at_corners(topology, scheme.kind, attribute);
  return face_varying_surface(topology, scheme, attribute).refined().attribute(attribute.name);
}

Values refine_midpoints(const Topology& topology, SchemeKind kind, ConstValuesRef values, const Progress& progress) {
  require_vertex_rows(topology, values);
  const Index vertices = topology.vertex_count();
  const Index edges = topology.edge_count();
  Values refined(refined_vertex_count(topology, kind), values.cols());
  refined.topRows(vertices) = values;
  parallel_for(
      edges,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto e = static_cast<Index>(begin); e < end; ++e) {
          const Index h = topology.edge_half_edge(e);
          refined.row(vertices + e) = 0.5 * (values.row(topology.origin(h)) + values.row(topology.destination(h)));
        }
      },
      kDefaultBlock, progress);
  if (kind != SchemeKind::CatmullClark) return refined;
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      auto mean = refined.row(vertices + edges + f);
      mean.setZero();
      for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) mean += values.row(topology.origin(h));
      mean /= topology.face_size(f);
    }
  });
  return refined;
}

std::vector<Group> refine_groups(const Topology& topology, SchemeKind kind, std::vector<Group> groups) {
  for (Group& group : groups) group.first_face = first_child(topology, kind, group.first_face);
  return groups;
}

RefinedMesh refine_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                        const Progress& progress) {
  if (levels < 0) throw Error(ErrorCode::BadArgument, "levels must not be negative");
  Values points = control.points;
  std::vector<Group> groups = control.groups;
  Topology current = with_surface_holes(topology, scheme);
  std::vector<CarriedAttribute> carried;
  for (const Attribute& attribute : control.attributes) {
    if (attribute.name != "normal") carried.emplace_back(current, scheme, attribute, levels);
  }
  Scheme step_scheme = scheme;
  for (int level = 0; level < levels; ++level) {
    const LevelProgress parts(progress, levels - level, carried.size() + 2);
    Refinement step(current, step_scheme, {}, parts(0));
    points = step.apply(points, parts(1));
    for (std::size_t i = 0; i < carried.size(); ++i) carried[i].refine(step, current, parts(i + 2));
    groups = refine_groups(current, scheme.kind, std::move(groups));
    current = step.child();
    step_scheme = scheme.after_first_step();
  }
  std::vector<Attribute> attributes;
  attributes.reserve(carried.size());
  for (CarriedAttribute& attribute : carried) attributes.push_back(attribute.take());
  Mesh mesh = mesh_of(current, scheme, control, points, std::move(attributes), std::move(groups));
  return {current, std::move(mesh)};
}

}  // namespace batten
