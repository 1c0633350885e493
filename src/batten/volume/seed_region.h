/// \file The part of an image around a seed, as a mask to start from.
#pragma once
#include <optional>

#include "batten/progress.h"
#include "batten/volume/volume.h"

namespace batten {

/// Numbers from `low` to `high`.
struct NumberRange {
  double low = 0.0;
  double high = 0.0;
};

/// Options of seed_region().
struct SeedOptions {
  std::optional<NumberRange> range;  ///< of the image's numbers in the part: the region stays in it
};

/// What was found.
struct SeedRegion {
  Volume mask;          ///< as label_mask() gives
  double volume = 0.0;  ///< mm^3
  double edges = 0.0;   ///< |gradient| of the smoothed image under its border: the mean, per mm
  /// The share of its border, by area, that has no edge (less than a quarter of the mean): there it leaks.
  double open = 0.0;
  /// The mean |gradient| under the border once the region has grown twice as large, as a share of `edges`.
  double edges_beyond = 0.0;
};

/// A front inflates from the seed: slowly where the smoothed image's number differs from those around the seed, and at
/// edges. The regions that it has passed are nested; while they grow, the edges under their borders become stronger
/// until the front rests on edges everywhere, and weaker when it leaks through a gap. The first region is taken that
/// has stronger edges than all up to twice as large, and a third as strong ones as any at least. The box of voxels
/// that is looked at doubles, to 256 along a side, while the region touches its sides. Holes are filled. seed: in the
/// world, in the part. Throws Error(BadArgument) for a seed outside the image or whose number is not in the range, and
/// where no such region is found; what require_volume() throws; Cancelled. O(n log n) in the voxels of the box.
SeedRegion seed_region(const Volume& image, const Eigen::Vector3d& seed, const SeedOptions& options = {},
                       const Progress& progress = {});

}  // namespace batten
