#include "batten/expand/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/vertex_normals.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"
#include "batten/tessellate/grid_fields.h"
#include "batten/tessellate/surface_mesh.h"

namespace batten {
namespace {

void drop_attribute(Mesh& mesh, const std::string& name) {
  auto& all = mesh.attributes;
  all.erase(std::remove_if(all.begin(), all.end(), [&](const Attribute& a) { return a.name == name; }), all.end());
}

/// The normals of the faces around each vertex, weighted by area.
Points flat_normals(const Mesh& mesh) {
  Points normals = Points::Zero(mesh.vertex_count(), 3);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Eigen::RowVector3d normal = face_normal(mesh, f).transpose();
    for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c)
      normals.row(mesh.face_vertices[c]) += normal;
  }
  return normals;
}

/// The points in diagonals of the bounding box from its middle, x along its longest side and z along its shortest.
Points places_of(ConstValuesRef points) {
  Points places(points.rows(), 3);
  if (points.rows() == 0) return places;
  const Eigen::RowVector3d lowest = points.colwise().minCoeff();
  const Eigen::RowVector3d highest = points.colwise().maxCoeff();
  const Eigen::RowVector3d centre = 0.5 * lowest + 0.5 * highest;
  const Eigen::RowVector3d sides = highest - lowest;
  std::array<int, 3> axes{0, 1, 2};
  // Sides that differ only by rounding keep their order, so that a model looks the same in another unit.
  constexpr double kLonger = 1.0 + 1e-9;
  for (const int k : {0, 1, 0}) {
    if (sides[axes[k + 1]] > kLonger * sides[axes[k]]) std::swap(axes[k], axes[k + 1]);
  }
  const double diagonal = sides.norm() > 0.0 ? sides.norm() : 1.0;
  for (int k = 0; k < 3; ++k) places.col(k) = (points.col(axes[k]).array() - centre[axes[k]]) / diagonal;
  return places;
}

Values colors_of(const Texture& texture, const Points& places, const Values& noise) {
  Values colors(places.rows(), 3);
  const double frequency = texture.noises.empty() ? 1.0 : texture.noises.front().frequency;
  parallel_for(places.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const Eigen::Vector3d place = frequency * places.row(v).transpose();
      colors.row(v) = texture.ramp.color(texture.pattern(place, noise.data() + v * noise.cols()));
    }
  });
  return colors;
}

/// The noise at the vertices of surface_mesh, whose order is the Tessellator's; SurfaceNoise has Refinement's.
Values noise_at(const SurfaceNoise& noises, const Topology& topology, const Scheme& scheme, const Points& places,
                std::span<const NoiseOptions> options, const Progress& progress) {
  if (noises.levels() == 0) return noises.values(places, options, progress);
  const Tessellator tessellator(topology, scheme, noises.levels());
  const bool refined = tessellator.base().half_edge_count() != topology.half_edge_count();
  std::vector<Topology> levels;
  for (int level = refined ? 1 : 0; level <= noises.levels(); ++level) levels.push_back(noises.level(level));
  const Buffer<Index> order = refinement_order(tessellator, levels);
  Points ordered(places.rows(), 3);
  for (Index v = 0; v < places.rows(); ++v) ordered.row(order[v]) = places.row(v);
  return noises.values(ordered, options, progress)(order, Eigen::all);
}

}  // namespace

Mesh textured_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Texture& texture,
                      const TextureOptions& options, const Progress& progress) {
  constexpr double kSurface = 0.4;  // of the time
  constexpr double kLevels = 0.5;
  if (!texture.pattern) throw Error(ErrorCode::BadArgument, "the texture has no pattern");
  if (!std::isfinite(options.displacement)) {
    throw Error(ErrorCode::BadArgument, "the displacement must be finite, not " + std::to_string(options.displacement));
  }
  const int levels = options.flat ? 0 : options.levels;
  Mesh mesh = options.flat ? control
                           : surface_mesh(topology, scheme, control, levels, progress_within(progress, 0.0, kSurface));
  const Points places = places_of(mesh.points);
  const SurfaceNoise noises(topology, scheme, levels, progress_within(progress, kSurface, kLevels));
  const Values noise =
      noise_at(noises, topology, scheme, places, texture.noises, progress_within(progress, kLevels, 1.0));
  drop_attribute(mesh, "color");
  mesh.attributes.push_back({"color", colors_of(texture, places, noise), {}});
  if (options.displacement != 0.0 && noise.cols() > 0) {
    const Points normals = options.flat ? flat_normals(mesh) : stated_normals(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double length = normals.row(v).norm();
      if (length > 0.0) mesh.points.row(v) += options.displacement * noise(v, 0) / length * normals.row(v);
    }
    drop_attribute(mesh, "normal");
  }
  return mesh;
}

Texture plain_texture(const NoiseOptions& noise, const ColorRamp& ramp) {
  return {{noise}, [](const Eigen::Vector3d& /*place*/, const double* n) { return 0.5 + 0.25 * n[0]; }, ramp};
}

}  // namespace batten
