#include "batten/fit/fit_beginning.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "batten/fit/first_mesh.h"
#include "batten/fit/fit_levels.h"
#include "batten/fit/loop_moves.h"
#include "batten/fit/mapped_sphere.h"
#include "batten/fit/start_sphere.h"

namespace batten {

namespace {

/// A Loop mesh of the shape of a finer one, by moves that each make the surface better.
Mesh moved_mesh(const PointCloud& cloud, double spacing, const FitOptions& options, FirstMeshOptions first,
                const Progress& progress) {
  constexpr Index kOfMoved = 2;
  constexpr Index kLeast = 50;
  LoopMoveOptions moves;
  moves.vertices = first.vertices;
  moves.spacing = spacing;
  moves.creases = options.creases == FitCreases::Auto;
  first.vertices = std::max(kLeast, kOfMoved * first.vertices);
  const Mesh fine = first_mesh(cloud, first, progress_within(progress, 0.0, 0.2)).mesh;
  return improve_loop_mesh(fine, cloud.points, moves, progress_within(progress, 0.2, 1.0));
}

}  // namespace

FitBeginning find_beginning(const PointCloud& cloud, double spacing, const FitOptions& options, LoopStart loop,
                            const Progress& progress) {
  if (options.initial) {
    Mesh mesh = *options.initial;
    if (options.creases == FitCreases::None) {
      mesh.creases.clear();
      mesh.corners.clear();
    }
    return {std::move(mesh), false};
  }
  if (options.start == FitStart::Sphere) {
    // Springs come from the plain sphere, as in the paper; a tolerance may need fewer control points than allowed.
    const bool maps = options.method == FitMethod::SquaredDistance && !(options.tolerance > 0.0);
    std::optional<Mesh> mapped;
    if (maps && loop == LoopStart::Moved)
      mapped = mapped_sphere(cloud, options.scheme.kind, options.vertices.value_or(kUsualFitVertices), progress);
    if (mapped) return {std::move(*mapped), true};
    return {start_sphere(cloud.points, options.scheme.kind), false};
  }
  constexpr Index kLeast = 50;
  constexpr Eigen::Index kOfFirstVertex = 4;
  // Loop surfaces come from finer ones by moves, which take about three milliseconds for a control point.
  constexpr Index kMostMoved = 2000;
  FirstMeshOptions first;
  first.faces = options.scheme.kind == SchemeKind::Loop ? FaceKind::Triangles : FaceKind::Quads;
  const Index vertices = options.vertices.value_or(kUsualFitVertices);
  // A mesh with a vertex for every few points would take their unevenness for shape: refine later.
  const bool dense = cloud.points.rows() >= kOfFirstVertex * static_cast<Eigen::Index>(vertices);
  first.vertices = std::max(kLeast, dense ? vertices : vertices / 4);
  first.genus = options.genus;
  first.bridge = options.bridge;
  first.creases = options.creases == FitCreases::Auto ? CreaseSearch::Auto : CreaseSearch::None;
  if (options.scheme.kind == SchemeKind::Loop && loop == LoopStart::Moved && dense && vertices <= kMostMoved) {
    first.vertices = vertices;
    return {moved_mesh(cloud, spacing, options, first, progress), true};
  }
  return {first_mesh(cloud, first, progress).mesh, false};
}

}  // namespace batten
