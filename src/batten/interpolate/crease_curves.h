/// \file Crease and boundary curves: interpolated one by one before the surface between them.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// A run of Curve rows, each the neighbour of the next. Open: `before` and `after` hold their values.
struct CurveSystem {
  Buffer<Index> vertices;
  bool closed = false;
  Index before = -1;
  Index after = -1;
};

struct CurveSystems {
  std::vector<CurveSystem> curves;  ///< those that depend on no other unknown
  Buffer<Index> coupled;            ///< Curve rows on curves that end in a Special row: solved with the surface
};

/// O(V).
CurveSystems find_crease_curves(const LimitMatrix& matrix);

/// Solves (a + 4 x + b)/6 = target along a curve, in place: x holds the targets at first, and the ends' values.
/// O(length), by elimination; the system is diagonally dominant, so no pivoting is needed.
void solve_curve(const CurveSystem& curve, ValuesRef x);

}  // namespace batten
