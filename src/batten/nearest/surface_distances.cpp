#include "batten/nearest/surface_distances.h"

#include <cmath>

#include "batten/error.h"
#include "batten/nearest/surface_side.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"

namespace batten {

namespace {

[[noreturn]] void refuse_lengths() {
  throw Error(ErrorCode::NotFinite,
              "squares of lengths on the surface, or of distances from it, are too large for "
              "doubles; scale the points and the surface down");
}

}  // namespace

SurfaceDistances measure_distances(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                                   ConstValuesRef points, const Progress& progress) {
  constexpr double kCut = 0.1;  // of the time
  constexpr double kBuilt = 0.3;
  constexpr double kFound = 0.9;
  const SurfacePatches patches(topology, scheme, progress_within(progress, 0.0, kCut));
  const NearestPoints nearest(patches, control, progress_within(progress, kCut, kBuilt));
  SurfaceDistances measured;
  measured.diagonal = nearest.diagonal();
  measured.tolerance = nearest.tolerance();
  if (!std::isfinite(measured.diagonal)) refuse_lengths();
  measured.nearest.resize(static_cast<std::size_t>(points.rows()));
  nearest.nearest(points, measured.nearest, progress_within(progress, kBuilt, kFound));
  measured.closed = encloses_space(topology);
  measured.distances.resize(points.rows());
  const LimitSurface surface(patches, control);
  const auto sign_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const NearestPoint& found = measured.nearest[static_cast<std::size_t>(i)];
      const bool apart = found.distance > measured.tolerance;  // else the point is on the surface
      const Eigen::Vector3d query = points.row(i).transpose();
      const bool inside = measured.closed && apart && side_of(surface, query, found) == SurfaceSide::Inside;
      measured.distances[i] = inside ? -found.distance : found.distance;
    }
  };
  parallel_for(points.rows(), sign_block, kDefaultBlock, progress_within(progress, kFound, 1.0));
  if (!std::isfinite(measured.distances.squaredNorm())) refuse_lengths();
  return measured;
}

}  // namespace batten
