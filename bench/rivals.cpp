/// The iterations of the papers and of Eigen, implemented with care, for comparison.
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cmath>

#include "batten/interpolate/free_block.h"
#include "batten/parallel/parallel.h"
#include "batten/solve/row_table.h"
#include "batten/solve/tiles.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

Buffer<std::uint8_t> smooth_rows(const LimitMatrix& matrix) {
  Buffer<std::uint8_t> free(static_cast<std::size_t>(matrix.topology().vertex_count()));
  for (Index v = 0; v < matrix.topology().vertex_count(); ++v) free[v] = matrix.row_kind(v) == LimitRow::Smooth ? 1 : 0;
  return free;
}

}  // namespace

/// Rows in the tiles' order, with neighbours as 32-bit places and runs of rows of equal pattern. For closed meshes
/// only.
struct Sweeps::Parts {
  explicit Parts(const Subject& subject)
      : matrix(subject.topology, subject.scheme),
        block(matrix, smooth_rows(matrix)),
        rows(block),
        tiling(make_tiling(rows)) {
    Buffer<Index> place(static_cast<std::size_t>(rows.size()));
    for (std::size_t i = 0; i < tiling.order.size(); ++i) place[tiling.order[i]] = static_cast<Index>(i);
    for (const Index row : tiling.order) {
      begins.push_back(columns.size());
      for (Index k = 0; k < rows.column_count(row); ++k) columns.push_back(place[rows.columns(row)[k]]);
    }
  }
  LimitMatrix matrix;
  FreeBlock block;
  RowTable rows;
  Tiling tiling;
  Buffer<std::size_t> begins;
  Buffer<Index> columns;
};

Sweeps::Sweeps(const Subject& subject) : parts_(std::make_unique<Parts>(subject)) {}
Sweeps::~Sweeps() = default;

int Sweeps::run(const Subject& subject, SolveMethod method, double tolerance) const {
  constexpr int kStepsPerRound = TiledIteration::kStepsPerRound;
  const Parts& parts = *parts_;
  const auto count = static_cast<std::ptrdiff_t>(parts.tiling.order.size());
  Buffer<Double4> b(parts.tiling.order.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto row = subject.targets.row(parts.tiling.order[i]);
    b[i] = Double4{row[0], row[1], row[2], 0.0};
  }
  Buffer<Double4> x = b;
  Buffer<Float4> residual(b.size());
  Buffer<Float4> now(b.size());
  Buffer<Float4> next(b.size());
  const auto pattern = [&](std::ptrdiff_t i) -> const RowPattern& {
    return parts.rows.patterns()[parts.rows.pattern_of(parts.tiling.order[i])];
  };
  const bool jacobi = method == SolveMethod::Jacobi;
  int sweeps = 0;
  while (true) {
    const double most = parallel_reduce(
        count, 0.0,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          double largest = 0.0;
          for (std::ptrdiff_t i = begin; i < end; ++i) {
            const RowPattern& weights = pattern(i);
            const Index* columns = parts.columns.data() + parts.begins[i];
            Double4 r = b[i] - weights.diagonal * x[i];
            for (std::size_t k = 0; k < weights.weights.size(); ++k) r -= weights.weights[k] * x[columns[k]];
            const Double4 square = r * r;
            largest = larger_or_nan(largest, square[0] + square[1] + square[2]);
            residual[i] = __builtin_convertvector(r / weights.diagonal, Float4);
            now[i] = Float4{0.0F, 0.0F, 0.0F, 0.0F};
          }
          return largest;
        },
        larger_or_nan);
    if (std::sqrt(most) <= tolerance) return sweeps;
    for (int step = 0; step < kStepsPerRound; ++step, ++sweeps) {
      parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const RowPattern& weights = pattern(i);
          const Index* columns = parts.columns.data() + parts.begins[i];
          Float4 r = residual[i] - now[i];
          for (std::size_t k = 0; k < weights.normalised.size(); ++k) r -= weights.normalised[k] * now[columns[k]];
          next[i] = now[i] + (jacobi ? 0.5F : static_cast<float>(weights.diagonal)) * r;
        }
      });
      std::swap(now, next);
    }
    parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) x[i] += __builtin_convertvector(now[i], Double4);
    });
  }
}

double eigen_conjugate_gradients(const Subject& subject, double relative_tolerance) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const LimitMatrix limit(subject.topology, subject.scheme);
  const Index count = subject.topology.vertex_count();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(count) * 9);
  for (Index v = 0; v < count; ++v) {
    const double scale = limit.row_scale(v);
    limit.visit_row(v, [&](Index column, double weight) { entries.emplace_back(v, column, scale * weight); });
  }
  Matrix a(count, count);
  a.setFromTriplets(entries.begin(), entries.end());
  Values b = subject.targets;
  for (Index v = 0; v < count; ++v) b.row(v) *= limit.row_scale(v);
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver(a);
  solver.setTolerance(relative_tolerance);
  const Values x = solver.solveWithGuess(Eigen::MatrixXd(b), Eigen::MatrixXd(subject.targets));
  return (limit.apply(x) - subject.targets).rowwise().norm().maxCoeff();
}

}  // namespace batten::bench
