/// \file What points in parallel slices enclose, as a mask to start from.
#pragma once
#include "batten/volume/point_slices.h"
#include "batten/volume/volume.h"

namespace batten {

/// Shape-based interpolation (Raya and Udupa 1990, key RU90): each slice is filled (volume/slice_regions.h), and
/// between slices the signed distances of regions that overlap go along a monotone cubic (Fritsch and Butland 1984, key
/// FB84) where the original has a line. Regions that overlap none move on to the nearest such one of the next slice, if
/// it is not farther away than the slices from each other: a thin part that lies flat. Another region that none of the
/// next slice overlaps ends in a cap: its distances grow with the square of the height, so that the cap is as high as
/// the mean of half the way to the next slice, and of what the slice before it predicts for a round end. The grid lies
/// along the slices. cells: of it along the longest side. points: those that find_slices() had. Throws
/// Error(BadArgument) where they enclose nothing or cells is not 8 to 256.
Volume slices_mask(const Points& points, const PointSlices& slices, Index cells = 96);

}  // namespace batten
