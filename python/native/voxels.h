/// \file Volumes as NumPy arrays: value [i, j, k] of voxel (i, j, k), and a matrix from (i, j, k, 1) to the world.
#pragma once
#include <utility>

#include "batten/volume/volume.h"
#include "native/arrays.h"

namespace batten::python {

/// Floats whose first index runs fastest, as in Volume: the array itself where it is that already, else a copy.
using Voxels = py::array_t<float, py::array::f_style | py::array::forcecast>;

/// affine: (4, 4), millimetres in RAS. Throws Error(BadShape).
inline VolumeGrid grid_of(const std::array<Index, 3>& size, const Doubles& affine) {
  const Eigen::Map<const Values> rows = rows_of(affine, "an affine matrix");
  if (rows.rows() != 4 || rows.cols() != 4)
    throw Error(ErrorCode::BadShape, "an affine matrix must be an array of shape (4, 4)");
  VolumeGrid grid;
  grid.size = size;
  grid.axes = rows.topLeftCorner<3, 3>();
  grid.origin = rows.topRightCorner<3, 1>();
  return grid;
}

/// Throws Error(BadShape, TooLarge).
inline Volume volume_of(const Voxels& values, const Doubles& affine) {
  if (values.ndim() != 3) {
    throw Error(ErrorCode::BadShape,
                "a volume must be an array of three dimensions, not of " + std::to_string(values.ndim()));
  }
  std::array<Index, 3> size{};
  for (int c = 0; c < 3; ++c) {
    if (values.shape(c) > std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "a volume of 2^31 voxels or more: crop it or make it coarser");
    size[c] = static_cast<Index>(values.shape(c));
  }
  return {grid_of(size, affine), Buffer<float>(values.data(), values.data() + values.size())};
}

/// The numbers without a copy, and the matrix.
inline py::tuple arrays_of(Volume&& volume) {
  const VolumeGrid& grid = volume.grid;
  Values affine = Values::Identity(4, 4);
  affine.topLeftCorner<3, 3>() = grid.axes;
  affine.topRightCorner<3, 1>() = grid.origin;
  const std::vector<py::ssize_t> shape{grid.size[2], grid.size[1], grid.size[0]};
  return py::make_tuple(array_over<float>(std::move(volume.values), shape).attr("transpose")(),
                        array_of(std::move(affine)));
}

}  // namespace batten::python
