/// \file Random numbers in space: smooth, without preferred directions, the same for the same seed.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace batten {

/// Sparse convolution noise (key L89): in each cell of a unit grid lies one impulse, at a random place and of random
/// height, spread by the kernel (1 - r^2)^3 of radius 1. The sum has mean 0 and variance 1 over the seeds at every
/// point, its features are about one unit large, and it is twice continuously differentiable. Impulses come from a hash
/// of integers (pcg4d, key JO20), so there is no table, and the same seed gives the same noise on every machine, to
/// rounding. point: finite, below 1e9 in every coordinate. About 50 ns.
double solid_noise(const Eigen::Vector3d& point, std::uint32_t seed);

}  // namespace batten
