/// \file Control points whose limit surface passes through given targets.
///
/// A is the V-by-V limit matrix (limit/limit_matrix.h): row i takes control points P (V-by-k) to the limit position of
/// vertex i. Interpolating targets Q means solving A P = Q. Connectivity does not change: the result is an ordinary
/// control mesh. Corners are their targets; crease and boundary curves are solved one by one (tridiagonal); then the
/// smooth vertices.
#pragma once
#include <memory>
#include <vector>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "batten/solve/solver.h"

namespace batten {

/// What to do with a component on which arbitrary targets have no control points (a cube: every vertex of valence 3 and
/// the edges two-colourable), when the targets are not among those that have (MATH 2.2).
enum class OnSingular {
  Refuse,        ///< Error(SingularSystem)
  LeastSquares,  ///< the control points that miss all targets of the component by the same least distance
  Alpha          ///< Lai's alpha = 1/2 on the component: exact, see ordinary_surface()
};

/// How to interpolate.
struct InterpolateOptions {
  SolveMethod method = SolveMethod::Auto;
  double tolerance = 1e-10;  ///< of the targets' bounding-box diagonal
  double omega = 0.5;        ///< damping of SolveMethod::Jacobi
  int max_iterations = 20000;
  OnSingular on_singular = OnSingular::Alpha;
  LimitMasks masks = LimitMasks::Exact;
};

/// The control points and what was achieved.
struct Interpolant {
  Values control;          ///< P, V-by-k, in the unit of the targets
  SolveReport report;      ///< of the smooth vertices
  double max_error = 0.0;  ///< max_i |A P - Q|_i, measured at the end in double, same unit
  double rms_error = 0.0;
  std::vector<RowError> worst;       ///< up to ten, the worst first
  double max_movement = 0.0;         ///< max_i |P - Q|_i
  Index singular_components = 0;     ///< components without a surface for arbitrary targets
  std::vector<double> vertex_alpha;  ///< empty, or the alpha used at each vertex: then see ordinary_surface()
};

/// Solves A P = Q for one connectivity and many Q: build once, solve per frame.
/// Cost: build O(H); solve about 30 passes over the mesh in cache for 1e-10, whatever its size (docs/decisions/002).
class Interpolator {
 public:
  /// Throws Error(NotTriangles, BadArgument, Cancelled).
  Interpolator(const Topology& topology, const Scheme& scheme, const InterpolateOptions& options = {},
               const Progress& progress = {});
  ~Interpolator();
  Interpolator(Interpolator&&) noexcept;

  const LimitMatrix& limit_matrix() const;

  /// targets: V-by-k, row i for vertex i, finite. Safe to call from several threads.
  /// Where the tolerance is not reached, report.converged is false and the errors say what was; control points that
  /// diverged are not given, but the targets in their place.
  /// Throws Error: BadShape, NotFinite, SingularSystem, Cancelled.
  Interpolant solve(ConstValuesRef targets, const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The interpolant as an ordinary Catmull-Clark or Loop surface: itself, or refined once where alpha acted.
/// Rows 0 .. V-1 are the even vertices; their limit positions are the targets.
RefinedSurface ordinary_surface(const Topology& topology, const Scheme& scheme, const Interpolant& interpolant,
                                const Progress& progress = {});

/// Once, from a mesh to the mesh of its interpolating surface's control points.
Mesh interpolate(const Mesh& mesh, const InterpolateOptions& options = {}, const Progress& progress = {});

}  // namespace batten
