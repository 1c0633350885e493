#include "batten/expand/denoise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/expand/crease_corners.h"
#include "batten/expand/movement.h"
#include "batten/expand/point_series.h"
#include "batten/expand/volume.h"
#include "batten/progress.h"

namespace batten {

namespace {

/// The topology with the sharp edges that were found as creases.
Topology with_creases(const Topology& topology, ConstValuesRef points, const std::vector<Crease>& found,
                      const Progress& progress) {
  Mesh creased = mesh_from_topology(topology);
  creased.points = points;
  creased.creases.insert(creased.creases.end(), found.begin(), found.end());
  return Topology(creased, progress);
}

/// Cotangents of the noisy shape would themselves be noisy. They are taken from the mesh after some passes of the limit
/// matrix.
MeshSeries make_series(const Topology& topology, const Scheme& scheme, SeriesMatrix matrix,
                       const Buffer<std::uint8_t>& kept, ConstValuesRef points, const Progress& progress) {
  constexpr int kPasses = 8;
  SeriesOptions options;
  options.kept = kept;
  if (matrix == SeriesMatrix::Limit) return {topology, scheme, options, progress};
  options.shape = MeshSeries(topology, scheme, options, progress_within(progress, 0.0, 0.3))
                      .smooth(points, 2, kPasses, progress_within(progress, 0.3, 0.6));
  options.matrix = matrix;
  return {topology, scheme, options, progress_within(progress, 0.6, 1.0)};
}

/// A mesh on its way through the smoothing.
struct Smoothing {
  MeshSeries series;
  Values normals;
  NoiseEstimate noise;
  SmoothingChoice choice;
  Points points;
};

Smoothing smooth(const Topology& topology, const Scheme& scheme, ConstValuesRef points, const DenoiseOptions& options,
                 const Progress& progress) {
  const Buffer<std::uint8_t> kept = options.keep_boundary ? boundary_marks(topology) : Buffer<std::uint8_t>();
  Smoothing work{
      make_series(topology, scheme, options.matrix, kept, points, progress_within(progress, 0.0, 0.1)),
      limit_normals(topology, scheme, points, LimitMasks::Exact, progress_within(progress, 0.1, 0.2)).vertices,
      {},
      {},
      Points(0, 3)};
  work.noise = estimate_noise(work.series, points, work.normals, progress_within(progress, 0.2, 0.3));
  work.choice.m = options.m;
  work.choice.passes = options.passes;
  if (options.automatic) {
    work.choice =
        choose_smoothing(work.series, points, work.normals, work.noise.deviation, progress_within(progress, 0.3, 0.8));
  }
  work.points = work.series.smooth(points, work.choice.m, work.choice.passes, progress_within(progress, 0.8, 1.0));
  return work;
}

/// Corners keep their position in the smoothing, with its noise. They go where the smoothed sides around them meet, and
/// the rest is smoothed again from there. held: where corners are along their sides.
void settle_corners(const Topology& given, const Topology& creased, ConstValuesRef points, ConstValuesRef held,
                    Smoothing& work, const Progress& progress) {
  constexpr double kFarthest = 5.0;  // of the noise's standard deviation
  const std::vector<Index> corners = found_corners(given, creased);
  if (corners.empty()) return;
  Points start = points;
  start(corners, Eigen::all) =
      corner_places(creased, corners, work.points, points, held, kFarthest * work.noise.deviation);
  work.points = work.series.smooth(start, work.choice.m, work.choice.passes, progress);
}

/// Where a sharp edge was not found, the smoothing that suits the edges that were goes too far. Vertices that it moves
/// farther along their normals than noise explains, and farther than the smoothing without edges does, go where that
/// takes them.
void keep_plausible(ConstValuesRef points, const Smoothing& plain, Smoothing& work) {
  constexpr double kPlausible = 2.5;  // of the noise's standard deviation
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Eigen::RowVector3d normal = plain.normals.row(v);
    const double moved = std::abs(normal.dot(work.points.row(v) - points.row(v)));
    const double without = std::abs(normal.dot(plain.points.row(v) - points.row(v)));
    if (moved > std::max(kPlausible * plain.noise.deviation, without)) work.points.row(v) = plain.points.row(v);
  }
}

/// Smooths along the sharp edges that were found, unless they are so many or so wrong that the error to expect is
/// smaller without them. Returns the topology of the smoothing in `work`.
Topology smooth_along(const Topology& given, const Scheme& scheme, ConstValuesRef points, const DenoiseOptions& options,
                      DenoiseResult& result, std::optional<Smoothing>& work, const Progress& progress) {
  // The edges were chosen by the noise that is to be removed, which makes the estimate for them too small.
  constexpr double kClearGain = 0.9;
  const Topology creased = with_creases(given, points, result.features, progress_within(progress, 0.0, 0.1));
  work.emplace(smooth(creased, scheme, points, options, progress_within(progress, 0.1, 0.5)));
  if (!options.automatic || given.vertex_count() < kFewestForNoise) {
    settle_corners(given, creased, points, points, *work, progress_within(progress, 0.5, 1.0));
    return creased;
  }
  Smoothing plain = smooth(given, scheme, points, options, progress_within(progress, 0.5, 0.8));
  settle_corners(given, creased, points, plain.points, *work, progress_within(progress, 0.8, 0.9));
  const auto error_of = [&](const Smoothing& one, double begin, double end) {
    return expected_error(one.series, points, plain.normals, plain.noise.deviation, one.choice,
                          progress_within(progress, begin, end));
  };
  const double error_along = error_of(*work, 0.9, 0.95);
  if (error_along <= kClearGain * error_of(plain, 0.95, 1.0)) {
    keep_plausible(points, plain, *work);
    return creased;
  }
  result.features_left_out = static_cast<Index>(result.features.size());
  result.features.clear();
  work.emplace(std::move(plain));
  return given;
}

}  // namespace

DenoiseResult denoise(const Mesh& mesh, const Scheme& scheme, const DenoiseOptions& options, const Progress& progress) {
  const Topology topology(mesh, progress_within(progress, 0.0, 0.1));
  return denoise(topology, scheme, mesh.points, options, progress_within(progress, 0.1, 1.0));
}

DenoiseResult denoise(const Topology& given, const Scheme& scheme, ConstValuesRef points, const DenoiseOptions& options,
                      const Progress& progress) {
  if (options.m < 0) throw Error(ErrorCode::BadArgument, "m must not be negative");
  if (options.passes < 0) throw Error(ErrorCode::BadArgument, "passes must not be negative");
  DenoiseResult result;
  Topology topology = given;
  std::optional<Smoothing> work;
  if (options.features) {
    result.features = find_features(topology, points, options.feature_options, progress_within(progress, 0.0, 0.2));
  }
  if (result.features.empty()) {
    work.emplace(smooth(topology, scheme, points, options, progress_within(progress, 0.2, 0.95)));
  } else {
    topology = smooth_along(given, scheme, points, options, result, work, progress_within(progress, 0.2, 0.95));
  }
  result.noise = work->noise;
  result.smoothing = work->choice;
  result.points = std::move(work->points);
  const ComponentVolumes before = component_volumes(topology, points);
  result.closed_components = before.closed_count();
  result.volume_before = before.sum();
  if (options.keep_volume) result.scaled_components = restore_volumes(work->series, before, result.points);
  report_progress(progress, 0.97);
  result.volume_after = component_volumes(topology, result.points).sum();
  const Movement movement = measure_movement(points, result.points);
  result.moved = movement.rms;
  result.most_moved = movement.most;
  result.most_moved_vertex = movement.vertex;
  result.removed = measure_movement_along(work->normals, points, result.points);
  return result;
}

}  // namespace batten
