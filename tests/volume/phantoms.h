/// \file Volumes of known shapes for the tests of volumes.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "batten/volume/volume.h"

namespace batten::test {

/// A grid of cubes of this size, centred on the origin.
inline VolumeGrid centred_grid(Index size, double spacing = 1.0) {
  VolumeGrid grid;
  grid.size = {size, size, size};
  grid.axes *= spacing;
  grid.origin.setConstant(-0.5 * spacing * (size - 1));
  return grid;
}

/// value(place in the world) at each voxel.
template <typename Value>
Volume made_volume(const VolumeGrid& grid, const Value& value) {
  Volume volume;
  volume.grid = grid;
  volume.values.resize(static_cast<std::size_t>(grid.count()));
  for (Index k = 0; k < grid.size[2]; ++k) {
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i)
        volume.values[grid.voxel(i, j, k)] = static_cast<float>(value(grid.to_world(Eigen::Vector3d(i, j, k))));
    }
  }
  return volume;
}

/// 1 inside a bent ball without any symmetry, 0 outside.
inline double bean(const Eigen::Vector3d& at) {
  const Eigen::Vector3d bent(at[0] - 0.02 * at[1] * at[1], at[1], 1.4 * at[2] + 0.1 * at[0]);
  return bent.norm() < 9.0 ? 1.0 : 0.0;
}

/// The same numbers at the same places of the world, where index c runs along index order[c] of the given volume, back
/// where flipped[c].
inline Volume rearranged(const Volume& volume, const std::array<int, 3>& order, const std::array<bool, 3>& flipped) {
  Volume result;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    result.grid.size[c] = volume.grid.size[order[c]];
    result.grid.axes.col(c) = (flipped[c] ? -1.0 : 1.0) * volume.grid.axes.col(order[c]);
    if (flipped[c]) first[order[c]] = volume.grid.size[order[c]] - 1.0;
  }
  result.grid.origin = volume.grid.to_world(first);
  result.values.resize(volume.values.size());
  for (Index k = 0; k < result.grid.size[2]; ++k) {
    for (Index j = 0; j < result.grid.size[1]; ++j) {
      for (Index i = 0; i < result.grid.size[0]; ++i) {
        const std::array<Index, 3> at{i, j, k};
        std::array<Index, 3> from{};
        for (int c = 0; c < 3; ++c) from[order[c]] = flipped[c] ? result.grid.size[c] - 1 - at[c] : at[c];
        result.values[result.grid.voxel(i, j, k)] = volume.at(from[0], from[1], from[2]);
      }
    }
  }
  return result;
}

}  // namespace batten::test
