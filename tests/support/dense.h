/// \file Dense linear algebra that tests compare with. Compiled once: these templates take seconds in each source that
/// uses them.
#pragma once
#include <Eigen/Core>

namespace batten::test {

/// Eigenvalues, the least first, and an orthonormal eigenvector each, in columns.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricModes symmetric_modes(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a matrix without symmetry.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// The least x for which a - x b is singular, of symmetric matrices, b positive definite.
double least_eigenvalue(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The x with matrix x = right, by elimination with full pivoting.
Eigen::MatrixXd solve_dense(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Columns that span the x with matrix x = 0; pivots below `threshold` of the largest count as none.
Eigen::MatrixXd kernel(const Eigen::MatrixXd& matrix, double threshold);

}  // namespace batten::test
