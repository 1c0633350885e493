/// \file Bodies of known surface and images of them: for tests, and for bench/segment_phantoms.cpp.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "batten/volume/inside_volume.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/segment_volume.h"
#include "volume/phantoms.h"

namespace batten::test {

using Place = Eigen::Vector3d;

/// A shape: positive inside.
struct Phantom {
  const char* name;
  std::function<double(const Place&)> inside;
  Place seed;
};

inline double ellipsoid(const Place& at) { return 1.0 - at.cwiseQuotient(Place(14, 10, 9)).norm(); }

/// An arc of 216 degrees with round ends.
inline double bent_tube(const Place& at) {
  const double turn = std::atan2(at[1] + 6.0, at[0]) - 0.5 * std::numbers::pi;
  const double near = std::clamp(std::remainder(turn, 2.0 * std::numbers::pi), -1.9, 1.9) + 0.5 * std::numbers::pi;
  return 6.0 - (at - Place(14.0 * std::cos(near), 14.0 * std::sin(near) - 6.0, 0.0)).norm();
}

inline double large_bean(const Place& at) {
  const Place bent(at[0] - 0.02 * at[1] * at[1], at[1], 1.4 * at[2] + 0.1 * at[0]);
  return 1.0 - bent.cwiseQuotient(Place(11, 14, 12)).norm();
}

/// Two balls whose joint is rounded.
inline double two_lobes(const Place& at) {
  const double a = 9.0 - (at - Place(-6.5, 0, 0)).norm();
  const double b = 8.0 - (at - Place(7.5, 1, 0)).norm();
  const double near = std::max(5.0 - std::abs(a - b), 0.0) / 5.0;
  return std::max(a, b) + 1.25 * near * near;
}

inline const Phantom kPhantoms[] = {{"ellipsoid", ellipsoid, {0, 0, 0}},
                                    {"bent tube", bent_tube, {0, 8, 0}},
                                    {"bean", large_bean, {0, 0, 0}},
                                    {"two lobes", two_lobes, {-6, 0, 0}}};

/// Around the bodies: cubes of 1 mm, or thicker slices.
inline VolumeGrid body_grid(double slice) {
  VolumeGrid grid;
  grid.size = {54, 54, static_cast<Index>(54.0 / slice)};
  grid.axes = Place(1.0, 1.0, slice).asDiagonal();
  grid.origin = -grid.axes * Place(26.5, 26.5, 0.5 * (grid.size[2] - 1.0));
  return grid;
}

/// The shape as an image of contrast 100: parts of voxels, a Gaussian blur of one voxel along each index, noise.
inline Volume imaged(const Phantom& phantom, const VolumeGrid& grid, double noise) {
  const Place spacing(grid.spacing(0), grid.spacing(1), grid.spacing(2));
  Volume image = made_volume(grid, [&](const Place& at) {
    constexpr int kParts = 3;
    double sum = 0.0;
    for (int n = 0; n < kParts * kParts * kParts; ++n) {
      const Place part(n % kParts - 1, n / kParts % kParts - 1, n / kParts / kParts - 1);
      sum += phantom.inside(at + part.cwiseProduct(spacing) / kParts) > 0.0 ? 1.0 : 0.0;
    }
    return 100.0 * sum / (kParts * kParts * kParts);
  });
  for (int axis = 0; axis < 3; ++axis) {
    const Volume before = image;
    for (std::ptrdiff_t voxel = 0; voxel < grid.count(); ++voxel) {
      std::array<Index, 3> at{static_cast<Index>(voxel % grid.size[0]),
                              static_cast<Index>(voxel / grid.size[0] % grid.size[1]),
                              static_cast<Index>(voxel / grid.size[0] / grid.size[1])};
      const Index middle = at[axis];
      double sum = 0.0;
      double count = 0.0;
      for (Index far = -4; far <= 4; ++far) {
        at[axis] = std::clamp(middle + far, 0, grid.size[axis] - 1);
        sum += std::exp(-0.5 * far * far) * before.at(at[0], at[1], at[2]);
        count += std::exp(-0.5 * far * far);
      }
      image.values[voxel] = static_cast<float>(sum / count);
    }
  }
  std::mt19937 random(5);
  std::normal_distribution<double> scatter(0.0, 100.0 * noise);
  for (float& value : image.values) value += static_cast<float>(noise > 0.0 ? scatter(random) : 0.0);
  return image;
}

/// What the surface is of the shape.
struct Truth {
  double dice = 0.0;
  double distance = 0.0;  ///< the mean from the surface to the shape, mm
  double volume = 0.0;    ///< of the surface, as a share of the shape's
};

inline Truth compared(const SegmentResult& found, const Phantom& phantom) {
  VolumeGrid grid = centred_grid(104, 0.5);
  const Volume shape = made_volume(grid, [&](const Place& at) { return phantom.inside(at) > 0.0 ? 1 : 0; });
  double volume = 0.0;
  for (const float value : shape.values) volume += value * grid.voxel_volume();
  const Mesh& fine = found.measures.fine;
  double sum = 0.0;
  for (Eigen::Index row = 0; row < fine.points.rows(); ++row) {
    const Place at = fine.points.row(row).transpose();
    constexpr double kStep = 1e-3;
    Place slope;
    for (int c = 0; c < 3; ++c) {
      const Place step = kStep * Place::Unit(c);
      slope[c] = (phantom.inside(at + step) - phantom.inside(at - step)) / (2.0 * kStep);
    }
    sum += std::abs(phantom.inside(at)) / slope.norm();
  }
  return {dice(inside_volume(fine, grid, VoxelRule::Centre), shape), sum / static_cast<double>(fine.points.rows()),
          found.measures.volume / volume};
}

}  // namespace batten::test
