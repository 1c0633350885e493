/// \file Bytes to small clouds of points, for the fuzz targets of first meshes and fits.
#pragma once
#include <cstddef>
#include <cstdint>

#include "batten/fit/point_cloud.h"

namespace batten::fuzz {

/// Takes byte after byte; zeros where there are no more.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  int take() { return at_ < size_ ? data_[at_++] : 0; }
  std::size_t left() const { return size_ - at_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

/// A cloud of what is left of the bytes, three points of three bytes and no more than `most` such triples. The upper
/// four bits of `kind` choose a grid, a ball, a ring or a plane that most points lie on, whether there are normals, and
/// whether a byte before the points chooses a scale.
PointCloud few_points(int kind, Bytes& bytes, std::size_t most);

/// The same points in the opposite order.
PointCloud reversed(const PointCloud& cloud);

}  // namespace batten::fuzz
