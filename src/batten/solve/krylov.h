/// \file Krylov solvers for several columns at once, in double: each column has its own coefficients.
#pragma once
#include <Eigen/Core>

#include "batten/solve/solver.h"

namespace batten {

/// Conjugate gradients on the symmetric system diag(scale) A x = diag(scale) b, preconditioned by its diagonal.
/// x: the start and the result. scale, diagonal (of diag(scale) A): one entry a row, positive. The stop rule looks at b
/// - A x. Where the matrix turns out indefinite, it stops with report.indefinite set. About 10 bytes-passes over the
/// columns an iteration; a column whose residual is zero stays as it is.
SolveReport conjugate_gradients(const LinearMap& a, const Eigen::VectorXd& scale, const Eigen::VectorXd& diagonal,
                                const Values& b, Values& x, const StopRule& stop);

/// Which unknowns have coefficients of their own.
enum class Coefficients {
  EachColumn,  ///< A does the same to every column
  Joint        ///< A takes all columns together for one vector of unknowns
};

/// Conjugate gradients on the symmetric system A x = b with any symmetric positive definite preconditioner M^-1, which
/// `precondition` applies. Residuals r are measured as sqrt(r^T M^-1 r), summed over the columns: about the error's
/// energy norm, so that a tolerance of t leaves a quadratic energy within t^2 of its least. Otherwise as above.
SolveReport conjugate_gradients(const LinearMap& a, const LinearMap& precondition, Coefficients coefficients,
                                const Values& b, Values& x, const StopRule& stop);

/// Stabilised bi-conjugate gradients (van der Vorst 1992) with the diagonal of A as right preconditioner: for rows that
/// are not symmetric, such as darts. Restarts where a column breaks down.
SolveReport bicgstab(const LinearMap& a, const Eigen::VectorXd& diagonal, const Values& b, Values& x,
                     const StopRule& stop);

}  // namespace batten
