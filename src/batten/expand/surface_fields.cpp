#include "batten/expand/surface_fields.h"

#include <limits>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/vertex_fields.h"
#include "batten/parallel/parallel.h"
#include "batten/surface/curvature.h"
#include "batten/tessellate/grid_fields.h"

namespace batten {

namespace {

Scalars missed(const FieldSurface& surface, const Values& limit) {
  if (surface.targets == nullptr) {
    throw Error(ErrorCode::BadArgument,
                "an error is the distance to a point that the surface should pass through: "
                "give the points of the vertices");
  }
  const Points& targets = *surface.targets;
  if (targets.rows() > limit.rows()) {
    throw Error(ErrorCode::BadShape, "there are more targets (" + std::to_string(targets.rows()) + ") than vertices (" +
                                         std::to_string(limit.rows()) + ")");
  }
  // A mesh that was refined once for alpha has more vertices than targets; those have no error of their own.
  Scalars errors = Scalars::Zero(limit.rows());
  errors.head(targets.rows()) = (limit.topRows(targets.rows()) - targets).rowwise().norm();
  return errors;
}

Scalars curvature_field(const FieldSurface& surface, bool mean, int levels) {
  const SurfacePatches patches(surface.topology, surface.scheme);
  const Tessellator tessellator(patches, levels);
  const LimitSurface limit(patches, surface.control);
  const Buffer<SurfacePlace> places = vertex_places(tessellator);
  Scalars field = Scalars::Constant(static_cast<Eigen::Index>(places.size()), std::numeric_limits<double>::quiet_NaN());
  parallel_for(field.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (places[v].face < 0) continue;
      const PointCurvature curvature = curvature_of(limit.jet(places[v]));
      field[v] = mean ? curvature.mean : curvature.gaussian;
    }
  });
  Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) *
                      static_cast<std::size_t>(tessellator.face_size()));
  tessellator.faces(faces);
  fill_from_neighbours(tessellator.face_size(), faces, field);
  return field;
}

/// From the control mesh's vertices linearly over its faces.
Scalars spread(const Topology& topology, const Tessellator& tessellator, const Scalars& field) {
  const Eigen::Index given = field.size();
  const Attribute fine = tessellator.at_corners({"", field, topology.tables().origins});
  Buffer<Index> faces(fine.corner_rows.size());
  tessellator.faces(faces);
  // Those that no drawn face has are not seen.
  Scalars spread = Scalars::Constant(tessellator.vertex_count(), std::numeric_limits<double>::quiet_NaN());
  spread.head(given) = fine.values.topRows(given);
  for (std::size_t c = 0; c < faces.size(); ++c) spread[faces[c]] = fine.values(fine.corner_rows[c], 0);
  return spread;
}

}  // namespace

Scalars vertex_field(const FieldSurface& surface, SurfaceField field) {
  require_vertex_rows(surface.topology, surface.control);
  switch (field) {
    case SurfaceField::Valence:
      return vertex_valences(surface.topology);
    case SurfaceField::Sharpness:
      return vertex_sharpnesses(surface.topology);
    case SurfaceField::MeanCurvature:
    case SurfaceField::GaussianCurvature:
      throw Error(ErrorCode::BadArgument, "only the surface has a curvature, the control mesh has none");
    default:
      break;
  }
  const Values limit = LimitMatrix(surface.topology, surface.scheme).apply(surface.control);
  if (field == SurfaceField::Missed) return missed(surface, limit);
  return (limit - surface.control).rowwise().norm();
}

Scalars spread_field(const FieldSurface& surface, const Scalars& numbers, int levels) {
  require_vertex_rows(surface.topology, numbers);
  if (levels == 0) return numbers;
  return spread(surface.topology, Tessellator(surface.topology, surface.scheme, levels), numbers);
}

Scalars surface_field(const FieldSurface& surface, SurfaceField field, int levels) {
  const bool mean = field == SurfaceField::MeanCurvature;
  if (levels == 0) {
    if (!is_curvature(field)) return vertex_field(surface, field);
    const LimitSurface limit(surface.topology, surface.scheme, surface.control);
    Curvature curvature = limit_curvature(limit, surface.topology);
    return mean ? std::move(curvature.mean) : std::move(curvature.gaussian);
  }
  if (is_curvature(field)) return curvature_field(surface, mean, levels);
  const Tessellator tessellator(surface.topology, surface.scheme, levels);
  if (field == SurfaceField::Sharpness) return sharpness_field(surface.topology, tessellator);
  return spread(surface.topology, tessellator, vertex_field(surface, field));
}

}  // namespace batten
