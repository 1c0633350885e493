/// \file Smooth random numbers in space, without preferred directions and reproducible from a seed.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace batten {

/// Sparse convolution noise (key L89): each cell of a unit grid has one impulse at a random place and of random height,
/// which the kernel (1 - r^2)^3 of radius 1 spreads. Over the seeds the sum has mean 0 and variance 1 at every point.
/// Its features are about one unit large, and it is twice continuously differentiable. Impulses come from a hash of
/// integers (pcg4d, key JO20) and need no table; the same seed gives the same noise on every machine, to rounding.
/// point: finite, below 1e9 in every coordinate. About 50 ns.
double solid_noise(const Eigen::Vector3d& point, std::uint32_t seed);

}  // namespace batten
