/// \file An elastic surface in time: steps, and the equilibrium they lead to.
#pragma once
#include <memory>
#include <vector>

#include "batten/dynamics/elastic_surface.h"
#include "batten/dynamics/force.h"
#include "batten/dynamics/supports.h"
#include "batten/progress.h"

namespace batten {

/// How a step goes from one time to the next (docs/mathematics.md has the formulas). All are stable for any step.
enum class TimeScheme {
  BackwardEuler,  ///< first order; takes energy out of fast motion
  SecondOrder,    ///< average acceleration: second order, keeps the energy of linear motion
  MassFree,       ///< damping and stiffness alone: creeps towards equilibrium, velocities are not kept
  Paper,          ///< the paper's (31): first order
  PaperMassFree   ///< the paper's (32)
};

/// How a step's linear system is solved.
enum class MotionSolver {
  Auto,  ///< Direct up to 400,000 control points
  /// Sparse Cholesky, factored once; conjugate gradients for what changes from step to step. From 150,000 control
  /// points on without pins the factor is in single precision, and conjugate gradients take its errors out.
  Direct,
  Iterative  ///< conjugate gradients with an incomplete factor
};

/// How a body is moved through time.
struct MotionOptions {
  TimeScheme scheme = TimeScheme::BackwardEuler;
  double step = 1.0 / 60.0;  ///< seconds
  /// A step of a nonlinear body or force solves until (two rounds do for motion; more follow it more closely) no
  /// control point moves farther than `tolerance` of the diagonal between two solves, but at most so often.
  int rounds = 2;
  double tolerance = 1e-6;
  MotionSolver solver = MotionSolver::Auto;
  double solver_tolerance = 1e-8;  ///< of conjugate gradients, relative
};

/// What a step has done.
struct StepReport {
  int rounds = 0;              ///< solves
  int solver_iterations = 0;   ///< of conjugate gradients, in all of them
  double change = 0.0;         ///< the farthest that a control point moved in the last round, in the unit of the points
  bool settled = false;        ///< that is within the tolerance
  double support_error = 0.0;  ///< how far the supports are from where they are held, in the unit of the points
  double time_error = 0.0;     ///< of advance(): the estimated error of its last step, in the unit of the points
};

/// How a body stands at a time.
struct MotionMeasure {
  double kinetic_energy = 0.0;
  double elastic_energy = 0.0;
  double force_energy = 0.0;    ///< of the forces that have one
  double residual_force = 0.0;  ///< the greatest of the forces on control points that nothing balances
};

/// What an equilibrium is taken for.
struct EquilibriumOptions {
  double tolerance = 1e-10;  ///< the greatest change of a round, relative to the diagonal
  int rounds = 2000;
};
/// How a search for equilibrium ended. Changes and forces are those of its last round.
struct EquilibriumReport {
  int rounds = 0;
  int solver_iterations = 0;
  double change = 0.0;
  double residual_force = 0.0;  ///< the greatest of the forces on control points that nothing balances
  bool converged = false;
};

/// Keeps the factor of the step's system while step, material and supports stay. One thread at a time.
class ElasticMotion {
 public:
  /// Throws Error(BadArgument) for options out of range and where no mass, damping or stiffness determines how a
  /// control point moves, Error(IndexOutOfRange) for supports that do not exist, Error(Cancelled).
  ElasticMotion(const ElasticSurface& surface, std::vector<std::shared_ptr<const Force>> forces = {},
                Supports supports = {}, const MotionOptions& options = {});
  ~ElasticMotion();
  ElasticMotion(ElasticMotion&&) noexcept;
  ElasticMotion& operator=(ElasticMotion&&) noexcept;

  const ElasticSurface& surface() const;
  const std::vector<std::shared_ptr<const Force>>& forces() const;
  const Supports& supports() const;
  const MotionOptions& options() const;

  /// Moves `state` on by one step. Throws Error(BadShape), Error(NotFinite) naming the force, or the step where the
  /// motion has run away, Error(Cancelled); then the state is the one before.
  StepReport step(ElasticState& state, const Progress& progress = {});

  /// Measures energies and what is left of the forces. Throws as step().
  MotionMeasure measure(const ElasticState& state) const;

  /// Moves on by `seconds` in steps of its own choice, so that the error of each is about `tolerance` of the diagonal;
  /// estimated from a step of twice the length; steps are halvings of options().step. Returns the last step's report.
  /// Throws as step(); then the state is that after the last whole step.
  StepReport advance(ElasticState& state, double seconds, double tolerance = 1e-4, const Progress& progress = {});

  /// The static solution: positions at which all forces balance at state.time, from those of the state on; velocities
  /// become 0. Throws Error(SingularSystem) where nothing holds a body without mass, Error(NotFinite, Cancelled).
  EquilibriumReport find_equilibrium(ElasticState& state, const EquilibriumOptions& options = {},
                                     const Progress& progress = {});

  /// The motion of the body on its control mesh refined once, for the body as `state` has it; refined_state() refines
  /// the state itself.
  ElasticMotion refined(const ElasticState& state, const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
