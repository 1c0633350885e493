#include "batten/dynamics/force.h"

#include <algorithm>

#include "batten/refine/refined_rows.h"
#include "batten/surface/surface_weights.h"

namespace batten {

PlaceRows place_rows(const SurfacePatches& patches, std::span<const SurfacePlace> places) {
  PlaceRows result;
  result.rows = SurfaceWeights(patches).rows(places);
  result.transposed = result.rows.transpose();
  return result;
}

PlaceRows first_step_rows(const SurfacePatches& patches) {
  const SparseRows rows = refined_rows(patches.topology(), patches.scheme());
  PlaceRows result;
  result.rows.resize(rows.count(), patches.topology().vertex_count());
  result.rows.resizeNonZeros(static_cast<Eigen::Index>(rows.columns.size()));
  std::copy(rows.starts.begin(), rows.starts.end(), result.rows.outerIndexPtr());
  std::copy(rows.columns.begin(), rows.columns.end(), result.rows.innerIndexPtr());
  std::copy(rows.weights.begin(), rows.weights.end(), result.rows.valuePtr());
  result.transposed = result.rows.transpose();
  return result;
}

/// Where the base is a first refinement, it is what the refined mesh is.
SurfacePlace place_on_refined(const SurfacePatches& patches, const SurfacePlace& place) {
  return patches.has_first_step() ? place : refined_place(patches.base(), place);
}

void turn_into_forces(const PlaceSprings& springs, Values& stretch) {
  const Points& directions = springs.directions;
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    if (directions.row(i).isZero(0.0)) continue;
    stretch.row(i) = directions.row(i).dot(stretch.row(i).head<3>()) * directions.row(i);
  }
  stretch.array().colwise() *= springs.stiffness.array();
}

}  // namespace batten
