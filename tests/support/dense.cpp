#include "support/dense.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace batten::test {

SymmetricModes symmetric_modes(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) { return matrix.eigenvalues(); }

double least_eigenvalue(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(a, b, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

Eigen::MatrixXd solve_dense(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.fullPivLu().solve(right);
}

Eigen::MatrixXd kernel(const Eigen::MatrixXd& matrix, double threshold) {
  Eigen::FullPivLU<Eigen::MatrixXd> factor(matrix);
  factor.setThreshold(threshold);
  return factor.kernel();
}

}  // namespace batten::test
