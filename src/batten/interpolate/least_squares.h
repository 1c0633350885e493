/// \file The nearest miss of a component whose system is singular.
#pragma once
#include "batten/limit/limit_matrix.h"
#include "batten/solve/solver.h"

namespace batten {

/// The control points nearest to `x` among those with the least sum of squared errors on the rows of the unknown
/// vertices, by conjugate gradients on the normal equations (Eigen's LeastSquaresConjugateGradient). unknown: one flag
/// a vertex; the others hold their values. x: the start and the result. The report has converged where the gradient A^T
/// (b - A x) is within stop.tolerance. Serial; about 2 products with A an iteration.
SolveReport solve_least_squares(const LimitMatrix& matrix, const Buffer<std::uint8_t>& unknown, ConstValuesRef targets,
                                Values& x, const StopRule& stop);

}  // namespace batten
