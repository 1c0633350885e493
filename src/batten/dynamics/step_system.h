/// \file The linear system of a step, and how it is solved.
///
/// With weights a, b of mass and damping, S = a M + b D + K + the stiffness of lasting springs; S P = right hand side,
/// with control points that are fixed and places that are pinned: J P = d. Pins are held by multipliers: with a
/// stiffness r of the pins in the factor, S + J^T r J, each solve leaves of their error a share of about 1/r, whatever
/// the rank of J; two or three solves hold them to rounding.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/held_points.h"
#include "batten/solve/cholesky_factor.h"
#include "batten/solve/incomplete_factor.h"
#include "batten/solve/solver.h"

namespace batten {

/// What a step's system is made of.
struct StepWeights {
  double mass = 0.0;
  double damping = 0.0;
};

/// What a solve has found.
struct StepSolve {
  int iterations = 0;          ///< of conjugate gradients
  double support_error = 0.0;  ///< of the pins
};

/// Const and safe from several threads.
class StepSystem {
 public:
  /// lasting: springs whose stiffness is part of S. Throws Error(SingularSystem) where S is found singular.
  StepSystem(const ElasticSurface& surface, const StepWeights& weights, const std::vector<PlaceSprings>& lasting,
             const HeldPoints& held, MotionSolver solver, double tolerance);

  /// What changes from round to round.
  struct Round {
    const Points& right;       ///< without the forces of `sum`'s springs
    const ForceSum& sum;       ///< its springs, and its stiffness along directions at `positions`
    const HeldPlaces& places;  ///< of the supports
    Points& multipliers;       ///< of the pins, from round to round of a step; zeros at first
    const Progress& progress = {};
  };
  /// positions: where the forces were asked for, and the result.
  StepSolve solve(const Round& round, Points& positions) const;

 private:
  struct Extra;
  bool all_free() const;  ///< no control point is fixed
  void find_matrix(const StepWeights& weights, const std::vector<PlaceSprings>& lasting);
  void multiply_system(const Values& x, Values& product) const;
  void factorise(const ElasticSurface::Matrix& pattern, const CholeskyFactor::EntryValue& value);
  Values residual(const Round& round, const Extra& extra, const Points& start, const Points& positions) const;
  int correct(const Extra& extra, const Values& right, const Progress& progress, Points& positions) const;
  void precondition(const Values& b, Values& x) const;

  ElasticSurface surface_;
  std::optional<double> mass_weight_;  ///< S is K and this times M, or
  ElasticSurface::Matrix matrix_;      ///< S
  ElasticSurface::Matrix with_pins_;   ///< S + J^T r J, or empty without pins
  const HeldPoints& held_;
  double pin_stiffness_ = 0.0;  ///< r
  double diagonal_;
  double tolerance_;                      ///< of conjugate gradients, relative to unit_
  double unit_;                           ///< of their norm: that of the diagonal
  std::optional<CholeskyFactor> factor_;  ///< of the free rows
  std::optional<IncompleteFactor> incomplete_;
};

}  // namespace batten
