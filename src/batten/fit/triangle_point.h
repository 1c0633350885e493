/// \file The point of a triangle that is nearest to a place.
#pragma once
#include <Eigen/Core>
#include <algorithm>

namespace batten {

/// The shares of the corners b and c in the point of the triangle 0, b, c that is nearest to p; that of the corner at
/// the origin is the rest. A triangle without area counts as its sides.
inline Eigen::Vector2d nearest_in_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c) {
  const double bb = b.squaredNorm();
  const double bc = b.dot(c);
  const double cc = c.squaredNorm();
  const double pb = b.dot(p);
  const double pc = c.dot(p);
  const double area = bb * cc - bc * bc;
  const double u = cc * pb - bc * pc;
  const double v = bb * pc - bc * pb;
  if (area > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= area) return {u / area, v / area};
  const auto share = [](double part, double whole) { return whole > 0.0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; };
  const double across = share(pc - pb + bb - bc, bb + cc - 2.0 * bc);
  const Eigen::Vector2d on_sides[3] = {{share(pb, bb), 0.0}, {0.0, share(pc, cc)}, {1.0 - across, across}};
  Eigen::Vector2d best = on_sides[0];
  double least = (p - best[0] * b).squaredNorm();
  for (int side = 1; side < 3; ++side) {
    const double square = (p - on_sides[side][0] * b - on_sides[side][1] * c).squaredNorm();
    if (square >= least) continue;
    least = square;
    best = on_sides[side];
  }
  return best;
}

/// The squared distance of p from the triangle a, b, c.
inline double squared_distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c) {
  const Eigen::Vector2d shares = nearest_in_triangle(p - a, b - a, c - a);
  return (p - a - shares[0] * (b - a) - shares[1] * (c - a)).squaredNorm();
}

}  // namespace batten
