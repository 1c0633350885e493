/// \file Numbers over a limit surface that colours can show: curvature, valence, sharpness, distances.
#pragma once
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// What the numbers say.
enum class SurfaceField {
  Missed,             ///< the distance from the limit position of each vertex to its target
  Moved,              ///< the distance from each control point to the limit position of its vertex
  MeanCurvature,      ///< of the limit surface, 1/unit
  GaussianCurvature,  ///< of the limit surface, 1/unit^2
  Valence,            ///< vertex_valences()
  Sharpness           ///< vertex_sharpnesses(): creases and corners
};

/// True for the fields that the control mesh's vertices alone do not have.
constexpr bool is_curvature(SurfaceField field) {
  return field == SurfaceField::MeanCurvature || field == SurfaceField::GaussianCurvature;
}

/// The surface that a field belongs to, and for SurfaceField::Missed the points that it should pass through.
struct FieldSurface {
  const Topology& topology;
  const Scheme& scheme;
  Eigen::Ref<const Values, 0, Eigen::OuterStride<>> control;  ///< V-by-3; not copied
  /// Null, or not more than V rows: row i is the target of vertex i. Vertices without a target have an error of 0.
  const Points* targets = nullptr;
};

/// A number for each vertex of the control mesh. O(H). Throws Error(BadArgument) for a curvature and for Missed without
/// targets, Error(BadShape) for more targets than vertices.
Scalars vertex_field(const FieldSurface& surface, SurfaceField field);

/// A number for each vertex of surface_mesh(topology, scheme, control, levels). Fields of the control mesh's vertices
/// are linear over its faces, but that sharpness fades within a quarter of a face off the creases
/// (tessellate/grid_fields.h). Curvature is exact, by the surface's second derivatives; on a crease it is that of one
/// side; at extraordinary vertices, where the surface has none, the mean over the neighbours; NaN where there is none
/// either. O(4^levels H), threaded. Throws what vertex_field, LimitSurface and Tessellator throw.
Scalars surface_field(const FieldSurface& surface, SurfaceField field, int levels);

/// Numbers given at the control mesh's vertices, one each, spread linearly over its faces: a number for each vertex of
/// surface_mesh(topology, scheme, control, levels). O(4^levels H). Throws Error(BadShape) and what Tessellator throws.
Scalars spread_field(const FieldSurface& surface, const Scalars& numbers, int levels);

}  // namespace batten
