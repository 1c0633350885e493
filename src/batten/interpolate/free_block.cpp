#include "batten/interpolate/free_block.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/solve/krylov.h"

namespace batten {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Two solves: the second one for what rounding left of the residual.
template <typename Factors>
void solve_refined(const Factors& factors, const SparseMatrix& a, const Values& b, Values& x) {
  Eigen::MatrixXd solution = factors.solve(Eigen::MatrixXd(b));
  solution += Eigen::MatrixXd(factors.solve(Eigen::MatrixXd(b - a * solution)));
  x = solution;
}

}  // namespace

FreeBlock::FreeBlock(const LimitMatrix& matrix, Buffer<std::uint8_t> free)
    : RowSource(matrix.topology().vertex_count(), std::move(free)), matrix_(matrix) {
  for (Index v = 0; v < size(); ++v) {
    if (!is_free(v)) continue;
    ++free_count_;
    symmetric_ = symmetric_ && matrix.row_kind(v) == LimitRow::Smooth;
  }
}

void FreeBlock::row(Index row, RowEntries& entries) const {
  matrix_.visit_row(row, [&](Index column, double weight) { entries.add(column, weight); });
}

void FreeBlock::mask(Values& values) const {
  if (all_free()) return;
  parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (!is_free(static_cast<Index>(v))) values.row(v).setZero();
    }
  });
}

LinearMap FreeBlock::map() const {
  return [this](const Values& x, Values& y) {
    y.resize(x.rows(), x.cols());
    matrix_.apply_unchecked(x, y);
    mask(y);
  };
}

SolveReport FreeBlock::solve_krylov(ConstValuesRef targets, Values& x, const StopRule& stop) const {
  const Stopwatch watch;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(size());
  Eigen::VectorXd diagonal = Eigen::VectorXd::Ones(size());
  bool positive = true;
  for (Index v = 0; v < size(); ++v) {
    if (!is_free(v)) continue;
    double entry = 0.0;
    matrix_.visit_row(v, [&](Index column, double weight) { entry += column == v ? weight : 0.0; });
    scale[v] = matrix_.row_scale(v);
    diagonal[v] = entry;
    positive = positive && entry > 0.0;
  }
  Values b = targets;
  mask(b);
  SolveReport report;
  if (symmetric_ && positive) {
    report = conjugate_gradients(map(), scale, scale.cwiseProduct(diagonal), b, x, stop);
  }
  if (!symmetric_ || !positive || report.indefinite) {
    StopRule rest = stop;
    rest.max_iterations -= report.iterations;
    report.append(bicgstab(map(), diagonal, b, x, rest), ", then ");
  }
  report.seconds = watch.seconds();
  return report;
}

SolveReport FreeBlock::solve_direct(ConstValuesRef targets, Values& x, const StopRule& stop) const {
  const Stopwatch watch;
  SolveReport report;
  report.method = SolveMethod::Direct;
  std::vector<Index> place(static_cast<std::size_t>(size()), -1);
  Index count = 0;
  for (Index v = 0; v < size(); ++v) {
    if (is_free(v)) place[v] = count++;
  }
  Values b(count, x.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (Index v = 0; v < size(); ++v) {
    if (place[v] < 0) continue;
    const double scale = matrix_.row_scale(v);
    b.row(place[v]) = scale * targets.row(v);
    matrix_.visit_row(v, [&](Index column, double weight) {
      if (place[column] >= 0) {
        entries.emplace_back(place[v], place[column], scale * weight);
      } else {
        b.row(place[v]) -= scale * weight * x.row(column);
      }
    });
  }
  stop.report(1.0, 1.0);
  SparseMatrix a(count, count);
  a.setFromTriplets(entries.begin(), entries.end());
  std::vector<Eigen::Triplet<double>>().swap(entries);
  Values solution;
  bool solved = false;
  if (symmetric_) {
    const Eigen::SimplicialLDLT<SparseMatrix> factors(a);
    solved = factors.info() == Eigen::Success && (count == 0 || factors.vectorD().minCoeff() > 1e-12);
    report.method_name = "sparse Cholesky";
    if (solved) solve_refined(factors, a, b, solution);
  }
  if (!solved) {
    Eigen::SparseLU<SparseMatrix> factors(a);
    if (factors.info() != Eigen::Success) {
      throw Error(ErrorCode::SingularSystem, "the interpolation system is singular: " + factors.lastErrorMessage());
    }
    report.method_name = "sparse LU";
    solve_refined(factors, a, b, solution);
  }
  stop.report(1.0, 1.0);
  for (Index v = 0; v < size(); ++v) {
    if (place[v] >= 0) x.row(v) = solution.row(place[v]);
  }
  Values residual(x.rows(), x.cols());
  matrix_.apply_unchecked(x, residual);
  residual = targets - residual;
  mask(residual);
  report.measured(max_row_norm(residual));
  report.converged = report.residual_history.back() <= stop.tolerance;
  report.seconds = watch.seconds();
  return report;
}

}  // namespace batten
