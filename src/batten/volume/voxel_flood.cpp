#include "batten/volume/voxel_flood.h"

#include <algorithm>

namespace batten {

VoxelFlags largest_piece(const VolumeGrid& grid, const VoxelFlags& flags) {
  Buffer<Index> marks(flags.size(), 0);
  Index pieces = 0;
  Index best = 0;
  std::ptrdiff_t most = 0;
  for (std::ptrdiff_t i = 0; i < grid.count(); ++i) {
    const auto count = flood(
        grid, i, [&](std::ptrdiff_t voxel) { return flags[voxel] != 0; }, pieces + 1, marks);
    if (count > 0) ++pieces;
    if (count <= most) continue;
    most = count;
    best = pieces;
  }
  VoxelFlags piece(flags.size());
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = most > 0 && marks[i] == best ? 1 : 0;
  return piece;
}

VoxelFlags without_holes(const VolumeGrid& grid, const VoxelFlags& flags) {
  Buffer<Index> marks(flags.size(), 0);
  const auto open = [&](std::ptrdiff_t voxel) { return flags[voxel] == 0; };
  for (Index k = 0; k < grid.size[2]; ++k) {
    for (Index j = 0; j < grid.size[1]; ++j) {
      const bool inner = k > 0 && k + 1 < grid.size[2] && j > 0 && j + 1 < grid.size[1];
      const Index step = inner ? std::max<Index>(1, grid.size[0] - 1) : 1;
      for (Index i = 0; i < grid.size[0]; i += step) flood(grid, grid.voxel(i, j, k), open, 1, marks);
    }
  }
  VoxelFlags filled(flags.size());
  for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = marks[i] == 0 ? 1 : 0;
  return filled;
}

std::ptrdiff_t count_of(const VoxelFlags& flags) { return std::count(flags.begin(), flags.end(), 1); }

}  // namespace batten
