#include "batten/solve/tiled_iteration.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/solve/tiles.h"

namespace batten {

namespace {

constexpr int kSteps = TiledIteration::kStepsPerRound;

/// One round of a polynomial iteration: y_1 = step_1 r, y_k = y_{k-1} + momentum_k (y_{k-1} - y_{k-2}) + step_k (r - G y_{k-1}).
struct Schedule {
  float step[kSteps];
  float momentum[kSteps];
  bool step_by_diagonal = false;
};

Schedule stationary_schedule(const IterationOptions& options) {
  Schedule schedule;
  const bool jacobi = options.method == SolveMethod::Jacobi;
  for (int k = 0; k < kSteps; ++k) {
    schedule.step[k] = jacobi ? static_cast<float>(options.omega) : 1.0F;
    schedule.momentum[k] = 0.0F;
  }
  schedule.step_by_diagonal = !jacobi;
  return schedule;
}

/// Chebyshev's semi-iteration for a spectrum in [lower, upper] (Saad 2003, algorithm 12.1; key S03).
Schedule chebyshev_schedule(double lower, double upper) {
  const double middle = 0.5 * (upper + lower);
  const double half = 0.5 * (upper - lower);
  const double sigma = middle / half;
  Schedule schedule;
  schedule.step[0] = static_cast<float>(1.0 / middle);
  schedule.momentum[0] = 0.0F;
  double rho = 1.0 / sigma;
  for (int k = 1; k < kSteps; ++k) {
    const double next = 1.0 / (2.0 * sigma - rho);
    schedule.step[k] = static_cast<float>(2.0 * next / half);
    schedule.momentum[k] = static_cast<float>(next * rho);
    rho = next;
  }
  return schedule;
}

/// The lowest eigenvalue that explains a round's measured contraction, given the interval it was run with.
double lower_bound_from(double contraction, double lower, double upper) {
  const double middle = 0.5 * (upper + lower);
  const double half = 0.5 * (upper - lower);
  const double at_zero = std::cosh(kSteps * std::acosh(middle / half));
  const double value = std::min(contraction, 1.0) * at_zero;
  if (value <= 1.0) return lower;
  return middle - half * std::cosh(std::acosh(value) / kSteps);
}

/// What a thread needs for one tile.
struct Scratch {
  Buffer<Float4> residual;
  Buffer<Float4> a;
  Buffer<Float4> b;
  Buffer<Double4> x;
  Buffer<Double4> product;
};

Scratch& scratch_for(const Tile& tile) {
  thread_local Scratch scratch;
  const std::size_t size = tile.globals.size();
  if (scratch.residual.size() < size) {
    scratch.residual.resize(size);
    scratch.a.resize(size);
    scratch.b.resize(size);
    scratch.x.resize(size);
    scratch.product.resize(size);
  }
  return scratch;
}

/// Up to four columns of the problem.
struct ColumnGroup {
  const double* b;
  std::ptrdiff_t b_stride;
  double* x;
  std::ptrdiff_t x_stride;
  int columns;

  void load(const double* base, std::ptrdiff_t stride, Index row, Double4& value) const {
    const double* p = base + row * stride;
    if (columns == 3) {
      value = Double4{p[0], p[1], p[2], 0.0};
      return;
    }
    value = Double4{p[0], 0.0, 0.0, 0.0};
    for (int c = 1; c < columns; ++c) value[c] = p[c];
  }
};

}  // namespace

struct TiledIteration::Tiles : Tiling {
  explicit Tiles(Tiling tiling) : Tiling(std::move(tiling)) {}

  /// Writes (b - A x) / diagonal of the tile's own rows to residual, and returns the largest squared |b - A x|.
  double measure(const Tile& tile, const ColumnGroup& group, Float4* residual, Double4* squares) const {
    Scratch& scratch = scratch_for(tile);
    for (Index i = 0; i < tile.ring_end[1]; ++i) {
      group.load(group.x, group.x_stride, tile.globals[i], scratch.x[i]);
    }
    tile_product(tile, patterns, scratch.x.data(), scratch.product.data());
    for (Index k = tile.held_begin; k < tile.held_end; ++k) {
      Double4 x;
      group.load(group.x, group.x_stride, held[k].column, x);
      scratch.product[held[k].local_row] += held[k].weight * x;
    }
    double most = 0.0;
    for (Index s = 0; s < tile.segment_end[0]; ++s) {
      const TileSegment& segment = tile.segments[s];
      const double inverse = 1.0 / patterns[segment.pattern].diagonal;
      for (Index i = segment.first_row; i < segment.first_row + segment.row_count; ++i) {
        const Index global = tile.globals[i];
        Double4 r;
        group.load(group.b, group.b_stride, global, r);
        r -= scratch.product[i];
        Double4 square = r * r;
        if (squares != nullptr) square = squares[global] += square;
        const double norm = square[0] + square[1] + square[2] + square[3];
        if (!(norm <= most)) most = norm;
        const Double4 scaled = r * inverse;
        residual[global] = Float4{static_cast<float>(scaled[0]), static_cast<float>(scaled[1]),
                                  static_cast<float>(scaled[2]), static_cast<float>(scaled[3])};
      }
    }
    return most;
  }

  /// Runs the round's steps in the tile and adds the correction to its own unknowns.
  void correct(const Tile& tile, const ColumnGroup& group, const Schedule& schedule, const Float4* residual) const {
    Scratch& scratch = scratch_for(tile);
    const Index all = tile.ring_end[Tile::kRings - 1];
    Float4* now = scratch.a.data();
    Float4* previous = scratch.b.data();
    for (Index i = 0; i < all; ++i) {
      scratch.residual[i] = residual[tile.globals[i]];
      previous[i] = Float4{0.0F, 0.0F, 0.0F, 0.0F};
    }
    for (const TileSegment& segment : tile.segments) {
      const auto diagonal = static_cast<float>(patterns[segment.pattern].diagonal);
      const float step = schedule.step_by_diagonal ? schedule.step[0] * diagonal : schedule.step[0];
      const Index last = segment.first_row + segment.row_count;
      for (Index i = segment.first_row; i < last; ++i) now[i] = step * scratch.residual[i];
    }
    for (int k = 1; k < kSteps; ++k) {
      tile_step(tile, patterns, kSteps - 1 - k, schedule.step[k], schedule.momentum[k], schedule.step_by_diagonal,
                scratch.residual.data(), now, previous);
      std::swap(now, previous);
    }
    for (Index i = 0; i < tile.own_count(); ++i) {
      double* x = group.x + tile.globals[i] * group.x_stride;
      for (int c = 0; c < group.columns; ++c) x[c] += static_cast<double>(now[i][c]);
    }
  }
};

TiledIteration::TiledIteration(const RowSource& rows) {
  RowTable table(rows);
  tiles_ = std::make_unique<Tiles>(make_tiling(table));
}

TiledIteration::~TiledIteration() = default;
TiledIteration::TiledIteration(TiledIteration&&) noexcept = default;

double TiledIteration::upper_bound() const { return tiles_->upper_bound; }
double TiledIteration::overlap() const { return tiles_->overlap; }

SolveReport TiledIteration::solve(ConstValuesRef b, ValuesRef x, const IterationOptions& options,
                                  const StopRule& stop) const {
  if (tiles_->tiles.empty() && tiles_->free_count > 0) {
    throw Error(ErrorCode::NotAvailable, "this system has rows too wide for tiles; take conjugate gradients");
  }
  const auto started = std::chrono::steady_clock::now();
  SolveReport report;
  report.method = options.method;
  const auto tile_count = static_cast<std::ptrdiff_t>(tiles_->tiles.size());
  const bool chebyshev = options.method == SolveMethod::Chebyshev;
  double lower = options.lower_bound;
  std::vector<ColumnGroup> groups;
  for (std::ptrdiff_t c = 0; c < x.cols(); c += 4) {
    groups.push_back({b.data() + c, b.outerStride(), x.data() + c, x.outerStride(),
                      static_cast<int>(std::min<std::ptrdiff_t>(4, x.cols() - c))});
  }
  std::vector<Buffer<Float4>> residuals(groups.size());
  for (Buffer<Float4>& residual : residuals) residual.resize(static_cast<std::size_t>(x.rows()));
  Buffer<Double4> squares(groups.size() > 1 ? static_cast<std::size_t>(x.rows()) : 0);
  while (true) {
    double most = 0.0;
    if (!squares.empty()) std::fill(squares.begin(), squares.end(), Double4{0.0, 0.0, 0.0, 0.0});
    for (std::size_t g = 0; g < groups.size(); ++g) {
      most = parallel_reduce(
          tile_count, 0.0,
          [&](std::ptrdiff_t begin, std::ptrdiff_t /*end*/) {
            return tiles_->measure(tiles_->tiles[begin], groups[g], residuals[g].data(),
                                   squares.empty() ? nullptr : squares.data());
          },
          [](double left, double right) { return !(right <= left) ? right : left; }, 1);
    }
    report.residual_history.push_back(std::sqrt(most));
    const double now = report.residual_history.back();
    stop.report(report.residual_history.front(), now);
    report.converged = now <= stop.tolerance;
    const std::size_t measured = report.residual_history.size();
    if (measured > 1 && chebyshev && !report.converged) {
      const double contraction = now / report.residual_history[measured - 2];
      lower = std::min(lower, 0.9 * lower_bound_from(contraction, lower, tiles_->upper_bound));
      if (!(contraction < 0.95) || lower < options.give_up_below) break;
    }
    if (report.converged || report.iterations >= stop.max_iterations || !std::isfinite(now)) break;
    const Schedule schedule =
        chebyshev ? chebyshev_schedule(lower, tiles_->upper_bound) : stationary_schedule(options);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      parallel_for_each(tile_count, [&](std::ptrdiff_t t) {
        tiles_->correct(tiles_->tiles[t], groups[g], schedule, residuals[g].data());
      });
    }
    report.iterations += kSteps;
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return report;
}

}  // namespace batten
