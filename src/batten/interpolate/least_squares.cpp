#include "batten/interpolate/least_squares.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <vector>

namespace batten {

SolveReport solve_least_squares(const LimitMatrix& matrix, const Buffer<std::uint8_t>& unknown, ConstValuesRef targets,
                                Values& x, const StopRule& stop) {
  using SparseMatrix = Eigen::SparseMatrix<double>;
  std::vector<Index> place(unknown.size(), -1);
  std::vector<Index> vertices;
  for (Index v = 0; v < static_cast<Index>(unknown.size()); ++v) {
    if (unknown[v] == 0) continue;
    place[v] = static_cast<Index>(vertices.size());
    vertices.push_back(v);
  }
  const auto count = static_cast<Eigen::Index>(vertices.size());
  Eigen::MatrixXd b(count, x.cols());
  Eigen::MatrixXd start(count, x.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < static_cast<Index>(vertices.size()); ++i) {
    const Index v = vertices[i];
    b.row(i) = targets.row(v);
    start.row(i) = x.row(v);
    matrix.visit_row(v, [&](Index column, double weight) {
      if (place[column] >= 0) {
        entries.emplace_back(i, place[column], weight);
      } else {
        b.row(i) -= weight * x.row(column);
      }
    });
  }
  SparseMatrix a(count, count);
  a.setFromTriplets(entries.begin(), entries.end());
  // From the residual of the start, so that what the iteration adds is as small as can be.
  Eigen::LeastSquaresConjugateGradient<SparseMatrix> solver(a);
  solver.setTolerance(1e-14);
  solver.setMaxIterations(stop.max_iterations);
  SolveReport report;
  report.method = SolveMethod::ConjugateGradient;
  report.method_name = "least squares by conjugate gradients";
  const Eigen::MatrixXd residual = b - a * start;
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    start.col(c) += solver.solve(Eigen::VectorXd(residual.col(c)));
    report.iterations = std::max(report.iterations, static_cast<int>(solver.iterations()));
    stop.report(1.0, 1.0);
  }
  for (Index i = 0; i < static_cast<Index>(vertices.size()); ++i) x.row(vertices[i]) = start.row(i);
  const Eigen::MatrixXd gradient = a.transpose() * (b - a * start);
  report.residual_history = {max_row_norm(gradient)};
  report.measured_after = {report.iterations};
  report.converged = report.residual_history.back() <= stop.tolerance;
  return report;
}

}  // namespace batten
