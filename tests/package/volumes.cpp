/// A volume that a program makes is written, read, and becomes a surface.
#include <cmath>
#include <cstdio>
#include <string>

#include "batten/batten.h"
#include "batten/volume/volume_file.h"

int main(int /*argc*/, char** argv) {
  constexpr batten::Index kSize = 25;
  constexpr double kRadius = 9.0;
  batten::Volume made;
  made.grid.size = {kSize, kSize, kSize};
  made.grid.origin.setConstant(-12.0);
  for (batten::Index k = 0; k < kSize; ++k) {
    for (batten::Index j = 0; j < kSize; ++j) {
      for (batten::Index i = 0; i < kSize; ++i)
        made.values.push_back(made.grid.to_world(Eigen::Vector3d(i, j, k)).norm() < kRadius ? 1.0F : 0.0F);
    }
  }
  const std::string file = std::string(argv[0]) + ".nii.gz";
  batten::write_volume(file, made, batten::VoxelType::Byte);
  const batten::Volume read = batten::read_volume(file);
  if (read.values != made.values) return std::puts("the numbers have changed"), 1;
  batten::SegmentRequest request;
  request.surface.vertices = 100;
  const double volume = batten::segment_volume(read, request).measures.volume;
  const double ball = 4.0 / 3.0 * 3.141592653589793 * std::pow(kRadius, 3.0);
  if (std::abs(volume - ball) > 0.05 * ball) return std::printf("%g mm^3 instead of %g\n", volume, ball), 1;
  return 0;
}
