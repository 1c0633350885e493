/// \file Distances between a fitted surface and the points, both ways.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/fit/surface_fitter.h"
#include "batten/nearest/distance_summary.h"

namespace batten {

/// From places spread over the surface to the nearest points.
DistanceSummary measure_to_points(const SurfaceFitter& fitter);

/// Of other points to the surface.
Scalars measure_to_surface(const SurfaceFitter& fitter, const Points& points);

/// Of the points that are no outliers; `left_out` becomes the number of the others.
DistanceSummary summarize_followed(const Scalars& distances, const Buffer<std::uint8_t>& outliers, Index& left_out);

}  // namespace batten
