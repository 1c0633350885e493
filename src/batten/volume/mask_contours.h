/// \file The border of a mask in some of its slices, as points.
#pragma once
#include "batten/volume/volume.h"

namespace batten {

/// Contours, as one would draw them by hand in every n-th slice.
struct MaskContours {
  Points points;         ///< P-by-3: the middles of the faces between voxels of a slice, in the world, slice by slice
  int axis = 2;          ///< the slices lie across this index
  bool painted = false;  ///< the mask has voxels in these slices only, none of which lie side by side
};

/// The border of a mask (label_mask()) in every n-th slice, from the first one that has voxels on, or from `first`
/// slices after it. Slices lie across the index along which the mask is painted in slices that are apart, if there is
/// one, and across the last index otherwise; of painted slices every n-th is taken. every: 1 or more. first: 0 or more.
/// Throws Error(BadArgument) where these are fewer than two slices. O(voxels).
MaskContours mask_contours(const Volume& mask, Index every = 1, Index first = 0);

}  // namespace batten
