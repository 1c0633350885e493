#include "batten/expand/denoise.h"

#include "batten/error.h"
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
  if (options.features) {
    result.features = find_features(topology, points, options.feature_options, progress_within(progress, 0.0, 0.1));
    if (!result.features.empty()) {
      topology = with_creases(given, points, result.features, progress_within(progress, 0.1, 0.2));
    }
  }
  const Buffer<std::uint8_t> kept = options.keep_boundary ? boundary_marks(topology) : Buffer<std::uint8_t>();
  const MeshSeries series =
      make_series(topology, scheme, options.matrix, kept, points, progress_within(progress, 0.2, 0.3));
  const Values normals =
      limit_normals(topology, scheme, points, LimitMasks::Exact, progress_within(progress, 0.3, 0.4)).vertices;
  result.noise = estimate_noise(series, points, normals, progress_within(progress, 0.4, 0.5));
  result.smoothing.m = options.m;
  result.smoothing.passes = options.passes;
  if (options.automatic) {
    result.smoothing =
        choose_smoothing(series, points, normals, result.noise.deviation, progress_within(progress, 0.5, 0.8));
  }
  result.points =
      series.smooth(points, result.smoothing.m, result.smoothing.passes, progress_within(progress, 0.8, 0.95));
  const ComponentVolumes before = component_volumes(topology, points);
  result.closed_components = before.closed_count();
  result.volume_before = before.sum();
  if (options.keep_volume) result.scaled_components = restore_volumes(series, before, result.points);
  report_progress(progress, 0.97);
  result.volume_after = component_volumes(topology, result.points).sum();
  const Movement movement = measure_movement(points, result.points);
  result.moved = movement.rms;
  result.most_moved = movement.most;
  result.most_moved_vertex = movement.vertex;
  result.removed = measure_movement_along(normals, points, result.points);
  return result;
}

}  // namespace batten
