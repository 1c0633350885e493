/// \file Smoothing and derivatives of volumes by Deriche's recursive filters, as Monga and Deriche join them in three
/// dimensions (key MDR91).
///
/// Along one index, with a = alpha times the spacing and whole numbers m of voxels, the kernels are
///
///     smoothing           k (a |m| + 1) exp(-a |m|)          sum of the kernel: 1
///     first derivative    k m exp(-a |m|)                    derivative of a line: its slope
///     second derivative   k (1 - c |m|) exp(-a |m|)          of a parabola: its curvature; of a line: 0
///
/// with k and c from sums over all whole m, so that they are exact for these polynomials at any spacing. Beyond the
/// volume its outermost voxels are repeated. A filter of a volume is the product of one of these along each index. The
/// smoothing is about as wide as a Gaussian of sigma = 2 / alpha.
#pragma once
#include <array>

#include "batten/volume/volume.h"

namespace batten {

/// What a filter does along an index.
enum class FilterOrder { None, Smooth, First, Second };

/// Filters along each index. alpha: 1/mm, positive; the larger, the less is smoothed. Derivatives are per mm along the
/// index. Two passes over the volume an index, in double, whatever alpha; threaded. Memory: the result. Throws
/// Error(BadArgument) and what require_volume() throws.
Volume filtered(const Volume& volume, const std::array<FilterOrder, 3>& orders, double alpha);

/// One component of the derivative along each index, as three volumes on one grid.
struct Gradient {
  VolumeGrid grid;
  std::array<Buffer<float>, 3> along;  ///< per mm along each index
};

/// The three first derivatives. Memory: three floats a voxel.
Gradient gradient(const Volume& volume, double alpha);

/// The derivative in the world, per mm, at a place given by indices; linear between voxels.
Eigen::Vector3d world_gradient(const Gradient& gradient, const Eigen::Vector3d& index);

/// |gradient|, per mm.
Volume edge_magnitude(const Gradient& gradient);

/// The magnitude where it is not less than one voxel's smallest spacing further along the gradient, either way; 0
/// elsewhere (non-maximum suppression).
Volume edge_maxima(const Gradient& gradient);

}  // namespace batten
