/// \file A polynomial part of the surface as a Bezier net: its jets, its halves, and bounds on it and on the squared
/// distance from the origin to it.
///
/// A cell has parameters of its own: (u, v) in the unit square, or u, v >= 0 and u + v <= 1. The points of its net are
/// relative to the query, which is the origin, so that rounding errors are in proportion to distances.
#pragma once
#include <array>
#include <cmath>

#include "batten/nearest/lanes.h"

namespace batten {

/// A point of a net and its derivatives by u and v.
struct NetJet {
  Double4 point, du, dv, duu, duv, dvv;
};

/// A bicubic net: point 4 j + i belongs to the Bernstein polynomials i in u and j in v.
struct QuadNet {
  static constexpr int kPoints = 16;
  static constexpr int kSplinePoints = 16;
  static constexpr int kCorners = 4;
  static constexpr int kCorner[4] = {0, 3, 15, 12};
  static constexpr double kCornerU[4] = {0.0, 1.0, 1.0, 0.0};
  static constexpr double kCornerV[4] = {0.0, 0.0, 1.0, 1.0};
  static constexpr double kMiddle = 0.5;

  static NetJet jet(const Double4* net, double u, double v);
  /// Calls visit(point, which) for the points of the nets of the first derivatives: by u (0) and by v (1).
  template <typename Visit>
  static void first_derivatives(const Double4* net, const Visit& visit);
  /// Likewise for the second derivatives: by u twice (0), by u and v (1), by v twice (2).
  template <typename Visit>
  static void second_derivatives(const Double4* net, const Visit& visit);
  /// The net of the curve from corner `number` to the next.
  static void side(const Double4* net, int number, Double4* curve) {
    constexpr int kStep[4] = {1, 4, -1, -4};
    for (int i = 0; i < 4; ++i) curve[i] = net[kCorner[number] + i * kStep[number]];
  }
  static Double4 mean_du(const Double4* net) { return 0.5 * (net[3] + net[15] - net[0] - net[12]); }
  static Double4 mean_dv(const Double4* net) { return 0.5 * (net[12] + net[15] - net[0] - net[3]); }
};

/// A quartic net: point index(i, j) belongs to the Bernstein polynomial in u^i v^j (1 - u - v)^(4 - i - j).
struct TriangleNet {
  static constexpr int kPoints = 15;
  static constexpr int kSplinePoints = 12;
  static constexpr int kCorners = 3;
  static constexpr int kCorner[3] = {0, 4, 14};
  static constexpr double kCornerU[3] = {0.0, 1.0, 0.0};
  static constexpr double kCornerV[3] = {0.0, 0.0, 1.0};
  static constexpr double kMiddle = 1.0 / 3.0;

  static constexpr int index(int i, int j) { return 5 * j - j * (j - 1) / 2 + i; }
  static NetJet jet(const Double4* net, double u, double v);
  template <typename Visit>
  static void first_derivatives(const Double4* net, const Visit& visit);
  template <typename Visit>
  static void second_derivatives(const Double4* net, const Visit& visit);
  static void side(const Double4* net, int number, Double4* curve) {
    for (int i = 0; i < 5; ++i) curve[i] = net[number == 0 ? i : number == 1 ? index(4 - i, i) : index(0, 4 - i)];
  }
  static Double4 mean_du(const Double4* net) { return net[4] - net[0]; }
  static Double4 mean_dv(const Double4* net) { return net[14] - net[0]; }
};

/// The matrix that takes the points of a net, or the control points of a spline, to the points of a net.
template <typename Net, int kColumns>
struct NetMatrix {
  std::array<std::array<double, kColumns>, Net::kPoints> rows;

  /// `to` does not overlap `from`.
  void apply(const Double4* from, Double4* to) const;
};

/// Between bicubic nets, and from bicubic splines, the weight of point (k, l) in point (i, j) is
/// along[i][k] * across[j][l].
template <>
struct NetMatrix<QuadNet, 16> {
  std::array<std::array<double, 4>, 4> along;
  std::array<std::array<double, 4>, 4> across;

  void apply(const Double4* from, Double4* to) const;
};

/// From the spline's control points, in the order of RegularPatch (kTriangleLattice).
template <typename Net>
using SplineMatrix = NetMatrix<Net, Net::kSplinePoints>;
/// From the net's own points.
template <typename Net>
using HalfMatrix = NetMatrix<Net, Net::kPoints>;

/// The net of a whole patch.
template <typename Net>
const SplineMatrix<Net>& spline_matrix();
/// The net of one of the four parts that halving makes: those at the corners in turn; a triangle's fourth is the
/// middle, turned by half.
template <typename Net>
const HalfMatrix<Net>& half_matrix(int child);
/// The matrix product.
SplineMatrix<QuadNet> product(const HalfMatrix<QuadNet>& half, const SplineMatrix<QuadNet>& part);
SplineMatrix<TriangleNet> product(const HalfMatrix<TriangleNet>& half, const SplineMatrix<TriangleNet>& part);

/// Where a part of a cell lies: its (u, v) is at (u0 + size u, v0 + size v) of the whole; size < 0 where the part is
/// turned by half.
struct Placement {
  double u0 = 0.0;
  double v0 = 0.0;
  double size = 1.0;

  double u(double part_u) const { return u0 + size * part_u; }
  double v(double part_v) const { return v0 + size * part_v; }
  /// The placement, in the whole, of a part of this part.
  Placement of(const Placement& part) const { return {u(part.u0), v(part.v0), size * part.size}; }
};
/// Where the part of half_matrix(child) lies.
template <typename Net>
Placement half(int child) {
  if (child >= Net::kCorners) return {0.5, 0.5, -0.5};
  return {0.5 * Net::kCornerU[child], 0.5 * Net::kCornerV[child], 0.5};
}

/// A net in the frame of its mean tangent plane: the first axis runs along the mean derivative by u, the second lies in
/// the plane, the third is its normal. The box from `low` to `high` has the cell in it.
///
/// In the plane a step of (du, dv) in the parameters has about the length |(du, dv)| =
/// sqrt((du_length du + dv_along dv)^2 + (dv_across dv)^2), which is called the mean metric.
template <typename Net>
struct NetFrame {
  explicit NetFrame(const Double4* net);

  /// The squared distance of the box from the origin: no point of the cell is nearer.
  double least_squared() const;
  /// The parameters at which the mean tangent plane is nearest to the origin, moved into the cell.
  void guess(double& u, double& v) const;
  /// A lower bound m on the second derivative of |S(u, v)|^2 / 2, S being the cell's points, in any direction of the
  /// parameters that has length 1 in the mean metric: the second derivative in the direction (du, dv) is at least
  /// m |(du, dv)|^2 all over the cell. Where m > 0 the squared distance is convex with this modulus. 0 where the mean
  /// derivatives span no plane, so that nothing is known.
  double convexity() const;
  /// How far the cell is from a parallelogram: a bound on the change of its first derivatives, relative to the mean
  /// ones. Halving a cell about halves its bend.
  double bend() const;

  std::array<Double4, Net::kPoints> points;  ///< of the net, in the frame
  Double4 low;
  Double4 high;
  bool flat_enough = true;  ///< the mean derivatives span a plane
  double du_length = 0.0;   ///< the length of the mean derivative by u
  double dv_along = 0.0;    ///< the first coordinate of the mean derivative by v
  double dv_across = 0.0;   ///< its second coordinate; the third is 0
};

extern template struct NetFrame<QuadNet>;
extern template struct NetFrame<TriangleNet>;

template <typename Visit>
void QuadNet::first_derivatives(const Double4* net, const Visit& visit) {
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      visit(3.0 * (net[4 * j + i + 1] - net[4 * j + i]), 0);
      visit(3.0 * (net[4 * (i + 1) + j] - net[4 * i + j]), 1);
    }
  }
}

template <typename Visit>
void QuadNet::second_derivatives(const Double4* net, const Visit& visit) {
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 2; ++i) {
      visit(6.0 * (net[4 * j + i + 2] - 2.0 * net[4 * j + i + 1] + net[4 * j + i]), 0);
      visit(6.0 * (net[4 * (i + 2) + j] - 2.0 * net[4 * (i + 1) + j] + net[4 * i + j]), 2);
    }
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Double4* at = net + 4 * j + i;
      visit(9.0 * (at[5] - at[4] - at[1] + at[0]), 1);
    }
  }
}

template <typename Visit>
void TriangleNet::first_derivatives(const Double4* net, const Visit& visit) {
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i + j < 4; ++i) {
      const Double4& at = net[index(i, j)];
      visit(4.0 * (net[index(i + 1, j)] - at), 0);
      visit(4.0 * (net[index(i, j + 1)] - at), 1);
    }
  }
}

template <typename Visit>
void TriangleNet::second_derivatives(const Double4* net, const Visit& visit) {
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i + j < 3; ++i) {
      const Double4& at = net[index(i, j)];
      const Double4& along = net[index(i + 1, j)];
      const Double4& across = net[index(i, j + 1)];
      visit(12.0 * (net[index(i + 2, j)] - 2.0 * along + at), 0);
      visit(12.0 * (net[index(i + 1, j + 1)] - along - across + at), 1);
      visit(12.0 * (net[index(i, j + 2)] - 2.0 * across + at), 2);
    }
  }
}

}  // namespace batten
