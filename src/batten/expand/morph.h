/// \file Morphs one shape into another of the same connectivity, with the overall shape and the detail at different
/// times (Lai and Cheng 2006, key LC06, section 7; docs/mathematics.md, The mesh series).
#pragma once
#include <vector>

#include "batten/expand/mesh_series.h"

namespace batten {

/// What moves first. The overall shape moves evenly; the detail moves before or after it.
enum class MorphOrder {
  LowFirst,  ///< the overall shape moves first, then the detail
  LowLast    ///< the detail moves first, then the overall shape, as in the paper
};

/// Options of Morph. D is the partial sum of the mesh series' terms 0 .. m.
struct MorphOptions {
  int m = 1;
  int stages = 4;  ///< D smooths the difference 1, 4, .., 4^(stages-1) times; 0: straight lines
  MorphOrder order = MorphOrder::LowFirst;
};

/// X(t) for t in [0, 1] with X(0) = from and X(1) = to, bit for bit. With LowLast, the detail of the difference `from -
/// to` fades before its overall shape:
///   X(t) = to + (1 - t) D^p(t) (from - to)
/// p(t) takes the values 0, 1, 4, 16, .., 4^(stages-1) at even times, and D^p is linear between them. A mode of
/// eigenvalue a of A has the factor (1 - t) (1 - (1 - a)^(m+1))^p(t). A translation, whose a is 1, moves evenly, so
/// centroids need not be aligned. LowFirst is the same motion backwards from `to`.
///
/// X(t) = base + sum_i weight_i(t) target_i with targets that do not depend on t, which are the morph targets of an
/// animation. Build: 4^(stages-1) (m+1) applications of A. Memory: stages + 3 times the values. at(): O(values).
class Morph {
 public:
  /// from, to: V-by-k for any k. Throws Error: BadShape, NotFinite, BadArgument (m or stages out of range), Cancelled.
  Morph(const MeshSeries& series, ConstValuesRef from, ConstValuesRef to, const MorphOptions& options = {},
        const Progress& progress = {});

  /// Throws Error(BadArgument) for t outside [0, 1].
  Values at(double t) const;

  const Values& base() const { return options_.order == MorphOrder::LowLast ? to_ : from_; }
  const std::vector<Values>& targets() const { return targets_; }
  /// One weight for each target; at most two are not 0. Throws Error(BadArgument) for t outside [0, 1].
  std::vector<double> weights(double t) const;
  /// The times 0, 1/stages, .., 1, between which weights are polynomials of degree 2.
  std::vector<double> knots() const;

 private:
  MorphOptions options_;
  Values from_;
  Values to_;
  std::vector<Values> targets_;
};

/// Options of the paper's sequence (9): Q_0 = from, Q_(k+1) = to + rho D (Q_k - to).
struct MorphSequenceOptions {
  int m = 1;
  double rho = 0.8;  ///< in (0, 1]; smaller is faster
  int steps = 10;
  /// Aligns the weighted centroids (MeshSeries::weighted_centroid) first and moves them evenly from one to the other.
  /// Otherwise the centroid converges by the factor rho for each step, and not at all for rho = 1.
  bool align = true;
};

/// Q_0 .. Q_steps. The last ones approach `to` and do not reach it: a mode of eigenvalue a has the factor (rho (1 - (1
/// - a)^(m+1)))^k. Throws as Morph does.
std::vector<Values> morph_sequence(const MeshSeries& series, ConstValuesRef from, ConstValuesRef to,
                                   const MorphSequenceOptions& options = {}, const Progress& progress = {});

}  // namespace batten
