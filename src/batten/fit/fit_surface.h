/// \file From points to a small, editable subdivision surface.
#pragma once
#include <optional>

#include "batten/fit/fit_report.h"
#include "batten/fit/point_cloud.h"
#include "batten/fit/surface_film.h"
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// What a fit starts from where no control mesh is given.
enum class FitStart {
  Auto,  ///< a mesh of the right genus over the points (fit/first_mesh.h)
  /// the control mesh of a sphere, laid over the points where they give one closed surface without handles
  /// (fit/mapped_sphere.h), otherwise, for springs, and with a tolerance an ellipsoid around them (fit/start_sphere.h)
  Sphere
};

/// How the surface is moved.
enum class FitMethod {
  SquaredDistance,  ///< by steps that make squared distances and fairness least (fit/surface_fitter.h)
  Dynamic           ///< by springs that draw an elastic surface (fit/dynamic_fit.h), as in the paper
};

/// Where the surface is sharp.
enum class FitCreases {
  Auto,  ///< along the sharp edges that the points show; those of the tags where a mesh is given to start from
  None,  ///< nowhere: a given mesh loses its tags
  Keep   ///< where a given mesh has tags
};

/// Options of fit_surface(). Lengths are in the unit of the points.
struct FitOptions {
  Scheme scheme;  ///< Catmull-Clark or Loop
  FitMethod method = FitMethod::SquaredDistance;
  FitStart start = FitStart::Auto;
  /// The control mesh to start from instead, with its tags; its scheme must fit. Vertex i of it is vertex i of the
  /// result.
  std::optional<Mesh> initial;
  FitCreases creases = FitCreases::Auto;
  /// At most so many control points: the mesh is refined as a whole while it has no more. Without: 400, and an
  /// initial mesh is not refined.
  std::optional<Index> vertices;
  double tolerance = 0.0;        ///< stops when no point is farther away than this
  std::optional<Index> genus;    ///< demanded of the first mesh
  std::optional<double> bridge;  ///< gaps up to this width are closed, wider ones become boundaries (FirstMeshOptions)
  int rounds = 30;               ///< at most so many for each number of control points
  FrameWatcher watch;            ///< is shown the start, the surface after each round, and the result
};

/// A control mesh and how well its surface fits.
struct FitResult {
  Mesh mesh;  ///< with its scheme stated
  Topology topology;
  Scheme scheme;
  Scalars distances;  ///< from each point to the surface
  FitReport report;
};

/// Fits a surface to the points. Attach each point to its nearest place on the surface, move the control points so that
/// a weighted sum of squared distances and of fairness is least, and again (fit/surface_fitter.h); fairness falls with
/// the distances; when nothing is gained, refine. The points' normals are estimated where there are none. The result
/// depends on the input alone. When the callback asks to stop after the first round, the surface of the last whole
/// round is returned.
/// Throws Error: BadShape, NotFinite, BadArgument (no points, all at one place or on a line, or in a plane with a
/// sphere to start from; a mesh to start from that lies far from the points; options out of range), NotTriangles,
/// Cancelled (before the first round), and what first_mesh() throws.
FitResult fit_surface(const PointCloud& cloud, const FitOptions& options = {}, const Progress& progress = {});

}  // namespace batten
