/// \file Control points whose limit surface passes through given targets.
///
/// A is the V-by-V limit matrix (limit/limit_matrix.h): row i takes control points P (V-by-k) to the limit position of
/// vertex i. Interpolating targets Q means solving A P = Q. Corners are their targets; crease and boundary curves are
/// solved one by one (tridiagonal); then the smooth vertices. Connectivity stays as it is, except where a component's
/// system is singular and OnSingular::Alpha acts: then the result has that component refined once, because other
/// refinement rules act in the first step only. Either way the result is an ordinary Catmull-Clark or Loop surface.
///
/// Each component is held to the tolerance of its own bounding box, and is solved relative to its own centre where
/// that is needed, so that neither a small part of a large scene nor a place far from the origin costs accuracy.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "batten/interpolate/interpolation_report.h"
#include "batten/limit/limit_matrix.h"
#include "batten/refine/part_refinement.h"
#include "batten/refine/refinement.h"
#include "batten/solve/solver.h"

namespace batten {

class InterpolationSystem;
class InterpolationUpdates;

/// What is refined once where OnSingular::Alpha acts.
enum class RefinedExtent {
  Components,  ///< those on which alpha acts; all under BoundaryRule::None
  Everything
};

/// How to interpolate.
struct InterpolateOptions {
  SolveMethod method = SolveMethod::Auto;
  double tolerance = 1e-10;  ///< of each component's bounding-box diagonal
  double omega = 0.5;        ///< damping of SolveMethod::Jacobi
  int max_iterations = 20000;
  OnSingular on_singular = OnSingular::Alpha;
  LimitMasks masks = LimitMasks::Exact;
  RefinedExtent refined = RefinedExtent::Components;
};

/// Values at the vertices that the surface shall have there, and what messages call them.
struct Targets {
  std::string name;                                          ///< "points", or an attribute's name
  Eigen::Ref<const Values, 0, Eigen::OuterStride<>> values;  ///< V-by-k, row i for vertex i; not copied
};

/// A surface through the targets: control points, and the connectivity and scheme that make a surface of them.
struct Interpolant {
  Topology topology;  ///< the one given, or where OnSingular::Alpha acted, that with some components refined once
  Scheme scheme;      ///< the one given, and where the topology is refined, of the steps after the first
  Values control;     ///< one row a vertex of `topology`, in the unit of the targets; row i < V belongs to target i
  InterpolationReport report;
  std::shared_ptr<const PartRefinement> part = nullptr;  ///< where some, but not all, components were refined
};

/// Solves A P = Q for one connectivity and many Q: build once, solve per frame.
/// Cost: build O(H); solve about 30 passes over the mesh in cache for 1e-10, whatever its size (docs/decisions/002).
class Interpolator {
 public:
  /// Throws Error: BadArgument (an option out of its range), NotTriangles, Cancelled.
  Interpolator(const Topology& topology, const Scheme& scheme, const InterpolateOptions& options = {},
               const Progress& progress = {});
  ~Interpolator();
  Interpolator(Interpolator&&) noexcept;

  const Topology& topology() const;
  const Scheme& scheme() const;
  /// A.
  const LimitMatrix& limit_matrix() const;

  /// targets: V-by-k, row i for vertex i, finite. Safe to call from several threads.
  /// Where the tolerance is not reached, report.outcome is NotReached and the errors say what was; control points that
  /// diverged are not given, but the targets in their place.
  /// Throws Error: BadShape, NotFinite, SingularSystem (names the component and its lowest vertex), Cancelled.
  Interpolant solve(ConstValuesRef targets, const Progress& progress = {}) const;

  /// Several sets of values of one surface, each to the tolerance of its own size, all on the same connectivity: where
  /// alpha must act for one of them, it acts for all. One result a set. Throws what solve() does, and names the set.
  std::vector<Interpolant> solve_together(std::span<const Targets> sets, const Progress& progress = {}) const;

 private:
  friend class InterpolationUpdates;
  std::shared_ptr<const InterpolationSystem> system_;
};

}  // namespace batten
