#include "batten/volume/gaussian_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

std::vector<float> gaussian_weights(double sigma) {
  constexpr double kFar = 4.0;
  const auto reach = static_cast<int>(std::ceil(kFar * sigma));
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    const double far = i / sigma;
    weights.push_back(std::exp(-0.5 * far * far));
    sum += weights.back();
  }
  std::vector<float> result;
  result.reserve(weights.size());
  for (const double weight : weights) result.push_back(static_cast<float>(weight / sum));
  return result;
}

/// Rows along the first index are sums of rows, or of the same row moved.
Volume smoothed_along(const Volume& volume, int axis, const std::vector<float>& weights) {
  const std::array<Index, 3>& size = volume.grid.size;
  const auto reach = static_cast<Index>(weights.size() / 2);
  Volume result;
  result.grid = volume.grid;
  result.values.assign(volume.values.size(), 0.0F);
  parallel_for_each(static_cast<std::ptrdiff_t>(size[1]) * size[2], [&](std::ptrdiff_t row) {
    const std::array<Index, 3> at{0, static_cast<Index>(row % size[1]), static_cast<Index>(row / size[1])};
    float* const out = &result.values[row * size[0]];
    std::vector<float> line;
    if (axis == 0) {
      const float* const in = &volume.values[row * size[0]];
      for (Index i = -reach; i < size[0] + reach; ++i) line.push_back(in[std::clamp<Index>(i, 0, size[0] - 1)]);
    }
    for (Index far = -reach; far <= reach; ++far) {
      const float weight = weights[far + reach];
      std::array<Index, 3> from = at;
      if (axis != 0) from[axis] = std::clamp<Index>(at[axis] + far, 0, size[axis] - 1);
      const float* const in = axis == 0 ? &line[far + reach] : &volume.values[volume.grid.voxel(0, from[1], from[2])];
      for (Index i = 0; i < size[0]; ++i) out[i] += weight * in[i];
    }
  });
  return result;
}

}  // namespace

Volume gaussian_smoothed(Volume volume, const Eigen::Vector3d& sigmas) {
  constexpr double kNone = 0.05;  // the weights beside the middle are below 1e-80
  if (!sigmas.allFinite() || sigmas.minCoeff() < 0.0)
    throw Error(ErrorCode::BadArgument, "standard deviations are 0 voxels or more");
  for (int axis = 0; axis < 3; ++axis) {
    if (sigmas[axis] > kNone) volume = smoothed_along(volume, axis, gaussian_weights(sigmas[axis]));
  }
  return volume;
}

}  // namespace batten
