#include "batten/solve/tiled_iteration.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/parallel/spare.h"
#include "batten/solve/spectral_bound.h"
#include "batten/solve/tiles.h"

namespace batten {

namespace {

constexpr int kSteps = TiledIteration::kStepsPerRound;

/// A round that leaves more than this of the residual does not get anywhere.
constexpr double kStanding = 0.95;
/// With a bound below this share of the upper one even eight steps of the best polynomial contract by a twentieth only.
constexpr double kLeastBound = 1e-5;

/// The coefficients of one round: d_k = momentum_k d_{k-1} + step_k D^-1 (b - A x_k), x_{k+1} = x_k + d_k.
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

/// Chebyshev's semi-iteration for a spectrum in [lower, upper] (Saad 2003, algorithm 12.1; key S03), round after round.
class Chebyshev {
 public:
  Chebyshev(double lower, double upper) : lower_(lower), upper_(upper) { restart(lower); }

  double lower() const { return lower_; }
  double upper() const { return upper_; }

  void restart(double lower) {
    lower_ = lower;
    rho_ = 0.0;
    steps_ = 0;
  }

  Schedule next(int steps) {
    Schedule schedule;
    for (int k = 0; k < steps; ++k, ++steps_) {
      if (steps_ == 0) {
        schedule.step[k] = static_cast<float>(1.0 / middle());
        schedule.momentum[k] = 0.0F;
        rho_ = half() / middle();
        continue;
      }
      const double rho = 1.0 / (2.0 * middle() / half() - rho_);
      schedule.step[k] = static_cast<float>(2.0 * rho / half());
      schedule.momentum[k] = static_cast<float>(rho * rho_);
      rho_ = rho;
    }
    return schedule;
  }

  /// The lowest eigenvalue that explains how far the residual has come since the start: |T_n(y(lambda))| / T_n(y(0)).
  double lowest_eigenvalue(double contraction) const {
    const double at_zero = steps_ * std::acosh(middle() / half());
    const double at_lowest =
        std::log(std::min(contraction, 1.0)) + at_zero;  // cosh n a is exp(n a)/2 but for small n a
    if (at_lowest <= 1.0) return lower_;
    return middle() - half() * std::cosh(at_lowest / steps_);
  }

  /// The same for an iteration that hardly moves, where T_n may be near 1; at least a tenth of the bound.
  double standing_eigenvalue(double contraction) const {
    const double at_zero = std::min(steps_ * std::acosh(middle() / half()), 700.0);  // cosh of more is infinite
    const double polynomial = std::min(contraction, 1.0) * std::cosh(at_zero);
    if (!(polynomial > 1.0)) return lower_;
    return std::max(0.1 * lower_, middle() - half() * std::cosh(std::acosh(polynomial) / steps_));
  }

 private:
  double middle() const { return 0.5 * (upper_ + lower_); }
  double half() const { return 0.5 * (upper_ - lower_); }
  double lower_;
  double upper_;
  double rho_ = 0.0;
  int steps_ = 0;
};

/// How many steps are enough for a residual `wanted` times the present one, at the last round's rate; at most kSteps.
int steps_needed(double wanted, double last_contraction) {
  const double steps = std::ceil(kSteps * std::log(0.7 * wanted) / std::log(last_contraction));
  return static_cast<int>(std::clamp(steps, 1.0, static_cast<double>(kSteps)));
}

/// Up to four columns of the problem in the order of the tiles.
struct IterationColumns {
  Buffer<Double4> b;
  Buffer<Double4> x;
  Buffer<Float4> residual;     ///< (b - A x) / diagonal
  Buffer<Float4> change;       ///< x less its value one step before
  Buffer<Float4> next_change;  ///< the same, as the running round writes it

  void resize(std::size_t size) {
    b.resize(size);
    x.resize(size);
    residual.resize(size);
    change.resize(size);
    next_change.resize(size);
  }
};

/// What a thread needs for one tile.
struct IterationScratch {
  Buffer<Float4> residual;
  Buffer<Float4> now;
  Buffer<Float4> previous;
  Buffer<Double4> x;
  Buffer<Double4> product;

  std::size_t size() const { return residual.size(); }
  void resize(std::size_t count) {
    residual.resize(count);
    now.resize(count);
    previous.resize(count);
    x.resize(count);
    product.resize(count);
  }
};

void load_row(const double* row, std::ptrdiff_t count, Double4& value) {
  value = Double4{row[0], 0.0, 0.0, 0.0};
  for (std::ptrdiff_t c = 1; c < count; ++c) value[c] = row[c];
}

/// The columns [first, first + count) of the free rows; held values move to the right-hand side.
void gather(const Tiling& tiling, ConstValuesRef b, const ValuesRef& x, std::ptrdiff_t first, std::ptrdiff_t count,
            IterationColumns& columns) {
  const double* from_b = b.data() + first;
  const double* from_x = x.data() + first;
  parallel_for(static_cast<std::ptrdiff_t>(tiling.order.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const std::ptrdiff_t row = tiling.order[i];
      load_row(from_b + row * b.outerStride(), count, columns.b[i]);
      load_row(from_x + row * x.outerStride(), count, columns.x[i]);
    }
  });
  for (const HeldEntry& entry : tiling.held) {
    for (std::ptrdiff_t c = 0; c < count; ++c) columns.b[entry.row][c] -= entry.weight * x(entry.column, first + c);
  }
}

void scatter(const Tiling& tiling, const IterationColumns& columns, std::ptrdiff_t first, std::ptrdiff_t count,
             ValuesRef& x) {
  parallel_for(static_cast<std::ptrdiff_t>(tiling.order.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      for (std::ptrdiff_t c = 0; c < count; ++c) x(tiling.order[i], first + c) = columns.x[i][c];
    }
  });
}

/// A x of the tile's own rows, in double.
const Double4* product_of(const Tiling& tiling, const Tile& tile, const IterationColumns& columns) {
  IterationScratch& scratch = scratch_for<IterationScratch>(tile);
  const Index own = tile.own_count;
  std::copy_n(columns.x.begin() + tile.first, own, scratch.x.begin());
  for (Index i = own; i < tile.ring_end[1]; ++i) scratch.x[i] = columns.x[tile.ghosts[i - own]];
  tile_product(tile, tiling.patterns, scratch.x.data(), scratch.product.data());
  return scratch.product.data();
}

/// Writes the residual of the tile's own rows, and returns the largest squared |b - A x| of a row.
double measure(const Tiling& tiling, const Tile& tile, IterationColumns& columns) {
  const Double4* product = product_of(tiling, tile, columns);
  double most = 0.0;
  for (Index s = 0; s < tile.segment_end[0]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const double inverse = 1.0 / tiling.patterns[segment.pattern].diagonal;
    for (Index i = segment.first_row; i < segment.first_row + segment.row_count; ++i) {
      const Double4 r = columns.b[tile.first + i] - product[i];
      const Double4 square = r * r;
      most = larger_or_nan(most, square[0] + square[1] + square[2] + square[3]);
      columns.residual[tile.first + i] = __builtin_convertvector(r * inverse, Float4);
    }
  }
  return most;
}

/// Runs a round's steps in the tile and adds the correction to its own unknowns. The change of the last round is only
/// read here, since neighbours read it too; the new one goes to next_change.
void correct(const Tiling& tiling, const Tile& tile, const Schedule& schedule, int steps, IterationColumns& columns) {
  IterationScratch& scratch = scratch_for<IterationScratch>(tile);
  const Index own = tile.own_count;
  const Index all = tile.ring_end[steps - 1];
  Float4* now = scratch.now.data();
  Float4* previous = scratch.previous.data();
  std::copy_n(columns.residual.begin() + tile.first, own, scratch.residual.begin());
  for (Index i = own; i < all; ++i) scratch.residual[i] = columns.residual[tile.ghosts[i - own]];
  if (schedule.momentum[0] != 0.0F) {
    for (Index i = 0; i < own; ++i) now[i] = schedule.momentum[0] * columns.change[tile.first + i];
    for (Index i = own; i < all; ++i) now[i] = schedule.momentum[0] * columns.change[tile.ghosts[i - own]];
  } else {
    std::fill_n(now, all, Float4{0.0F, 0.0F, 0.0F, 0.0F});
  }
  std::fill_n(previous, all, Float4{0.0F, 0.0F, 0.0F, 0.0F});
  for (Index s = 0; s < tile.segment_end[steps - 1]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const auto diagonal = static_cast<float>(tiling.patterns[segment.pattern].diagonal);
    const float step = schedule.step_by_diagonal ? schedule.step[0] * diagonal : schedule.step[0];
    const Index last = segment.first_row + segment.row_count;
    for (Index i = segment.first_row; i < last; ++i) now[i] += step * scratch.residual[i];
  }
  for (int k = 1; k < steps; ++k) {
    tile_step(tile, tiling.patterns, steps - 1 - k, schedule.step[k], schedule.momentum[k], schedule.step_by_diagonal,
              scratch.residual.data(), now, previous);
    std::swap(now, previous);
  }
  for (Index i = 0; i < own; ++i) {
    columns.x[tile.first + i] += __builtin_convertvector(now[i], Double4);
    columns.next_change[tile.first + i] = now[i] - previous[i];
  }
}

/// The rounds for up to four columns.
class Rounds {
 public:
  Rounds(const Tiling& tiling, double upper_bound, const IterationOptions& options, const StopRule& stop)
      : tiling_(tiling), options_(options), stop_(stop), chebyshev_(options.lower_bound, upper_bound) {}

  void run(IterationColumns& columns, double tolerance) {
    const auto tile_count = static_cast<std::ptrdiff_t>(tiling_.tiles.size());
    while (true) {
      history.push_back(std::sqrt(parallel_reduce(
          tile_count, 0.0,
          [&](std::ptrdiff_t t, std::ptrdiff_t /*end*/) { return measure(tiling_, tiling_.tiles[t], columns); },
          larger_or_nan, 1)));
      measured_after.push_back(iterations);
      const double now = history.back();
      stop_.report(history.front(), now);
      converged = now <= tolerance;
      if (converged || iterations >= stop_.max_iterations || !std::isfinite(now)) return;
      const int left = stop_.max_iterations - iterations;
      int steps = std::min(kSteps, left);
      Schedule schedule;
      if (options_.method == SolveMethod::Chebyshev) {
        if (!adapt(now, tolerance, steps)) return;
        steps = std::min(steps, left);
        schedule = chebyshev_.next(steps);
      } else {
        schedule = stationary_schedule(options_);
      }
      parallel_for_each(tile_count,
                        [&](std::ptrdiff_t t) { correct(tiling_, tiling_.tiles[t], schedule, steps, columns); });
      std::swap(columns.change, columns.next_change);
      iterations += steps;
    }
  }

  std::vector<double> history;
  std::vector<int> measured_after;
  int iterations = 0;
  bool converged = false;

 private:
  /// Lowers the bound where the residual falls more slowly than it should, and chooses the number of steps. False where
  /// the bound had to become too low. A residual that stands still is no reason to give up by itself: on a single mode
  /// Chebyshev's polynomial may come back from a zero, and one that goes on to stand lowers the bound round by round.
  bool adapt(double now, double tolerance, int& steps) {
    if (history.size() == 1) start_ = now;
    if (history.size() < 2) return true;
    const double contraction = now / history[history.size() - 2];
    const bool stands = !(contraction < kStanding);
    const double lowest =
        stands ? chebyshev_.standing_eigenvalue(now / start_) : chebyshev_.lowest_eigenvalue(now / start_);
    if (lowest < 0.9 * chebyshev_.lower()) {
      chebyshev_.restart(0.9 * lowest);
      start_ = now;
    }
    steps = stands ? kSteps : steps_needed(tolerance / now, contraction);
    return chebyshev_.lower() >= std::max(options_.give_up_below, kLeastBound * chebyshev_.upper());
  }

  const Tiling& tiling_;
  const IterationOptions& options_;
  const StopRule& stop_;
  Chebyshev chebyshev_;
  double start_ = 0.0;
};

}  // namespace

/// The tiles, and the columns of earlier solves: solving again and again must not pay for fresh memory.
struct TiledIteration::Tiles : Tiling {
  explicit Tiles(Tiling tiling) : Tiling(std::move(tiling)), upper_bound(spectral_bound(*this)) {}

  double upper_bound;  ///< of the spectrum of D^-1 A
  Spare<IterationColumns> spare;
};

namespace {

/// The rows' errors |b - A x|, measured once more, in double.
ErrorSummary summarise(const Tiling& tiling, const IterationColumns& columns) {
  return parallel_reduce(
      static_cast<std::ptrdiff_t>(tiling.tiles.size()), ErrorSummary(),
      [&](std::ptrdiff_t t, std::ptrdiff_t /*end*/) {
        ErrorSummary summary;
        const Tile& tile = tiling.tiles[t];
        const Double4* product = product_of(tiling, tile, columns);
        for (Index i = 0; i < tile.own_count; ++i) {
          const Double4 r = columns.b[tile.first + i] - product[i];
          const Double4 square = r * r;
          summary.add({tiling.order[tile.first + i], std::sqrt(square[0] + square[1] + square[2] + square[3])});
        }
        return summary;
      },
      [](ErrorSummary left, const ErrorSummary& right) {
        left.add(right);
        return left;
      },
      1);
}

}  // namespace

TiledIteration::TiledIteration(const RowSource& rows, const Progress& progress)
    : tiles_(std::make_unique<Tiles>(
          make_tiling(RowTable(rows, progress_within(progress, 0.0, 0.4)), progress_within(progress, 0.4, 1.0)))) {}

TiledIteration::~TiledIteration() = default;
TiledIteration::TiledIteration(TiledIteration&&) noexcept = default;

double TiledIteration::upper_bound() const { return tiles_->upper_bound; }
double TiledIteration::overlap() const { return tiles_->overlap; }

SolveReport TiledIteration::solve(ConstValuesRef b, ValuesRef x, const IterationOptions& options,
                                  const StopRule& stop) const {
  if (tiles_->tiles.empty() && !tiles_->order.empty()) {
    throw Error(ErrorCode::NotAvailable, "this system has rows too wide for tiles; take conjugate gradients");
  }
  const Stopwatch watch;
  SolveReport report;
  report.method = options.method;
  report.method_name = method_name(options.method);
  report.converged = true;
  // Each group of four columns keeps to its share of a row's allowed length.
  const std::ptrdiff_t groups = (x.cols() + 3) / 4;
  IterationColumns columns = tiles_->spare.take();
  columns.resize(tiles_->order.size());
  for (std::ptrdiff_t g = 0; g < groups; ++g) {
    const std::ptrdiff_t count = std::min<std::ptrdiff_t>(4, x.cols() - 4 * g);
    gather(*tiles_, b, x, 4 * g, count, columns);
    Rounds rounds(*tiles_, tiles_->upper_bound, options, stop);
    rounds.run(columns, stop.tolerance / std::sqrt(static_cast<double>(groups)));
    scatter(*tiles_, columns, 4 * g, count, x);
    report.iterations = std::max(report.iterations, rounds.iterations);
    report.converged = report.converged && rounds.converged;
    report.residual_history.insert(report.residual_history.end(), rounds.history.begin(), rounds.history.end());
    report.measured_after.insert(report.measured_after.end(), rounds.measured_after.begin(),
                                 rounds.measured_after.end());
  }
  if (groups == 1) report.errors = summarise(*tiles_, columns);
  tiles_->spare.give_back(std::move(columns));
  report.seconds = watch.seconds();
  return report;
}

}  // namespace batten
