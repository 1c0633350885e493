/// \file What an interpolation achieved.
#pragma once
#include <string>
#include <vector>

#include "batten/solve/solver.h"

namespace batten {

/// What to do with a component on which arbitrary targets have no control points (a cube: every vertex of valence 3 and
/// the edges two-colourable), when the targets are not among those that have.
enum class OnSingular {
  Refuse,        ///< Error(SingularSystem)
  LeastSquares,  ///< the control points with the least sum of squared distances to the component's targets
  Alpha          ///< Lai and Cheng's alpha on the component: exact, on the connectivity refined once
};

/// How the surface met its targets.
enum class Outcome {
  Reached,       ///< each target within the tolerance
  Rounding,      ///< not within the tolerance, but as near as double coordinates of this size come
  LeastSquares,  ///< singular components miss their targets by as little as can be; all others as above
  NotReached     ///< none of these: the errors say what was reached
};

/// How a component was found to have a singular system.
enum class SingularReason {
  TwoColourable,  ///< closed, all vertices smooth and of valence 3, the edges two-colourable: recognised beforehand
  ValenceTwo,     ///< no method solved it, and it has a smooth vertex of valence 2
  Unsolvable      ///< no method solved it
};

/// What was done about it.
enum class SingularTreatment {
  None,          ///< nothing: the targets are among those that have a surface
  LeastSquares,  ///< see OnSingular
  Alpha          ///< see OnSingular
};

/// A component of the mesh with a singular system.
struct SingularReport {
  Index vertex = -1;  ///< the lowest of the component
  Index vertex_count = 0;
  SingularReason reason = SingularReason::TwoColourable;
  SingularTreatment treatment = SingularTreatment::None;
  double alpha = 0.0;  ///< what acted, where the treatment is Alpha: 1/2, or 1 where it was not recognised beforehand
};

/// What was achieved for one set of values. Errors are measured at the end, in double, on the surface of the control
/// points that are handed out.
struct InterpolationReport {
  std::string name;   ///< of the values, "points" for example
  SolveReport solve;  ///< how the equations were solved
  Outcome outcome = Outcome::NotReached;
  double diagonal = 0.0;   ///< of the targets' bounding box, in the unit of the targets, as are all errors
  double max_error = 0.0;  ///< max_i |limit position of vertex i - target i|
  double rms_error = 0.0;
  std::vector<RowError> worst;           ///< up to ten, the worst first
  double max_movement = 0.0;             ///< max_i |control point i - target i|
  std::vector<SingularReport> singular;  ///< components without a surface for arbitrary targets, by their lowest vertex

  bool converged() const { return outcome != Outcome::NotReached; }
};

}  // namespace batten
