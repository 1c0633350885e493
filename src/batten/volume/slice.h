/// \file Slices of a volume and what a mesh looks like in them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/volume/volume.h"

namespace batten {

/// A slice as a picture: rows from the top, the world's right, front and top to the right and up.
struct VolumeSlice {
  Values numbers;             ///< of the image: rows from the top, columns from the left
  double pixel_width = 1.0;   ///< mm
  double pixel_height = 1.0;  ///< mm
  /// Where the surface cuts the slice: each from x, y to x, y, in pixels from the top left corner of the first one.
  std::vector<std::array<double, 4>> lines;
  std::string caption;  ///< "axial, z = 12.5 mm"
};

/// Slices across each index of the volume, `count` of them each, evenly through the box of the mesh and cropped to it
/// with a margin. fine: triangles, in the world. The first `count` are across the world's x (sagittal), then y
/// (coronal), then z (axial), as far as the volume's indices run along them. Throws Error(BadArgument) for a count
/// below 1 and a mesh outside the volume.
std::vector<VolumeSlice> slices_through(const Volume& image, const Mesh& fine, int count);

}  // namespace batten
