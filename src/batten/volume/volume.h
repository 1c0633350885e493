/// \file A three-dimensional image and where its voxels lie in the world.
///
/// World coordinates are millimetres in RAS: x grows to the patient's right, y to the front, z to the top. Files that
/// count in LPS (x to the left, y to the back) are turned when they are read.
#pragma once
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>

#include "batten/buffer.h"
#include "batten/mesh/mesh.h"
#include "batten/types.h"

namespace batten {

/// Which way the first two world axes point.
enum class WorldSpace {
  Ras,  ///< right, anterior, superior: NIfTI, FreeSurfer, GIFTI
  Lps   ///< left, posterior, superior: DICOM, ITK
};

/// The places of voxels. A voxel (i, j, k) has its centre at origin + axes * (i, j, k).
struct VolumeGrid {
  std::array<Index, 3> size{};                         ///< voxels along each index
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< column c: from a voxel to the next one along index c, mm
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< the centre of voxel (0, 0, 0), mm

  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(size[0]) * size[1] * size[2]; }
  std::ptrdiff_t voxel(Index i, Index j, Index k) const {
    return i + static_cast<std::ptrdiff_t>(size[0]) * (j + static_cast<std::ptrdiff_t>(size[1]) * k);
  }
  /// The distance of neighbours along an index, mm.
  double spacing(int axis) const { return axes.col(axis).norm(); }
  double voxel_volume() const { return std::abs(axes.determinant()); }
  Eigen::Vector3d to_world(const Eigen::Vector3d& index) const { return origin + axes * index; }

  /// P-by-3 indices, which need not be whole, from points in the world, and back.
  Points to_indices(const Points& world) const;
  Points to_worlds(const Points& indices) const;
};

/// Throws Error: BadShape (a size below 1), TooLarge (2^31 voxels or more), NotFinite, BadArgument (axes in a plane).
void require_grid(const VolumeGrid& grid);

/// Numbers at voxels; labels are whole numbers.
struct Volume {
  VolumeGrid grid;
  Buffer<float> values;  ///< i + size[0] * (j + size[1] * k)

  float at(Index i, Index j, Index k) const { return values[grid.voxel(i, j, k)]; }
};

/// Throws what require_grid() throws; BadShape, NotFinite naming a voxel.
void require_volume(const Volume& volume);

/// The box of voxels from `low` on.
Volume cropped(const Volume& volume, const std::array<Index, 3>& low, const std::array<Index, 3>& size);

/// The voxels in the box around points of the world and `margin` voxels on each side, as far as the volume reaches; one
/// voxel at least along each index.
Volume cropped_around(const Volume& volume, const Points& world, Index margin);

/// The number at a place given by indices, linear between voxels; places outside take that of the nearest place inside.
double interpolated(const Volume& volume, const Eigen::Vector3d& index);

/// Points in RAS as points in `space`, or back.
Points in_space(Points points, WorldSpace space);

/// A mesh in RAS as one in `space`, or back, with its attribute "normal".
Mesh in_space(Mesh mesh, WorldSpace space);

}  // namespace batten
