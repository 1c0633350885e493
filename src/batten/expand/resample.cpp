#include "batten/expand/resample.h"

#include <vector>

#include "batten/error.h"
#include "batten/interpolate/interpolator.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/self_intersections.h"
#include "batten/progress.h"

namespace batten {

Resampled resample(const Topology& source, const Scheme& source_scheme, ConstValuesRef source_control,
                   const Topology& target, const Scheme& target_scheme, ConstValuesRef target_control, double reach,
                   const Progress& progress) {
  constexpr double kBuilt = 0.3;  // of the time
  constexpr double kFound = 0.9;
  const Values limit = LimitMatrix(source, source_scheme).apply(source_control);
  const NearestPoints nearest(target, target_scheme, target_control, progress_within(progress, 0.0, kBuilt));
  std::vector<NearestPoint> found(static_cast<std::size_t>(limit.rows()));
  nearest.nearest(limit, found, progress_within(progress, kBuilt, kFound));
  Resampled result;
  Values places(limit.rows(), 3);
  for (Index v = 0; v < static_cast<Index>(limit.rows()); ++v) {
    const NearestPoint& point = found[static_cast<std::size_t>(v)];
    places.row(v) = point.point.transpose();
    result.mean_distance += point.distance / static_cast<double>(limit.rows());
    if (point.distance <= result.max_distance) continue;
    result.max_distance = point.distance;
    result.farthest_vertex = v;
  }
  if (result.max_distance > reach * nearest.diagonal()) {
    throw Error(ErrorCode::BadArgument,
                "vertex " + std::to_string(result.farthest_vertex) + " lies " + std::to_string(result.max_distance) +
                    " from the other surface, " + std::to_string(result.max_distance / nearest.diagonal()) +
                    " of its diagonal: only surfaces that lie close to each other can be resampled so; move or scale "
                    "the one onto the other first");
  }
  result.folded_faces = count_turned_faces(source, limit, places);
  InterpolateOptions options;
  options.on_singular = OnSingular::LeastSquares;
  Interpolant interpolant =
      Interpolator(source, source_scheme, options).solve(places, progress_within(progress, kFound, 1.0));
  result.control = std::move(interpolant.control);
  result.max_error = interpolant.report.max_error;
  return result;
}

}  // namespace batten
