#include "batten/adaptive/chord_bound.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "batten/patch/regular_patch.h"

namespace batten {

namespace {

using Point = Eigen::Vector3d;
Point point(const double* points, int i) { return {points[3 * i], points[3 * i + 1], points[3 * i + 2]}; }

/// The largest of several second differences: its height across the plane, and its whole length.
struct Bend {
  double across = 0.0;
  double square = 0.0;
  void add(const Point& difference, const Point& normal) {
    across = std::max(across, std::abs(normal.dot(difference)));
    square = std::max(square, difference.squaredNorm());
  }
  double whole() const { return std::sqrt(square); }
};

/// The first differences in one direction: their mean, the greatest deviation from it, and their heights over the
/// plane.
struct Run {
  Point mean = Point::Zero();
  double radius = 0.0;
  double height = 0.0;
  template <typename Differences>
  Run(const Differences& differences, const Point& normal) {
    for (const Point& d : differences) mean += d;
    mean /= static_cast<double>(differences.size());
    double square = 0.0;
    for (const Point& d : differences) {
      square = std::max(square, (d - mean).squaredNorm());
      height = std::max(height, std::abs(normal.dot(d)));
    }
    radius = std::sqrt(square);
  }
  double longest() const { return mean.norm() + radius; }
};

/// The least area, projected on the plane, of a parallelogram of two of the differences.
template <typename Differences>
double least_area(const Differences& du, const Differences& dv, const Point& normal) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point& u : du) {
    for (const Point& v : dv) least = std::min(least, u.cross(v).dot(normal));
  }
  return least;
}

/// A bound for the distance, from second differences across the plane and whole ones. A displacement along the plane
/// changes the height by at most the steepest slope times its length, and by at most the whole height.
template <typename Differences>
double combine(double across, double whole, const Differences& du, const Differences& dv, const Point& normal) {
  if (normal.squaredNorm() == 0.0) return whole;
  const Run u(du, normal);
  const Run v(dv, normal);
  double area = std::abs(u.mean.cross(v.mean).dot(normal)) - u.radius * v.mean.norm() - v.radius * u.mean.norm() -
                u.radius * v.radius;
  if (!(area > 0.0)) area = least_area(du, dv, normal);
  // The differences of a triangle lattice say too little about the area; flat patches would be cut.
  const bool lattice = du.size() != 12;
  if (!(area > 0.0) && !lattice) return whole;
  double change = u.height + v.height;
  if (area > 0.0) change = std::min(change, whole * (u.height * v.longest() + v.height * u.longest()) / area);
  return std::min(whole, across + change);
}

/// The chord bound of a cubic curve, without movement along the curve.
double curve_bound(const double* points, const std::array<int, 4>& row) {
  const Point a = point(points, row[0]);
  const Point b = point(points, row[1]);
  const Point c = point(points, row[2]);
  const Point d = point(points, row[3]);
  const Point along = (c - b).normalized();
  double square = 0.0;
  for (const Point& difference : {Point(a - 2.0 * b + c), Point(b - 2.0 * c + d)}) {
    square = std::max(square, (difference - along.dot(difference) * along).squaredNorm());
  }
  return std::sqrt(square) / 8.0;
}

template <std::size_t N>
double curves_bound(const double* points, CurveSides curves, const std::array<std::array<int, 4>, N>& rows) {
  double bound = 0.0;
  for (std::size_t s = 0; s < N; ++s) {
    if ((curves >> s & 1U) != 0) bound = std::max(bound, curve_bound(points, rows[s]));
  }
  return bound;
}

constexpr std::array<std::array<int, 4>, 4> kQuadSides{{{4, 5, 6, 7}, {2, 6, 10, 14}, {11, 10, 9, 8}, {13, 9, 5, 1}}};
constexpr std::array<std::array<int, 4>, 3> kTriangleSides{{{6, 0, 1, 7}, {5, 1, 2, 10}, {11, 2, 0, 3}}};

/// Half of the largest sum of products of barycentric coordinates with second derivatives along the edges. It is half
/// of the squared radius of the smallest circle around a triangle with these squared sides.
double triangle_bound(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (a >= b + c) return a / 8.0;
  return 0.5 * a * b * c / (2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c);
}

/// The pairs and triples of neighbours in the lattice for each of the three directions.
struct LatticeRuns {
  std::array<std::vector<std::array<int, 2>>, 3> pairs;
  std::array<std::vector<std::array<int, 3>>, 3> triples;
  LatticeRuns() {
    constexpr int kDirections[3][2] = {{1, 0}, {0, 1}, {1, -1}};
    const auto find = [](int a, int b) {
      const auto place = std::find(kTriangleLattice.begin(), kTriangleLattice.end(), std::array<int, 2>{a, b});
      return place == kTriangleLattice.end() ? -1 : static_cast<int>(place - kTriangleLattice.begin());
    };
    for (int d = 0; d < 3; ++d) {
      for (int i = 0; i < kTrianglePatchSize; ++i) {
        const int next = find(kTriangleLattice[i][0] + kDirections[d][0], kTriangleLattice[i][1] + kDirections[d][1]);
        const int last = find(kTriangleLattice[i][0] - kDirections[d][0], kTriangleLattice[i][1] - kDirections[d][1]);
        if (next >= 0) pairs[d].push_back({i, next});
        if (next >= 0 && last >= 0) triples[d].push_back({last, i, next});
      }
    }
  }
};

}  // namespace

double quad_chord_bound(const double* points, CurveSides curves) {
  const auto at = [&](int i, int j) { return point(points, 4 * j + i); };
  const Point normal = (at(2, 2) - at(1, 1)).cross(at(1, 2) - at(2, 1)).normalized();
  std::array<Point, 12> du;  // du[3 j + i] starts at (i, j), dv[3 j + i] at (j, i)
  std::array<Point, 12> dv;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      du[3 * j + i] = at(i + 1, j) - at(i, j);
      dv[3 * j + i] = at(j, i + 1) - at(j, i);
    }
  }
  Bend uu;
  Bend uv;
  Bend vv;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 2; ++i) {
      uu.add(du[3 * j + i + 1] - du[3 * j + i], normal);
      vv.add(dv[3 * j + i + 1] - dv[3 * j + i], normal);
    }
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) uv.add(du[3 * j + 3 + i] - du[3 * j + i], normal);
  }
  const double across = (uu.across + 2.0 * uv.across + vv.across) / 8.0;
  const double whole = (uu.whole() + 2.0 * uv.whole() + vv.whole()) / 8.0;
  if ((curves & kEndSides) != 0) return whole;
  return std::max(combine(across, whole, du, dv, normal), curves_bound(points, curves, kQuadSides));
}

double triangle_chord_bound(const double* points, CurveSides curves) {
  static const LatticeRuns runs;
  const Point normal = (point(points, 1) - point(points, 0)).cross(point(points, 2) - point(points, 0)).normalized();
  std::array<Bend, 3> bends;
  std::array<std::vector<Point>, 2> differences;
  for (int d = 0; d < 3; ++d) {
    for (const auto& t : runs.triples[d]) {
      bends[d].add(point(points, t[0]) - 2.0 * point(points, t[1]) + point(points, t[2]), normal);
    }
    for (std::size_t i = 0; d < 2 && i < runs.pairs[d].size(); ++i) {
      differences[d].push_back(point(points, runs.pairs[d][i][1]) - point(points, runs.pairs[d][i][0]));
    }
  }
  const double across = triangle_bound(bends[0].across, bends[1].across, bends[2].across);
  const double whole = triangle_bound(bends[0].whole(), bends[1].whole(), bends[2].whole());
  if ((curves & kEndSides) != 0) return whole;
  return std::max(combine(across, whole, differences[0], differences[1], normal),
                  curves_bound(points, curves, kTriangleSides));
}

}  // namespace batten
