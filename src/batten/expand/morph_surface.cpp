#include "batten/expand/morph_surface.h"

#include <algorithm>
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

std::vector<double> key_times(const Morph& morph, int frames) {
  std::vector<double> times = morph.knots();
  for (int i = 0; i <= frames; ++i) times.push_back(static_cast<double>(i) / frames);
  std::sort(times.begin(), times.end());
  constexpr double kSame = 1e-9;
  times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return b - a < kSame; }), times.end());
  return times;
}

}  // namespace

MorphSurface morph_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Morph& morph,
                           int levels, int frames, double seconds, const Progress& progress) {
  if (frames < 1 || !(seconds > 0.0)) {
    throw Error(ErrorCode::BadArgument, "an animation needs a frame and a duration above 0, not " +
                                            std::to_string(frames) + " and " + std::to_string(seconds) + " seconds");
  }
  const std::size_t count = morph.targets().size();
  const double share = 1.0 / static_cast<double>(count + 1);
  Mesh base = control;
  base.points = morph.base();
  MorphSurface result;
  result.mesh = surface_mesh(topology, scheme, base, levels, progress_within(progress, 0.0, share));
  Mesh bare = control;  // moving targets need no colours
  bare.attributes.clear();
  const std::vector<double> knots = morph.knots();
  std::vector<Mesh> moved;
  bool at_corners = has_corner_normals(result.mesh);
  std::vector<double> weights;
  for (std::size_t i = 0; i < count; ++i) {
    // Only this target has a weight at its knot. The last one fades to zero and is evaluated on the way.
    double weight = 0.0;
    for (const double knot : knots) weight = std::max(weight, morph.weights(knot)[i]);
    if (weight == 0.0) weight = 0.25 / static_cast<double>(count);
    bare.points = morph.base() + weight * morph.targets()[i];
    moved.push_back(surface_mesh(
        topology, scheme, bare, levels,
        progress_within(progress, share * static_cast<double>(i + 1), share * static_cast<double>(i + 2))));
    at_corners = at_corners || has_corner_normals(moved.back());
    weights.push_back(weight);
  }
  const Values normals = normals_of(result.mesh, at_corners);
  for (std::size_t i = 0; i < count; ++i) {
    result.targets.displacements.emplace_back((moved[i].points - result.mesh.points) / weights[i]);
    result.targets.normals.emplace_back((normals_of(moved[i], at_corners) - normals) / weights[i]);
    moved[i] = Mesh();
  }
  const std::vector<double> times = key_times(morph, frames);
  result.targets.weights.resize(static_cast<Eigen::Index>(times.size()), static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::vector<double> row = morph.weights(times[k]);
    for (std::size_t i = 0; i < count; ++i) {
      result.targets.weights(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = row[i];
    }
    result.targets.times.push_back(seconds * times[k]);
  }
  return result;
}

}  // namespace batten
