#include "batten/energy/regular_energies.h"

#include <numbers>

#include "batten/patch/regular_patch.h"

namespace batten {

namespace {

/// Integrals over [0, 1] of products of the four cubic B-spline functions, times 5040, of their first derivatives,
/// times 120, and of their second ones, times 6.
constexpr int kValues[4][4] = {{20, 129, 60, 1}, {129, 1188, 933, 60}, {60, 933, 1188, 129}, {1, 60, 129, 20}};
constexpr int kSlopes[4][4] = {{6, 7, -12, -1}, {7, 34, -29, -12}, {-12, -29, 34, 7}, {-1, -12, 7, 6}};
constexpr int kBends[4][4] = {{2, -3, 0, 1}, {-3, 6, -3, 0}, {0, -3, 6, -3}, {1, 0, -3, 2}};
constexpr double kValueUnit = 5040.0;
constexpr double kSlopeUnit = 120.0;
constexpr double kBendUnit = 6.0;

/// Integrals over the triangle of products of the twelve box splines, times 362880; of their gradients, times
/// 40320 / g; of their second derivatives, times 288 / g^2, where g = 2 / sqrt(3) is what a unit of (u, v) counts on
/// the equilateral triangle of area 1/2: |gradient|^2 = g (s_u^2 - s_u s_v + s_v^2).
constexpr int kTriangleMass[12][12] = {{15052, 11869, 11869, 627, 2734, 290, 627, 262, 2734, 1768, 290, 262},
                                       {11869, 15052, 11869, 290, 2734, 627, 262, 627, 1768, 2734, 262, 290},
                                       {11869, 11869, 15052, 262, 1768, 262, 290, 290, 2734, 2734, 627, 627},
                                       {627, 290, 262, 46, 118, 4, 44, 2, 101, 15, 2, 1},
                                       {2734, 2734, 1768, 118, 688, 118, 101, 101, 340, 340, 15, 15},
                                       {290, 627, 262, 4, 118, 46, 2, 44, 15, 101, 1, 2},
                                       {627, 262, 290, 44, 101, 2, 46, 1, 118, 15, 4, 2},
                                       {262, 627, 290, 2, 101, 44, 1, 46, 15, 118, 2, 4},
                                       {2734, 1768, 2734, 101, 340, 15, 118, 15, 688, 340, 118, 101},
                                       {1768, 2734, 2734, 15, 340, 101, 15, 118, 340, 688, 101, 118},
                                       {290, 262, 627, 2, 15, 1, 4, 2, 118, 101, 46, 44},
                                       {262, 290, 627, 1, 15, 2, 2, 4, 101, 118, 44, 46}};

constexpr int kTriangleMembrane[12][12] = {{3638, -1511, -1511, 296, 597, -177, 296, -315, 597, -1418, -177, -315},
                                           {-1511, 3638, -1511, -177, 597, 296, -315, 296, -1418, 597, -315, -177},
                                           {-1511, -1511, 3638, -315, -1418, -315, -177, -177, 597, 597, 296, 296},
                                           {296, -177, -315, 102, 141, -3, 66, -9, -17, -68, -9, -7},
                                           {597, 597, -1418, 141, 918, 141, -17, -17, -403, -403, -68, -68},
                                           {-177, 296, -315, -3, 141, 102, -9, 66, -68, -17, -7, -9},
                                           {296, -315, -177, 66, -17, -9, 102, -7, 141, -68, -3, -9},
                                           {-315, 296, -177, -9, -17, 66, -7, 102, -68, 141, -9, -3},
                                           {597, -1418, 597, -17, -403, -68, 141, -68, 918, -403, 141, -17},
                                           {-1418, 597, 597, -68, -403, -17, -68, 141, -403, 918, -17, 141},
                                           {-177, -315, 296, -9, -68, -7, -3, -9, 141, -17, 102, 66},
                                           {-315, -177, 296, -7, -68, -9, -9, -3, -17, 141, 66, 102}};

constexpr int kTrianglePlate[12][12] = {
    {114, -6, -6, -9, -33, -15, -9, 3, -33, 6, -15, 3}, {-6, 114, -6, -15, -33, -9, 3, -9, 6, -33, 3, -15},
    {-6, -6, 114, 3, 6, 3, -15, -15, -33, -33, -9, -9}, {-9, -15, 3, 10, 3, -1, 2, 1, -6, 9, 1, 2},
    {-33, -33, 6, 3, 42, 3, -6, -6, 3, 3, 9, 9},        {-15, -9, 3, -1, 3, 10, 1, 2, 9, -6, 2, 1},
    {-9, 3, -15, 2, -6, 1, 10, 2, 3, 9, -1, 1},         {3, -9, -15, 1, -6, 2, 2, 10, 9, 3, 1, -1},
    {-33, 6, -33, -6, 3, 9, 3, 9, 42, 3, 3, -6},        {6, -33, -33, 9, 3, -6, 9, 3, 3, 42, -6, 3},
    {-15, 3, -9, 1, 9, 2, -1, 1, 3, -6, 10, 2},         {3, -15, -9, 2, 9, 1, 1, -1, -6, 3, 2, 10}};
constexpr double kTriangleMassUnit = 362880.0;
constexpr double kTriangleMembraneUnit = 40320.0;
constexpr double kTrianglePlateUnit = 288.0;

double quad_entry(EnergyKind kind, int i, int j, int k, int l) {
  const double value_u = kValues[i][k];
  const double value_v = kValues[j][l];
  if (kind == EnergyKind::Mass) return value_u * value_v / (kValueUnit * kValueUnit);
  const double slope_u = kSlopes[i][k];
  const double slope_v = kSlopes[j][l];
  if (kind == EnergyKind::Membrane) return (slope_u * value_v + value_u * slope_v) / (kSlopeUnit * kValueUnit);
  return (kBends[i][k] * value_v + value_u * kBends[j][l]) / (kBendUnit * kValueUnit) +
         2.0 * slope_u * slope_v / (kSlopeUnit * kSlopeUnit);
}

double triangle_entry(EnergyKind kind, int i, int k) {
  if (kind == EnergyKind::Mass) return kTriangleMass[i][k] / kTriangleMassUnit;
  if (kind == EnergyKind::Membrane) {
    return 2.0 * kTriangleMembrane[i][k] / (std::numbers::sqrt3 * kTriangleMembraneUnit);
  }
  return 4.0 * kTrianglePlate[i][k] / (3.0 * kTrianglePlateUnit);
}

}  // namespace

Eigen::MatrixXd regular_energy(bool quads, EnergyKind kind) {
  const int size = patch_size(quads);
  Eigen::MatrixXd matrix(size, size);
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < size; ++k) {
      matrix(i, k) = quads ? quad_entry(kind, i % 4, i / 4, k % 4, k / 4) : triangle_entry(kind, i, k);
    }
  }
  return matrix;
}

}  // namespace batten
