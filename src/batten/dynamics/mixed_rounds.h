/// \file Fewer rounds of a fixed-point iteration by mixing the last ones.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "batten/types.h"

namespace batten {

/// Anderson's mixing (after Walker and Ni 2011, key WN11) of P = G(P): the next point is the combination of the last
/// G(P) whose steps G(P) - P nearly cancel. It starts again where a step has grown.
class MixedRounds {
 public:
  explicit MixedRounds(int depth) : depth_(depth) {}

  /// before: P; after: G(P). Returns the next P.
  Points next(const Points& before, const Points& after);

 private:
  int depth_;
  Points last_after_;
  Points last_step_;
  std::vector<Points> after_changes_;
  std::vector<Points> step_changes_;
};

}  // namespace batten
