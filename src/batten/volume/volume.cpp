#include "batten/volume/volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

Points VolumeGrid::to_indices(const Points& world) const {
  const Eigen::Matrix3d inverse = axes.inverse();
  return (world.rowwise() - origin.transpose()) * inverse.transpose();
}

Points VolumeGrid::to_worlds(const Points& indices) const {
  return (indices * axes.transpose()).rowwise() + origin.transpose();
}

void require_grid(const VolumeGrid& grid) {
  constexpr double kFlat = 1e-9;
  double count = 1.0;
  for (const Index size : grid.size) {
    if (size < 1) throw Error(ErrorCode::BadShape, "a volume has a voxel or more along each index");
    count *= size;
  }
  if (count > std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge, "a volume of 2^31 voxels or more: crop it or make it coarser");
  if (!grid.axes.allFinite() || !grid.origin.allFinite())
    throw Error(ErrorCode::NotFinite, "the place of a volume is not finite");
  const double edges = grid.spacing(0) * grid.spacing(1) * grid.spacing(2);
  if (!(grid.voxel_volume() > kFlat * edges))
    throw Error(ErrorCode::BadArgument, "the axes of a volume lie in a plane, or a spacing is 0");
}

void require_volume(const Volume& volume) {
  require_grid(volume.grid);
  if (static_cast<std::ptrdiff_t>(volume.values.size()) != volume.grid.count())
    throw Error(ErrorCode::BadShape, "there are " + std::to_string(volume.values.size()) + " numbers for " +
                                         std::to_string(volume.grid.count()) + " voxels");
  const auto first = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      if (!std::isfinite(volume.values[i])) return i;
    }
    return std::numeric_limits<std::ptrdiff_t>::max();
  };
  const auto bad = parallel_reduce(
      volume.grid.count(), std::numeric_limits<std::ptrdiff_t>::max(), first,
      [](std::ptrdiff_t a, std::ptrdiff_t b) { return std::min(a, b); }, 65536);
  if (bad == std::numeric_limits<std::ptrdiff_t>::max()) return;
  const std::ptrdiff_t row = bad / volume.grid.size[0];
  throw Error(ErrorCode::NotFinite, "voxel (" + std::to_string(bad % volume.grid.size[0]) + ", " +
                                        std::to_string(row % volume.grid.size[1]) + ", " +
                                        std::to_string(row / volume.grid.size[1]) + ") is not a finite number");
}

Volume cropped(const Volume& volume, const std::array<Index, 3>& low, const std::array<Index, 3>& size) {
  for (int c = 0; c < 3; ++c) {
    if (low[c] < 0 || size[c] < 1 || low[c] > volume.grid.size[c] - size[c])
      throw Error(ErrorCode::BadArgument, "the box to crop does not lie inside the volume");
  }
  Volume part;
  part.grid = volume.grid;
  part.grid.size = size;
  part.grid.origin = volume.grid.to_world(Eigen::Vector3d(low[0], low[1], low[2]));
  part.values.resize(static_cast<std::size_t>(part.grid.count()));
  parallel_for_each(size[2], [&](std::ptrdiff_t k) {
    for (Index j = 0; j < size[1]; ++j) {
      const float* from = &volume.values[volume.grid.voxel(low[0], low[1] + j, low[2] + static_cast<Index>(k))];
      std::copy(from, from + size[0], &part.values[part.grid.voxel(0, j, static_cast<Index>(k))]);
    }
  });
  return part;
}

Volume cropped_around(const Volume& volume, const Points& world, Index margin) {
  const Points indices = volume.grid.to_indices(world);
  std::array<Index, 3> low{};
  std::array<Index, 3> size{};
  for (int c = 0; c < 3; ++c) {
    const double last = volume.grid.size[c] - 1.0;
    low[c] = static_cast<Index>(std::clamp(std::floor(indices.col(c).minCoeff()) - margin, 0.0, last));
    size[c] = static_cast<Index>(std::clamp(std::ceil(indices.col(c).maxCoeff()) + margin, 0.0, last)) - low[c] + 1;
  }
  return cropped(volume, low, size);
}

double interpolated(const Volume& volume, const Eigen::Vector3d& index) {
  std::array<Index, 3> low{};
  std::array<Index, 3> high{};
  std::array<double, 3> share{};
  for (int c = 0; c < 3; ++c) {
    const double place = std::clamp(index[c], 0.0, volume.grid.size[c] - 1.0);
    low[c] = static_cast<Index>(place);
    high[c] = std::min(low[c] + 1, volume.grid.size[c] - 1);
    share[c] = place - low[c];
  }
  const auto along = [&](Index j, Index k) {
    return (1.0 - share[0]) * volume.at(low[0], j, k) + share[0] * volume.at(high[0], j, k);
  };
  const auto across = [&](Index k) { return (1.0 - share[1]) * along(low[1], k) + share[1] * along(high[1], k); };
  return (1.0 - share[2]) * across(low[2]) + share[2] * across(high[2]);
}

Points in_space(Points points, WorldSpace space) {
  if (space == WorldSpace::Lps) points.leftCols(2) *= -1.0;
  return points;
}

Mesh in_space(Mesh mesh, WorldSpace space) {
  mesh.points = in_space(std::move(mesh.points), space);
  for (Attribute& attribute : mesh.attributes) {
    if (attribute.name == "normal" && space == WorldSpace::Lps) attribute.values.leftCols(2) *= -1.0;
  }
  return mesh;
}

}  // namespace batten
