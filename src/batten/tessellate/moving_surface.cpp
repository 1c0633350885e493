#include "batten/tessellate/moving_surface.h"

#include <algorithm>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"
#include "batten/tessellate/surface_mesh.h"

namespace batten {
namespace {

/// The normals of surface_mesh(), which are at the vertices and, where sides differ, at the corners too.
Values normals_of(const Mesh& mesh, bool at_corners) {
  const Attribute* vertices = nullptr;
  const Attribute* corners = nullptr;
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name == "normal") (attribute.per_corner() ? corners : vertices) = &attribute;
  }
  if (vertices == nullptr) throw Error(ErrorCode::BadShape, "the surface has no normals");
  if (!at_corners) return vertices->values;
  Values normals(static_cast<Eigen::Index>(mesh.face_vertices.size()), 3);
  parallel_for(normals.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t c = begin; c < end; ++c) {
      normals.row(c) = corners != nullptr ? corners->values.row(corners->corner_rows[static_cast<std::size_t>(c)])
                                          : vertices->values.row(mesh.face_vertices[static_cast<std::size_t>(c)]);
    }
  });
  return normals;
}

bool has_corner_normals(const Mesh& mesh) {
  return std::any_of(mesh.attributes.begin(), mesh.attributes.end(),
                     [](const Attribute& attribute) { return attribute.name == "normal" && attribute.per_corner(); });
}

}  // namespace

MovingSurface moving_surface(const Topology& topology, const Scheme& scheme, const Mesh& control,
                             std::span<const Points> shapes, int levels, const Progress& progress) {
  const double share = 1.0 / static_cast<double>(shapes.size() + 1);
  const auto part = [&](std::size_t i) {
    return progress_within(progress, share * static_cast<double>(i), share * static_cast<double>(i + 1));
  };
  MovingSurface result;
  result.mesh = surface_mesh(topology, scheme, control, levels, part(0));
  Mesh bare = control;  // moving targets need no colours
  bare.attributes.clear();
  std::vector<Mesh> moved;
  bool at_corners = has_corner_normals(result.mesh);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    bare.points = shapes[i];
    moved.push_back(surface_mesh(topology, scheme, bare, levels, part(i + 1)));
    at_corners = at_corners || has_corner_normals(moved.back());
  }
  const Values normals = normals_of(result.mesh, at_corners);
  for (Mesh& mesh : moved) {
    result.targets.displacements.emplace_back(mesh.points - result.mesh.points);
    result.targets.normals.emplace_back(normals_of(mesh, at_corners) - normals);
    mesh = Mesh();
  }
  return result;
}

MovingSurface surface_through_time(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                   std::span<const Points> shapes, std::vector<double> times, int levels,
                                   const Progress& progress) {
  if (times.size() != shapes.size() + 1) {
    throw Error(ErrorCode::BadShape, "a surface through " + std::to_string(shapes.size() + 1) +
                                         " shapes needs as many times, not " + std::to_string(times.size()));
  }
  MovingSurface result = moving_surface(topology, scheme, control, shapes, levels, progress);
  const auto count = static_cast<Eigen::Index>(shapes.size());
  result.targets.weights = Values::Zero(count + 1, count);
  result.targets.weights.bottomRows(count).setIdentity();
  result.targets.times = std::move(times);
  return result;
}

}  // namespace batten
