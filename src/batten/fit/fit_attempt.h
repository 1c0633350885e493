/// \file A fit of the points that rounds work with, whatever it starts from.
#pragma once
#include <cstdint>

#include "batten/fit/fit_surface.h"
#include "batten/fit/outliers.h"
#include "batten/fit/surface_fitter.h"

namespace batten {

/// What came of it.
struct FitAttempt {
  SurfaceFitter fitter;                ///< attached
  FitReport report = {};               ///< rounds, the diameter and the end
  Buffer<std::uint8_t> outliers = {};  ///< one flag a point
  double rms = 0.0;                    ///< of the points that are no outliers, as a share of the diameter
  bool evened_out = false;             ///< the surface was made sound at the cost of distances
};

/// Makes all rounds. cloud: with normals or without, no two points at the same place, in an order that depends on their
/// places alone; filter: of these points; diameter: of the whole cloud. Where
/// there are lonely points, others may be outliers near the surface: these are sought before. Creases that were found
/// under Catmull-Clark stay only where the first rounds come nearer to the points with them than without: the edges of
/// quads may not follow the sharp edges of few points. Loop's moves have judged them one by one. Where the
/// surface is sound only evened out, two other first meshes, of slightly fewer control points, are tried. When progress
/// asks to stop after the first round, what has been reached is returned. Throws as fit_surface().
FitAttempt make_fit(const PointCloud& cloud, const FitOptions& options, const OutlierFilter& filter, double diameter,
                    const Progress& progress);

}  // namespace batten
