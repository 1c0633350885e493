#include "batten/expand/sharpen.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/expand/movement.h"
#include "batten/expand/point_series.h"
#include "batten/progress.h"

namespace batten {

namespace {

void require_sense(const SharpenOptions& options) {
  if (options.m < 1 || options.n < options.m) throw Error(ErrorCode::BadArgument, "sharpening needs 1 <= m <= n");
  if (options.passes < 0) throw Error(ErrorCode::BadArgument, "passes must not be negative");
  if (!(options.amount >= 0.0)) throw Error(ErrorCode::BadArgument, "the amount must not be negative");
  if (!(options.most_growth >= 1.0))
    throw Error(ErrorCode::BadArgument, "the largest growth must be 1 or more: to smooth, denoise");
}

}  // namespace

SharpenResult sharpen(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                      const SharpenOptions& options, const Progress& progress) {
  require_sense(options);
  require_vertex_rows(topology, points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "sharpening needs points of three columns");
  SharpenResult result;
  const double powers = options.n - options.m + 1.0;
  const int passes = std::max(options.passes, 1);
  result.amount = std::min(options.amount, (std::pow(options.most_growth, 1.0 / passes) - 1.0) / powers);
  result.growth = std::pow(1.0 + result.amount * powers, options.passes);
  const MeshSeries series(topology, scheme, series_of_points(options.matrix, options.keep_boundary, topology, points),
                          progress_within(progress, 0.0, 0.3));
  std::vector<double> coefficients(static_cast<std::size_t>(options.n) + 1, 0.0);
  coefficients[0] = 1.0;
  for (int i = options.m; i <= options.n; ++i) coefficients[i] = result.amount;
  result.points = series.polynomial(points, coefficients, options.passes, progress_within(progress, 0.3, 0.5));
  const Movement movement = measure_movement(points, result.points);
  result.moved = movement.rms;
  result.most_moved = movement.most;
  result.most_moved_vertex = movement.vertex;
  if (options.check) {
    result.before = find_self_intersections(topology, points, progress_within(progress, 0.5, 0.75));
    result.after = find_self_intersections(topology, result.points, progress_within(progress, 0.75, 1.0));
    result.turned_faces = count_turned_faces(topology, points, result.points);
  }
  return result;
}

}  // namespace batten
