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

/// How many steps of the next round are enough, judging by the contraction of the last one; at most kSteps.
int steps_needed(double wanted, double last_contraction, double lower, double upper) {
  const double growth = std::acosh((upper + lower) / (upper - lower));
  const double slack = last_contraction * std::cosh(kSteps * growth);
  int steps = 1;
  while (steps < kSteps && slack > 0.5 * wanted * std::cosh(steps * growth)) ++steps;
  return steps;
}

/// Up to four columns of the problem in the order of the tiles.
struct Columns {
  Buffer<Double4> b;
  Buffer<Double4> x;
  Buffer<Float4> residual;  ///< (b - A x) / diagonal
};

/// What a thread needs for one tile.
struct Scratch {
  Buffer<Float4> residual;
  Buffer<Float4> now;
  Buffer<Float4> previous;
  Buffer<Double4> x;
  Buffer<Double4> product;
};

Scratch& scratch_for(const Tile& tile) {
  thread_local Scratch scratch;
  const auto size = static_cast<std::size_t>(tile.ring_end.back());
  if (scratch.residual.size() < size) {
    scratch.residual.resize(size);
    scratch.now.resize(size);
    scratch.previous.resize(size);
    scratch.x.resize(size);
    scratch.product.resize(size);
  }
  return scratch;
}

/// The columns [first, first + count) of the free rows; held values move to the right-hand side.
Columns gather(const Tiling& tiling, ConstValuesRef b, const ValuesRef& x, std::ptrdiff_t first, std::ptrdiff_t count) {
  Columns columns;
  columns.b.resize(tiling.order.size());
  columns.x.resize(tiling.order.size());
  columns.residual.resize(tiling.order.size());
  parallel_for(static_cast<std::ptrdiff_t>(tiling.order.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const Index row = tiling.order[i];
      columns.b[i] = columns.x[i] = Double4{0.0, 0.0, 0.0, 0.0};
      for (std::ptrdiff_t c = 0; c < count; ++c) {
        columns.b[i][c] = b(row, first + c);
        columns.x[i][c] = x(row, first + c);
      }
    }
  });
  for (const HeldEntry& entry : tiling.held) {
    for (std::ptrdiff_t c = 0; c < count; ++c) columns.b[entry.row][c] -= entry.weight * x(entry.column, first + c);
  }
  return columns;
}

void scatter(const Tiling& tiling, const Columns& columns, std::ptrdiff_t first, std::ptrdiff_t count, ValuesRef& x) {
  parallel_for(static_cast<std::ptrdiff_t>(tiling.order.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      for (std::ptrdiff_t c = 0; c < count; ++c) x(tiling.order[i], first + c) = columns.x[i][c];
    }
  });
}

/// Writes the residual of the tile's own rows, and returns the largest squared |b - A x| of a row.
double measure(const Tiling& tiling, const Tile& tile, Columns& columns) {
  Scratch& scratch = scratch_for(tile);
  const Index own = tile.own_count;
  std::copy_n(columns.x.begin() + tile.first, own, scratch.x.begin());
  for (Index i = own; i < tile.ring_end[1]; ++i) scratch.x[i] = columns.x[tile.ghosts[i - own]];
  tile_product(tile, tiling.patterns, scratch.x.data(), scratch.product.data());
  double most = 0.0;
  for (Index s = 0; s < tile.segment_end[0]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const double inverse = 1.0 / tiling.patterns[segment.pattern].diagonal;
    for (Index i = segment.first_row; i < segment.first_row + segment.row_count; ++i) {
      const Double4 r = columns.b[tile.first + i] - scratch.product[i];
      const Double4 square = r * r;
      most = larger_or_nan(most, square[0] + square[1] + square[2] + square[3]);
      columns.residual[tile.first + i] = __builtin_convertvector(r * inverse, Float4);
    }
  }
  return most;
}

/// Runs a round's steps in the tile and adds the correction to its own unknowns.
void correct(const Tiling& tiling, const Tile& tile, const Schedule& schedule, int steps, Columns& columns) {
  Scratch& scratch = scratch_for(tile);
  const Index own = tile.own_count;
  std::copy_n(columns.residual.begin() + tile.first, own, scratch.residual.begin());
  for (Index i = own; i < tile.ring_end[steps - 1]; ++i) scratch.residual[i] = columns.residual[tile.ghosts[i - own]];
  Float4* now = scratch.now.data();
  Float4* previous = scratch.previous.data();
  for (Index s = 0; s < tile.segment_end[steps - 1]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const auto diagonal = static_cast<float>(tiling.patterns[segment.pattern].diagonal);
    const float step = schedule.step_by_diagonal ? schedule.step[0] * diagonal : schedule.step[0];
    for (Index i = segment.first_row; i < segment.first_row + segment.row_count; ++i) {
      now[i] = step * scratch.residual[i];
      previous[i] = Float4{0.0F, 0.0F, 0.0F, 0.0F};
    }
  }
  for (int k = 1; k < steps; ++k) {
    tile_step(tile, tiling.patterns, steps - 1 - k, schedule.step[k], schedule.momentum[k], schedule.step_by_diagonal,
              scratch.residual.data(), now, previous);
    std::swap(now, previous);
  }
  for (Index i = 0; i < own; ++i) columns.x[tile.first + i] += __builtin_convertvector(now[i], Double4);
}

/// The rounds for up to four columns.
class Rounds {
 public:
  Rounds(const Tiling& tiling, const IterationOptions& options, const StopRule& stop)
      : tiling_(tiling), options_(options), stop_(stop), lower_(options.lower_bound) {}

  void run(Columns& columns, double tolerance) {
    const auto tile_count = static_cast<std::ptrdiff_t>(tiling_.tiles.size());
    const bool chebyshev = options_.method == SolveMethod::Chebyshev;
    double last = 0.0;
    while (true) {
      const double now = std::sqrt(parallel_reduce(
          tile_count, 0.0,
          [&](std::ptrdiff_t t, std::ptrdiff_t /*end*/) { return measure(tiling_, tiling_.tiles[t], columns); },
          larger_or_nan, 1));
      history.push_back(now);
      stop_.report(history.front(), now);
      converged = now <= tolerance;
      if (converged || iterations >= stop_.max_iterations || !std::isfinite(now)) return;
      int steps = kSteps;
      if (chebyshev && last > 0.0) {
        const double contraction = now / last;
        if (!(contraction < 0.95)) return;
        const double found = lower_bound_from(contraction, lower_, tiling_.upper_bound);
        if (found < 0.95 * lower_) lower_ = 0.9 * found;
        if (lower_ < options_.give_up_below) return;
        steps = steps_needed(tolerance / now, contraction, lower_, tiling_.upper_bound);
      }
      const Schedule schedule = chebyshev ? chebyshev_schedule(lower_, tiling_.upper_bound) : stationary_schedule(options_);
      parallel_for_each(tile_count,
                        [&](std::ptrdiff_t t) { correct(tiling_, tiling_.tiles[t], schedule, steps, columns); });
      iterations += steps;
      last = steps == kSteps ? now : 0.0;
    }
  }

  std::vector<double> history;
  int iterations = 0;
  bool converged = false;

 private:
  const Tiling& tiling_;
  const IterationOptions& options_;
  const StopRule& stop_;
  double lower_;
};

}  // namespace

struct TiledIteration::Tiles : Tiling {
  explicit Tiles(Tiling tiling) : Tiling(std::move(tiling)) {}
};

TiledIteration::TiledIteration(const RowSource& rows) : tiles_(std::make_unique<Tiles>(make_tiling(RowTable(rows)))) {}

TiledIteration::~TiledIteration() = default;
TiledIteration::TiledIteration(TiledIteration&&) noexcept = default;

double TiledIteration::upper_bound() const { return tiles_->upper_bound; }
double TiledIteration::overlap() const { return tiles_->overlap; }

SolveReport TiledIteration::solve(ConstValuesRef b, ValuesRef x, const IterationOptions& options,
                                  const StopRule& stop) const {
  if (tiles_->tiles.empty() && !tiles_->order.empty()) {
    throw Error(ErrorCode::NotAvailable, "this system has rows too wide for tiles; take conjugate gradients");
  }
  const auto started = std::chrono::steady_clock::now();
  SolveReport report;
  report.method = options.method;
  report.converged = true;
  // Each group of four columns keeps to its share of a row's allowed length.
  const std::ptrdiff_t groups = (x.cols() + 3) / 4;
  for (std::ptrdiff_t g = 0; g < groups; ++g) {
    const std::ptrdiff_t count = std::min<std::ptrdiff_t>(4, x.cols() - 4 * g);
    Columns columns = gather(*tiles_, b, x, 4 * g, count);
    Rounds rounds(*tiles_, options, stop);
    rounds.run(columns, stop.tolerance / std::sqrt(static_cast<double>(groups)));
    scatter(*tiles_, columns, 4 * g, count, x);
    report.iterations = std::max(report.iterations, rounds.iterations);
    report.converged = report.converged && rounds.converged;
    report.residual_history.insert(report.residual_history.end(), rounds.history.begin(), rounds.history.end());
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return report;
}

}  // namespace batten
