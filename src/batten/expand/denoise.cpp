#include "batten/expand/denoise.h"

#include <cmath>
#include <optional>

#include "batten/error.h"
#include "batten/expand/boundary.h"
#include "batten/expand/volume.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The topology with the sharp edges that were found as creases.
Topology with_creases(const Mesh& mesh, const std::vector<Crease>& found, const Progress& progress) {
  Mesh creased;
  creased.points = mesh.points;
  creased.face_offsets = mesh.face_offsets;
  creased.face_vertices = mesh.face_vertices;
  creased.creases = mesh.creases;
  creased.creases.insert(creased.creases.end(), found.begin(), found.end());
  creased.corners = mesh.corners;
  creased.holes = mesh.holes;
  return Topology(creased, progress);
}

/// Cotangents of noise would be noise; those of the mesh after some passes of the limit matrix are the shape's.
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

void measure_movement(ConstValuesRef before, ConstValuesRef normals, DenoiseResult& result) {
  struct Moved {
    double squares = 0.0;
    double along = 0.0;
    double most = 0.0;
    Index vertex = -1;
  };
  const auto rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Moved moved;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      double square = 0.0;
      double along = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double shift = result.points(v, c) - before(v, c);
        square += shift * shift;
        along += shift * normals(v, c);
      }
      moved.squares += square;
      moved.along += along * along;
      if (moved.vertex < 0 || square > moved.most) {
        moved.most = square;
        moved.vertex = static_cast<Index>(v);
      }
    }
    return moved;
  };
  const Moved all = parallel_reduce(before.rows(), Moved(), rows, [](const Moved& a, const Moved& b) {
    const Moved& most = b.vertex >= 0 && (a.vertex < 0 || b.most > a.most) ? b : a;
    return Moved{a.squares + b.squares, a.along + b.along, most.most, most.vertex};
  });
  const double count = std::max<double>(1.0, static_cast<double>(before.rows()));
  result.moved = std::sqrt(all.squares / count);
  result.removed = std::sqrt(all.along / count);
  result.most_moved = std::sqrt(all.most);
  result.most_moved_vertex = all.vertex;
}

}  // namespace

DenoiseResult denoise(const Mesh& mesh, const Scheme& scheme, const DenoiseOptions& options, const Progress& progress) {
  if (options.m < 0) throw Error(ErrorCode::BadArgument, "m must not be negative");
  if (options.passes < 0) throw Error(ErrorCode::BadArgument, "passes must not be negative");
  DenoiseResult result;
  std::optional<Topology> topology(std::in_place, mesh, progress_within(progress, 0.0, 0.1));
  if (options.features) {
    result.features =
        find_features(*topology, mesh.points, options.feature_options, progress_within(progress, 0.1, 0.15));
    if (!result.features.empty())
      topology.emplace(with_creases(mesh, result.features, progress_within(progress, 0.15, 0.2)));
  }
  const Buffer<std::uint8_t> kept = options.keep_boundary ? boundary_marks(*topology) : Buffer<std::uint8_t>();
  const MeshSeries series =
      make_series(*topology, scheme, options.matrix, kept, mesh.points, progress_within(progress, 0.2, 0.3));
  const Values normals =
      limit_normals(*topology, scheme, mesh.points, LimitMasks::Exact, progress_within(progress, 0.3, 0.4)).vertices;
  result.noise = estimate_noise(series, mesh.points, normals, progress_within(progress, 0.4, 0.5));
  result.smoothing.m = options.m;
  result.smoothing.passes = options.passes;
  if (options.automatic) {
    result.smoothing =
        choose_smoothing(series, mesh.points, normals, result.noise.deviation, progress_within(progress, 0.5, 0.8));
  }
  result.points =
      series.smooth(mesh.points, result.smoothing.m, result.smoothing.passes, progress_within(progress, 0.8, 0.95));
  const ComponentVolumes before = component_volumes(*topology, mesh.points);
  result.closed_components = before.closed_count();
  result.volume_before = before.sum();
  if (options.keep_volume) result.scaled_components = restore_volumes(series, before, result.points);
  report_progress(progress, 0.97);
  result.volume_after = component_volumes(*topology, result.points).sum();
  measure_movement(mesh.points, normals, result);
  return result;
}

}  // namespace batten
