/// \file What part of each voxel lies inside a closed mesh.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/volume/volume.h"

namespace batten {

/// What counts of a voxel.
enum class VoxelRule {
  Centre,  ///< 1 where the centre is inside, else 0
  Part     ///< the share of the voxel that is inside, from 0 to 1
};

/// Parts are exact for the mesh, by clipping its triangles at voxels. How often the mesh winds around a place counts,
/// so that what overlaps counts twice. mesh: closed, outwards, in the world; of a subdivision surface a fine mesh.
/// O(pieces of triangles in voxels), threaded. Throws Error: what require_grid() and Topology throw; BadArgument for an
/// open mesh.
Volume inside_volume(const Mesh& mesh, const VolumeGrid& grid, VoxelRule rule);

}  // namespace batten
