/// \file surface_mesh() against uniform refinement and the limit matrix: the same faces, with the same points, normals,
/// attributes and groups.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/face_varying.h"
#include "batten/refine/refined_mesh.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/tessellate/tessellator.h"
#include "support/tessellation.h"

namespace batten::test {

/// For each vertex of the tessellation Refinement's; the isolated ones of the control mesh are themselves.
inline Buffer<Index> refined_partners(const Topology& topology, const Scheme& scheme, int levels) {
  const Tessellator tessellator(topology, scheme, levels);
  std::vector<Topology> bases{tessellator.base()};
  for (Index n = 1; n < tessellator.steps(); n *= 2) {
    bases.push_back(Refinement(bases.back(), scheme.after_first_step()).child());
  }
  Buffer<Index> partner(static_cast<std::size_t>(tessellator.vertex_count()));
  for (Index v = 0; v < topology.vertex_count(); ++v) partner[v] = v;
  const bool quads = tessellator.face_size() == 4;
  for (Index f = 0; f < tessellator.base().face_count(); ++f) {
    for (Index j = 0; j <= tessellator.steps(); ++j) {
      for (Index i = 0; i <= tessellator.steps() - (quads ? 0 : j); ++i) {
        partner[tessellator.vertex(f, i, j)] = refined_vertex(bases, quads, f, i, j);
      }
    }
  }
  return partner;
}

/// The names in force at a face, keyword by keyword.
inline std::map<std::string, std::string> groups_at(const Mesh& mesh, Index face) {
  std::map<std::string, std::string> names;
  for (const Group& group : mesh.groups) {
    if (group.first_face <= face) names[group.keyword] = group.name;
  }
  return names;
}

struct SurfaceMeshErrors {
  double points = 0.0;      ///< relative to the size
  double attributes = 0.0;  ///< absolute, at vertices and at corners
  double normals = 0.0;     ///< at corners
};

/// The limit of values at the corners of a refined mesh.
inline Attribute corner_limit(const Topology& topology, const Scheme& scheme, const Attribute& attribute) {
  if (scheme.has_linear_corners()) return attribute;
  FaceVaryingSurface surface = face_varying_surface(topology, scheme, attribute);
  surface.values = LimitMatrix(surface.topology, surface.scheme).apply(surface.values);
  return surface.attribute(attribute.name);
}

inline SurfaceMeshErrors compare_surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                              int levels) {
  const RefinedMesh refined = refine_mesh(topology, scheme, control, levels);
  const Scheme last = levels > 0 ? scheme.after_first_step() : scheme;
  const LimitMatrix limit(refined.topology, last);
  const Values points = limit.apply(refined.mesh.points);
  const LimitNormals normals = limit_normals(refined.topology, last, refined.mesh.points);
  const Mesh surface = surface_mesh(topology, scheme, control, levels);
  Buffer<Index> partner;
  if (levels > 0) partner = refined_partners(topology, scheme, levels);
  for (Index v = 0; levels == 0 && v < topology.vertex_count(); ++v) partner.push_back(v);

  SurfaceMeshErrors errors;
  const double size = std::max(bounding_diagonal(control.points), control.points.cwiseAbs().maxCoeff());
  const auto grow = [](double& error, double now) { error = now > error || now != now ? now : error; };
  EXPECT_EQ(surface.vertex_count(), refined.mesh.vertex_count());
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    grow(errors.points, (surface.points.row(v) - points.row(partner[v])).norm() / size);
  }
  std::deque<Attribute> limits;
  std::vector<std::pair<const Attribute*, const Attribute*>> at_corners;
  std::size_t place = 0;
  for (const Attribute& theirs : refined.mesh.attributes) {
    if (theirs.per_corner() && surface.face_count() == 0) continue;  // no corners
    const Attribute& ours = surface.attributes.at(place++);
    EXPECT_EQ(ours.name, theirs.name);
    EXPECT_EQ(ours.per_corner(), theirs.per_corner());
    if (theirs.per_corner()) {
      limits.push_back(corner_limit(refined.topology, last, theirs));
      at_corners.emplace_back(&ours, &limits.back());
      continue;
    }
    const Values expected = theirs.carry == CarryRule::Midpoint ? theirs.values : limit.apply(theirs.values);
    for (Index v = 0; v < surface.vertex_count(); ++v) {
      grow(errors.attributes, (ours.values.row(v) - expected.row(partner[v])).norm());
    }
  }
  const Attribute& at_vertices = surface.attributes.at(place++);
  const Attribute* differing = place < surface.attributes.size() ? &surface.attributes.at(place) : nullptr;

  // A face is known by its vertices, the lowest first.
  const auto key_of = [](std::vector<Index> face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
  };
  const Topology& finest = refined.topology;
  std::map<std::vector<Index>, Index> faces;
  for (Index f = 0; f < finest.face_count(); ++f) {
    if (finest.is_hole(f)) continue;
    std::vector<Index> face;
    for (Index h = finest.face_begin(f); h < finest.face_end(f); ++h) face.push_back(finest.origin(h));
    faces[key_of(face)] = f;
  }
  EXPECT_EQ(static_cast<std::size_t>(surface.face_count()), faces.size());
  for (Index f = 0; f < surface.face_count(); ++f) {
    std::vector<Index> face;
    for (Index c = surface.face_offsets[f]; c < surface.face_offsets[f + 1]; ++c) {
      face.push_back(partner[surface.face_vertices[c]]);
    }
    const auto found = faces.find(key_of(face));
    if (found == faces.end()) {
      ADD_FAILURE() << "face " << f << " is no refined face";
      return errors;
    }
    EXPECT_EQ(groups_at(surface, f), groups_at(refined.mesh, found->second)) << "face " << f;
    for (Index c = surface.face_offsets[f]; c < surface.face_offsets[f + 1]; ++c) {
      Index h = finest.face_begin(found->second);
      while (finest.origin(h) != partner[surface.face_vertices[c]]) ++h;
      const Eigen::RowVector3d normal = differing != nullptr ? differing->values.row(differing->corner_rows[c])
                                                             : at_vertices.values.row(surface.face_vertices[c]);
      grow(errors.normals, (normal - normals.corners.row(h)).norm());
      for (const auto& [ours, theirs] : at_corners) {
        const Index our_row = ours->corner_rows[c];
        const Index their_row = theirs->corner_rows[h];
        EXPECT_EQ(our_row < 0, their_row < 0) << "corner " << c;
        if (our_row < 0 || their_row < 0) continue;
        grow(errors.attributes, (ours->values.row(our_row) - theirs->values.row(their_row)).norm());
      }
    }
  }
  return errors;
}

}  // namespace batten::test
