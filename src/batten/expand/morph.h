/// \file From one shape to another of the same connectivity, overall shape and detail at their own times (Lai and Cheng
/// 2006, key LC06, section 7; docs/mathematics.md, The mesh series).
#pragma once
#include <vector>

#include "batten/expand/mesh_series.h"

namespace batten {

/// What moves first on the way. The overall shape runs evenly; detail runs behind it or before it.
enum class MorphOrder {
  LowFirst,  ///< the overall shape, then the detail
  LowLast    ///< the detail, then the overall shape: as in the paper
};

/// How to morph. D is the partial sum of the mesh series' terms 0 .. m.
struct MorphOptions {
  int m = 1;
  int stages = 4;  ///< the differences are smoothed 1, 4, .., 4^(stages-1) times by D; 0: straight lines
  MorphOrder order = MorphOrder::LowFirst;
};

/// X(t) for t in [0, 1], with X(0) = from and X(1) = to, bit for bit. Detail of the difference `from - to` fades before
/// its overall shape (LowLast):
///   X(t) = to + (1 - t) D^p(t) (from - to)
/// where p(t) runs from 0 through 1, 4, 16, .. at even times to 4^(stages-1), linear in D^p between them. A mode with
/// the eigenvalue a of A is (1 - t) (1 - (1 - a)^(m+1))^p(t) of its way from its end; a translation, whose a is 1, runs
/// evenly, so centroids need no aligning. LowFirst is the same run backwards from `to`.
///
/// So X(t) = base + sum_i weight_i(t) target_i, with targets that do not depend on t: morph targets of an animation.
/// Build: 4^(stages-1) (m+1) applications of A. Memory: stages + 3 times the values. at(): O(values).
class Morph {
 public:
  /// from, to: V-by-k, k as you like. Throws Error: BadShape, NotFinite, BadArgument (m or stages out of range),
  /// Cancelled.
  Morph(const MeshSeries& series, ConstValuesRef from, ConstValuesRef to, const MorphOptions& options = {},
        const Progress& progress = {});

  /// Throws Error(BadArgument) for t outside [0, 1].
  Values at(double t) const;

  const Values& base() const { return options_.order == MorphOrder::LowLast ? to_ : from_; }
  const std::vector<Values>& targets() const { return targets_; }
  /// One a target; up to two are not 0. Throws Error(BadArgument) for t outside [0, 1].
  std::vector<double> weights(double t) const;
  /// Times between which weights are polynomials of degree 2: 0, 1/stages, .., 1.
  std::vector<double> knots() const;

 private:
  MorphOptions options_;
  Values from_;
  Values to_;
  std::vector<Values> targets_;
};

/// The paper's sequence (9): Q_0 = from, Q_(k+1) = to + rho D (Q_k - to).
struct MorphSequenceOptions {
  int m = 1;
  double rho = 0.8;  ///< in (0, 1]; the smaller, the faster
  int steps = 10;
  /// Weighted centroids (MeshSeries::weighted_centroid) are laid on each other first, and run evenly from the one to
  /// the other. Otherwise the centroid is as slow as rho, and for rho = 1 stays where it is.
  bool align = true;
};

/// Q_0 .. Q_steps; the last ones come near to `to` and do not reach it. A mode with the eigenvalue a is
/// (rho (1 - (1 - a)^(m+1)))^k of its way from it. Throws as Morph does.
std::vector<Values> morph_sequence(const MeshSeries& series, ConstValuesRef from, ConstValuesRef to,
                                   const MorphSequenceOptions& options = {}, const Progress& progress = {});

/// Throws Error(BadShape), naming the first difference, unless both have as many vertices and the same faces in the
/// same order; a face may start at another of its vertices.
void require_same_connectivity(const Mesh& a, const Mesh& b);

}  // namespace batten
