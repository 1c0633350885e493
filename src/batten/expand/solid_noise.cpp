#include "batten/expand/solid_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace batten {
namespace {

constexpr int kCells = 27;

/// Hashes four numbers to four random numbers (pcg4d, key JO20).
struct Hash {
  std::uint32_t x;
  std::uint32_t y;
  std::uint32_t z;
  std::uint32_t w;

  void mix() {
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
  }
};

inline Hash hash(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t w) {
  constexpr std::uint32_t kFactor = 1664525U;
  constexpr std::uint32_t kSummand = 1013904223U;
  constexpr int kFold = 16;
  Hash h{x * kFactor + kSummand, y * kFactor + kSummand, z * kFactor + kSummand, w * kFactor + kSummand};
  h.mix();
  h.x ^= h.x >> kFold;
  h.y ^= h.y >> kFold;
  h.z ^= h.z >> kFold;
  h.w ^= h.w >> kFold;
  h.mix();
  return h;
}

}  // namespace

double solid_noise(const Eigen::Vector3d& point, std::uint32_t seed) {
  // The result is in [0, 1) with 31 bits, because a signed integer becomes a double in one instruction.
  constexpr double kUnit = 1.0 / 2147483648.0;
  // Heights are uniform in [-1, 1] and have the variance 1/3. The square of the kernel has the integral 2 pi B(3/2, 7).
  constexpr double kScale = 3.2406267504457724;
  const Eigen::Vector3d floor(std::floor(point.x()), std::floor(point.y()), std::floor(point.z()));
  const Eigen::Vector3d inside = point - floor;
  const auto column = static_cast<std::int32_t>(floor.x());
  const auto row = static_cast<std::int32_t>(floor.y());
  const auto layer = static_cast<std::int32_t>(floor.z());
  std::array<double, kCells> parts{};
  for (int cell = 0; cell < kCells; ++cell) {
    const int i = cell % 3 - 1;
    const int j = cell / 3 % 3 - 1;
    const int k = cell / 9 - 1;
    const Hash h = hash(static_cast<std::uint32_t>(column + i), static_cast<std::uint32_t>(row + j),
                        static_cast<std::uint32_t>(layer + k), seed);
    const double x = i + kUnit * static_cast<std::int32_t>(h.x >> 1U) - inside.x();
    const double y = j + kUnit * static_cast<std::int32_t>(h.y >> 1U) - inside.y();
    const double z = k + kUnit * static_cast<std::int32_t>(h.z >> 1U) - inside.z();
    const double near = std::max(0.0, 1.0 - (x * x + y * y + z * z));
    const double height = 2.0 * kUnit * static_cast<std::int32_t>(h.w >> 1U) - 1.0;
    parts[static_cast<std::size_t>(cell)] = height * near * near * near;
  }
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return kScale * sum;
}

}  // namespace batten
