/// \file A polynomial part of the surface as a Bezier net: jets, halves, and what bounds it and the squared distance
/// from the origin to it.
///
/// Cells have parameters of their own: (u, v) in the unit square, or u, v >= 0 and u + v <= 1. Their points are given
/// from where the distance is asked, so that rounding is in proportion to distances.
#pragma once
#include <array>
#include <cmath>

#include "batten/double4.h"

namespace batten {

/// Of x, y and z; the fourth lane is nobody's.
inline double dot(const Double4& a, const Double4& b) {
  const Double4 products = a * b;
  return products[0] + products[1] + products[2];
}
/// Lane by lane.
inline Double4 lower(const Double4& a, const Double4& b) { return a < b ? a : b; }
inline Double4 higher(const Double4& a, const Double4& b) { return a > b ? a : b; }

struct NetJet {
  Double4 point, du, dv, duu, duv, dvv;
};

/// Bicubic: point 4 j + i belongs to the Bernstein polynomials i in u and j in v.
struct QuadNet {
  static constexpr int kPoints = 16;
  static constexpr int kSplinePoints = 16;
  static constexpr int kCorners = 4;
  static constexpr int kCorner[4] = {0, 3, 15, 12};
  static constexpr double kCornerU[4] = {0.0, 1.0, 1.0, 0.0};
  static constexpr double kCornerV[4] = {0.0, 0.0, 1.0, 1.0};
  static constexpr double kMiddle = 0.5;

  static NetJet jet(const Double4* net, double u, double v);
  /// Of the net of a derivative in u, in v; the same twice, and once in each.
  template <typename Visit>
  static void first_derivatives(const Double4* net, const Visit& visit);
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

/// Quartic: point index(i, j) belongs to u^i v^j (1 - u - v)^(4 - i - j).
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

/// Matrices between nets; row i has the weights of its point i.
template <typename Net>
struct NetTables {
  /// From the spline's control points, in the order of RegularPatch (kTriangleLattice).
  std::array<std::array<double, Net::kSplinePoints>, Net::kPoints> from_spline;
  /// To the four parts that halving makes: at the corners in turn; a triangle's fourth is the middle, turned by half.
  std::array<std::array<std::array<double, Net::kPoints>, Net::kPoints>, 4> halves;
};
const NetTables<QuadNet>& quad_tables();
const NetTables<TriangleNet>& triangle_tables();
template <typename Net>
const NetTables<Net>& net_tables();
template <>
inline const NetTables<QuadNet>& net_tables<QuadNet>() {
  return quad_tables();
}
template <>
inline const NetTables<TriangleNet>& net_tables<TriangleNet>() {
  return triangle_tables();
}

/// Where a part of a cell lies: its (u, v) is at (u0 + size u, v0 + size v) of the whole; size < 0 where it is turned.
struct Placement {
  double u0 = 0.0;
  double v0 = 0.0;
  double size = 1.0;

  double u(double part_u) const { return u0 + size * part_u; }
  double v(double part_v) const { return v0 + size * part_v; }
  /// Of the part's own part.
  Placement of(const Placement& part) const { return {u(part.u0), v(part.v0), size * part.size}; }
};
/// The part that halving number `child` gives.
template <typename Net>
Placement half(int child) {
  if (child >= Net::kCorners) return {0.5, 0.5, -0.5};
  return {0.5 * Net::kCornerU[child], 0.5 * Net::kCornerV[child], 0.5};
}

/// A box around a net in the frame of its mean tangent plane, and how its parameters lie in it.
template <typename Net>
struct NetFrame {
  explicit NetFrame(const Double4* net);

  /// No point of the cell is nearer to the origin, squared.
  double least_squared() const;
  /// The parameters of the plane's point over the origin, moved into the cell.
  void guess(double& u, double& v) const;
  /// A number m so that |S(u, v)|^2 / 2 in the metric r'r of `du_length` ... is convex, of modulus m; 0 or less where
  /// nothing is known.
  double convexity() const;
  /// How far the cell is from a parallelogram: the turn of its derivatives against the mean ones.
  double bend() const;

  std::array<Double4, Net::kPoints> points;  ///< in the frame: along the mean du, across it, along the normal
  Double4 low;
  Double4 high;
  bool flat_enough = true;  ///< the mean derivatives span a plane
  double du_length = 0.0;   ///< of the mean du
  double dv_along = 0.0;    ///< of the mean dv, along du
  double dv_across = 0.0;   ///< and across it
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
