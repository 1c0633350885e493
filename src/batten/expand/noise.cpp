#include "batten/expand/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

constexpr int kPower = 4;
constexpr unsigned kSeed = 20060350;

bool is_measured(const MeshSeries& series, Index v) {
  return series.limit_matrix().row_kind(v) == LimitRow::Smooth && !series.is_kept(v);
}

void require_points(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals) {
  require_vertex_rows(series.topology(), points);
  require_vertex_rows(series.topology(), normals);
  if (points.cols() != 3 || normals.cols() != 3)
    throw Error(ErrorCode::BadShape, "noise is measured on points and normals of three columns");
}

/// Normally distributed numbers that are the same for every compiler, unlike those of std::normal_distribution.
Values normal_numbers(Index rows, Index columns) {
  std::mt19937_64 generator(kSeed);
  const auto uniform = [&] { return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53; };
  Values values(rows, columns);
  for (Index i = 0; i < rows; ++i) {
    for (Index c = 0; c < columns; ++c)
      values(i, c) = std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
  }
  return values;
}

double along_normal(ConstValuesRef vectors, ConstValuesRef normals, Eigen::Index v) {
  return vectors(v, 0) * normals(v, 0) + vectors(v, 1) * normals(v, 1) + vectors(v, 2) * normals(v, 2);
}

/// Sums over the measured vertices.
struct Removed {
  double squares = 0.0;  ///< of what was removed along the normal
  double noise = 0.0;    ///< of what unit noise would lose, squared
  double trace = 0.0;    ///< of the smoothing matrix
};

enum class Where { Measured, Everywhere };

/// start: the points and random signs; now: the same after smoothing.
Removed measure(const MeshSeries& series, const Values& start, const Values& now, ConstValuesRef normals, Where where) {
  const auto rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Removed sums;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (where == Where::Measured && !is_measured(series, static_cast<Index>(v))) continue;
      double along = 0.0;
      for (int c = 0; c < 3; ++c) along += (start(v, c) - now(v, c)) * normals(v, c);
      sums.squares += along * along;
      sums.noise += (start(v, 3) - now(v, 3)) * (start(v, 3) - now(v, 3));
      sums.trace += start(v, 3) * now(v, 3);
    }
    return sums;
  };
  return parallel_reduce(start.rows(), Removed(), rows, [](const Removed& a, const Removed& b) {
    return Removed{a.squares + b.squares, a.noise + b.noise, a.trace + b.trace};
  });
}

}  // namespace

NoiseEstimate estimate_noise(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals,
                             const Progress& progress) {
  require_points(series, points, normals);
  const Index count = series.topology().vertex_count();
  const Values high = series.remainder(points, kPower, progress_within(progress, 0.0, 0.5));
  const Values unit = series.remainder(normal_numbers(count, 4), kPower, progress_within(progress, 0.5, 1.0));
  Buffer<double> found;
  Buffer<double> expected;
  NoiseEstimate estimate;
  for (Index v = 0; v < count; ++v) {
    if (!is_measured(series, v)) continue;
    ++estimate.vertices;
    found.push_back(std::abs(along_normal(high, normals, v)));
    for (int c = 0; c < 4; ++c) expected.push_back(std::abs(unit(v, c)));
  }
  if (estimate.vertices > 0) {
    const double of_unit = quantile(expected, 0.5);
    if (of_unit > 0.0) estimate.deviation = quantile(found, 0.5) / of_unit;
  }
  return estimate;
}

Values with_random_signs(ConstValuesRef points) {
  Values start(points.rows(), 4);
  std::mt19937_64 generator(kSeed);
  for (Eigen::Index v = 0; v < points.rows(); ++v)
    start.row(v) << points(v, 0), points(v, 1), points(v, 2), generator() % 2 ? 1.0 : -1.0;
  return start;
}

double expected_error(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals, double deviation,
                      const SmoothingChoice& choice, const Progress& progress) {
  require_points(series, points, normals);
  const Values start = with_random_signs(points);
  const Values now = series.smooth(start, choice.m, choice.passes, progress);
  const Removed removed = measure(series, start, now, normals, Where::Everywhere);
  const double variance = deviation * deviation;
  const auto count = static_cast<double>(std::max<Eigen::Index>(points.rows(), 1));
  return std::sqrt(std::max((removed.squares + 2.0 * variance * removed.trace) / count - variance, 0.0));
}

SmoothingChoice choose_smoothing(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals,
                                 double deviation, const Progress& progress) {
  require_points(series, points, normals);
  static constexpr int kStops[] = {1,  2,  3,  4,  5,  6,  8,   10,  12,  14,  16,  20,  24,  28,  32,
                                   40, 48, 56, 64, 80, 96, 128, 160, 200, 256, 320, 400, 512, 640, 800};
  constexpr int kWorseInARow = 3;  // after so many, no later choice is better
  const Index count = series.topology().vertex_count();
  Index measured = 0;
  for (Index v = 0; v < count; ++v) measured += is_measured(series, v) ? 1 : 0;
  SmoothingChoice best;
  best.expected_error = deviation;
  if (measured == 0 || !(deviation > 0.0)) return best;
  const Values start = with_random_signs(points);
  const double variance = deviation * deviation;
  double least = variance;
  for (int m = 2; m >= 0; --m) {
    Values now = start;
    int passes = 0;
    int worse = 0;
    double before = variance;
    for (const int stop : kStops) {
      const auto done = [&](int after) {
        return (2.0 - m + static_cast<double>(after) / kStops[std::size(kStops) - 1]) / 3.0;
      };
      now = series.smooth(now, m, stop - passes, progress_within(progress, done(passes), done(stop)));
      passes = stop;
      const Removed removed = measure(series, start, now, normals, Where::Measured);
      const double error = (removed.squares + 2.0 * variance * removed.trace) / measured - variance;
      if (error < least) {
        least = error;
        best = {m, passes, std::sqrt(removed.squares / measured), deviation * std::sqrt(removed.noise / measured),
                std::sqrt(std::max(error, 0.0))};
      }
      worse = error > before ? worse + 1 : 0;
      before = error;
      if (worse == kWorseInARow) break;
    }
  }
  return best;
}

}  // namespace batten
