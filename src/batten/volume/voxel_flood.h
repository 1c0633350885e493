/// \file Voxels that are joined to each other through their faces.
#pragma once
#include <vector>

#include "batten/volume/volume.h"

namespace batten {

/// One flag a voxel: 0 or 1.
using VoxelFlags = Buffer<std::uint8_t>;

/// Calls visit for the voxels beside one that share a face with it.
template <typename Visit>
void for_each_beside(const VolumeGrid& grid, std::ptrdiff_t voxel, const Visit& visit) {
  const std::ptrdiff_t row = grid.size[0];
  const std::ptrdiff_t slice = row * grid.size[1];
  if (voxel % row > 0) visit(voxel - 1);
  if (voxel % row < row - 1) visit(voxel + 1);
  if (voxel % slice >= row) visit(voxel - row);
  if (voxel % slice < slice - row) visit(voxel + row);
  if (voxel >= slice) visit(voxel - slice);
  if (voxel < grid.count() - slice) visit(voxel + slice);
}

/// Gives `mark` to the voxels joined to `start` by voxels that are `open` and have no mark yet; returns how many.
template <typename Open>
std::ptrdiff_t flood(const VolumeGrid& grid, std::ptrdiff_t start, const Open& open, Index mark, Buffer<Index>& marks) {
  if (marks[start] != 0 || !open(start)) return 0;
  std::vector<std::ptrdiff_t> waiting{start};
  marks[start] = mark;
  std::ptrdiff_t count = 0;
  while (!waiting.empty()) {
    const std::ptrdiff_t voxel = waiting.back();
    waiting.pop_back();
    ++count;
    for_each_beside(grid, voxel, [&](std::ptrdiff_t next) {
      if (marks[next] != 0 || !open(next)) return;
      marks[next] = mark;
      waiting.push_back(next);
    });
  }
  return count;
}

/// The largest piece of joined voxels alone.
VoxelFlags largest_piece(const VolumeGrid& grid, const VoxelFlags& flags);

/// With the holes: voxels from which no way through unflagged ones leads to the grid's border.
VoxelFlags without_holes(const VolumeGrid& grid, const VoxelFlags& flags);

/// How many flags are set.
std::ptrdiff_t count_of(const VoxelFlags& flags);

}  // namespace batten
