/// \file The regions that points in a plane enclose.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "batten/types.h"
#include "batten/volume/voxel_flood.h"

namespace batten {

/// A region of a plane whose places are joined to each other.
struct SliceRegion {
  VoxelFlags inside;
  Buffer<float> distances;                           ///< mm, to its border: less than 0 inside
  double depth = 0.0;                                ///< the greatest distance inside
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< the mean of its places, in cells
};

/// Distances along contours between neighbouring points, in some planes: from each point to the nearest one, and to the
/// nearest one on its other side (as in NN-crust, Dey and Kumar 1999, key DK99), the greater of both. Points of a plane
/// have one z. Those that have no neighbour to one side count for nothing.
std::vector<double> contour_gaps(const std::vector<Points>& planes);

/// What the contours around points enclose: a disk that rolls around them does not pass between two points that are
/// less than its diameter apart. Behind one contour is inside, behind two outside again, and so on. Between points the
/// border is where disks on both sides come equally near. points: of one z, in the grid, which has a margin of two
/// radii around them and squares as cells.
VoxelFlags enclosed_in_plane(const VolumeGrid& grid, const Points& points, double radius);

/// To the border of flags: less than 0 where they are set.
Buffer<float> signed_distances(const VolumeGrid& grid, const VoxelFlags& inside);

/// Each joined part of the flags.
std::vector<SliceRegion> slice_regions(const VolumeGrid& grid, const VoxelFlags& inside);

}  // namespace batten
