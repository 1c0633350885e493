/// \file What acts on an elastic surface: the interface that all forces share.
///
/// A force on the surface is a force on the control points: f acting on a place whose row of weights is J acts as J^T
/// f. Springs from places to targets are taken implicitly: their stiffness J^T k J becomes part of a step's system, so
/// that steps stay stable however stiff they are. Other forces are taken at the end of the step, as far as its position
/// is known: a step asks for them again after each solve, until the position stands still.
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "batten/dynamics/elastic_surface.h"
#include "batten/patch/surface_place.h"
#include "batten/types.h"

namespace batten {

/// Places of a surface as rows of weights of its control points, and the transposed matrix.
struct PlaceRows {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Matrix rows;        ///< P-by-V
  Matrix transposed;  ///< V-by-P
};

/// The rows of the base's points where the base is a first refinement (SurfacePatches::has_first_step()).
PlaceRows first_step_rows(const SurfacePatches& patches);

/// The rows of the points at places (surface/surface_weights.h). Throws Error(IndexOutOfRange, BadArgument) for places
/// that do not exist.
PlaceRows place_rows(const SurfacePatches& patches, std::span<const SurfacePlace> places);

/// The same place on `body.refined()`.
SurfacePlace place_on_refined(const SurfacePatches& patches, const SurfacePlace& place);

/// How a step asks for forces. All matrices are V-by-3.
struct ForceInput {
  double time = 0.0;         ///< at the end of the step
  double step = 0.0;         ///< its seconds; 0 where an equilibrium is looked for: nothing moves
  const Points& start;       ///< control points at the begin of the step
  const Points& positions;   ///< at its end, as far as known
  const Points& velocities;  ///< likewise; 0 where an equilibrium is looked for
};

/// Springs from places of the surface to targets in space: force k (target - point) each.
struct PlaceSprings {
  std::shared_ptr<const PlaceRows> rows;
  Scalars stiffness;  ///< k of each place, N/m, 0 or more
  Points targets;     ///< P-by-3
  /// True where rows and stiffness are the same in every call with the same step: a step factors them once, together
  /// with the body.
  bool lasting = false;
  /// Empty, or P-by-3: a spring with a unit vector n pulls along it alone, with the force k n n^T (target - point), one
  /// with 0 in all directions. Not for lasting springs.
  Points directions = {};
};

/// The forces of springs that are stretched so far, target - point: in place, P-by-3.
void turn_into_forces(const PlaceSprings& springs, Values& stretch);

/// Where forces add up.
struct ForceSum {
  /// A stiffness that acts along one direction of all control points together: k g g^T, as of a volume that is held.
  struct Along {
    double stiffness;  ///< k, 0 or more
    Points direction;  ///< g, V-by-3
  };

  Points force;                       ///< on the control points, without that of `springs`, V-by-3
  std::vector<PlaceSprings> springs;  ///< each adds J^T k (targets - J P)
  std::vector<Along> along;           ///< how `force` changes with P, where that is stiff: -k g g^T
  double energy = 0.0;                ///< of the forces that have one, of springs too
};

/// A force has no state: what it gives depends on the input alone, with the same bits, so that a run can be taken up
/// again. Const calls from one thread at a time.
class Force {
 public:
  virtual ~Force() = default;
  /// For messages, such as "pressure" or "spring 3".
  virtual std::string name() const = 0;
  /// Adds itself to `sum`. Throws Error(NotFinite), Error(BadArgument) where it cannot say.
  virtual void add(const ForceInput& input, ForceSum& sum) const = 0;
  /// The same force on body.refined(), which is given: places move along with it.
  virtual std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const = 0;
};

}  // namespace batten
