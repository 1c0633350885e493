/// \file Gaussian smoothing of volumes with a width of its own along each index.
#pragma once
#include "batten/volume/volume.h"

namespace batten {

/// Along each index by a Gaussian whose standard deviation is given in voxels, cut off at four of them; one below 0.05
/// does nothing. Beyond the volume its outermost voxels are repeated. O(voxels * sigmas), threaded; memory: the result
/// and a copy.
Volume gaussian_smoothed(Volume volume, const Eigen::Vector3d& sigmas);

}  // namespace batten
