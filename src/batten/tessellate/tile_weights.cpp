#include "batten/tessellate/tile_weights.h"

#include <array>
#include <cmath>
#include <vector>

#include "batten/patch/regular_patch.h"

namespace batten {

namespace {

using Weights4 = std::array<double, 4>;
using Weights12 = std::array<double, kTrianglePatchSize>;

template <typename Array>
void add(Array& sum, double weight, const Array& term) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * term[i];
}

/// The refined control polygon of a patch, from -1 to size + 1.
std::vector<Weights4> refined_polygon(int size) {
  std::vector<Weights4> points(4);
  for (std::size_t i = 0; i < 4; ++i) points[i] = Weights4{}, points[i][i] = 1.0;
  for (int now = 1; now < size; now *= 2) {
    // Point i stands at i - 1; of the child's -1 .. 2 now + 1 the odd ones are edge points.
    std::vector<Weights4> child(static_cast<std::size_t>(2 * now) + 3, Weights4{});
    for (std::size_t c = 0; c < child.size(); ++c) {
      const std::size_t p = c / 2;
      if (c % 2 == 0) {
        add(child[c], 0.5, points[p]);
        add(child[c], 0.5, points[p + 1]);
      } else {
        add(child[c], 0.125, points[p]);
        add(child[c], 0.75, points[p + 1]);
        add(child[c], 0.125, points[p + 2]);
      }
    }
    points = std::move(child);
  }
  return points;
}

/// The refined lattice of Loop's patch: points whose three barycentric coordinates lie in [-1, size + 1].
class Lattice {
 public:
  explicit Lattice(int size)
      : size_(size), points_(static_cast<std::size_t>(size + 3) * static_cast<std::size_t>(size + 3), Weights12{}) {}
  int size() const { return size_; }
  bool holds(int i, int j) const {
    const int k = size_ - i - j;
    return i >= -1 && j >= -1 && k >= -1 && i <= size_ + 1 && j <= size_ + 1 && k <= size_ + 1;
  }
  Weights12& at(int i, int j) {
    return points_[static_cast<std::size_t>(j + 1) * static_cast<std::size_t>(size_ + 3) +
                   static_cast<std::size_t>(i + 1)];
  }

 private:
  int size_;
  std::vector<Weights12> points_;
};

constexpr int kNeighbours[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};

/// Loop's rules on the regular lattice. The parent of a point is where its even or odd coordinates say.
Lattice refined(Lattice& parent) {
  Lattice child(2 * parent.size());
  const auto half = [](int x) { return x >= 0 ? x / 2 : (x - 1) / 2; };
  for (int j = -1; j <= child.size() + 1; ++j) {
    for (int i = -1; i <= child.size() + 1; ++i) {
      if (!child.holds(i, j)) continue;
      Weights12& point = child.at(i, j);
      const int a = half(i);
      const int b = half(j);
      const bool odd_i = i != 2 * a;
      const bool odd_j = j != 2 * b;
      if (!odd_i && !odd_j) {
        add(point, 0.625, parent.at(a, b));
        for (const auto& step : kNeighbours) add(point, 0.0625, parent.at(a + step[0], b + step[1]));
        continue;
      }
      // Ends of the edge, then the points opposite to it.
      std::array<std::array<int, 2>, 4> ring{{{a, b}, {a + 1, b}, {a, b + 1}, {a + 1, b - 1}}};
      if (!odd_i) ring = {{{a, b}, {a, b + 1}, {a + 1, b}, {a - 1, b + 1}}};
      if (odd_i && odd_j) ring = {{{a + 1, b}, {a, b + 1}, {a, b}, {a + 1, b + 1}}};
      for (std::size_t r = 0; r < 4; ++r) add(point, r < 2 ? 0.375 : 0.125, parent.at(ring[r][0], ring[r][1]));
    }
  }
  return child;
}

Weights12 lattice_value(Lattice& lattice, int i, int j, TileValue value) {
  if (value == TileValue::Refined) return lattice.at(i, j);
  Weights12 sum{};
  if (value == TileValue::Limit) add(sum, 0.5, lattice.at(i, j));
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::acos(-1.0) / 3.0;
    const double weight = value == TileValue::Limit      ? 1.0 / 12.0
                          : value == TileValue::TangentU ? std::cos(angle)
                                                         : std::sin(angle);
    add(sum, weight, lattice.at(i + kNeighbours[k][0], j + kNeighbours[k][1]));
  }
  return sum;
}

}  // namespace

Buffer<double> curve_weights(int size, TileValue value) {
  const std::vector<Weights4> polygon = refined_polygon(size);
  Buffer<double> weights;
  weights.reserve(4 * static_cast<std::size_t>(size + 1));
  for (std::size_t i = 1; i <= static_cast<std::size_t>(size) + 1; ++i) {
    Weights4 point = polygon[i];
    if (value != TileValue::Refined) {
      const double before = value == TileValue::Limit ? 1.0 / 6.0 : -0.5;
      const double here = value == TileValue::Limit ? 4.0 / 6.0 : 0.0;
      const double after = value == TileValue::Limit ? 1.0 / 6.0 : 0.5;
      point = Weights4{};
      add(point, before, polygon[i - 1]);
      add(point, here, polygon[i]);
      add(point, after, polygon[i + 1]);
    }
    weights.insert(weights.end(), point.begin(), point.end());
  }
  return weights;
}

Buffer<double> triangle_weights(int size, TileValue value) {
  Lattice lattice(1);
  for (std::size_t k = 0; k < kTrianglePatchSize; ++k)
    lattice.at(kTriangleLattice[k][0], kTriangleLattice[k][1])[k] = 1.0;
  while (lattice.size() < size) lattice = refined(lattice);
  Buffer<double> weights;
  for (int j = 0; j <= size; ++j) {
    for (int i = 0; i + j <= size; ++i) {
      const Weights12 point = lattice_value(lattice, i, j, value);
      weights.insert(weights.end(), point.begin(), point.end());
    }
  }
  return weights;
}

}  // namespace batten
