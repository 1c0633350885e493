/// \file A label of a volume: its voxels, and points on their border.
#pragma once
#include <string>
#include <vector>

#include "batten/fit/point_cloud.h"
#include "batten/volume/volume.h"

namespace batten {

/// 1 at the voxels that have one of the labels and 0 at others, in the smallest box around them and `margin` voxels on
/// each side, which may lie beyond the volume. labels: empty for all numbers but 0. Throws Error(BadArgument) naming
/// the labels that are there where no voxel has one of those asked for; what require_volume() throws.
Volume label_mask(const Volume& volume, const std::vector<double>& labels, Index margin = 4);

/// "71", or "0.5": a label in messages and names.
std::string label_text(double label);

/// The middles of the faces between voxels of a mask and others, in the world, with outward normals from the mask's
/// smoothed gradient. A surface through them has the centres of the mask's voxels inside and the others outside. The
/// mask must have a margin. along: so many points along each side of a face, evenly, instead of its middle. O(voxels).
PointCloud mask_border(const Volume& mask, Index along = 1);

/// How far two masks of 0 and 1 on one grid agree: twice the common voxels by the sum of both. Throws Error(BadShape).
double dice(const Volume& a, const Volume& b);

}  // namespace batten
