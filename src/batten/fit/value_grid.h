/// \file Numbers at the nodes of a grid of cubes.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// A node (i, j, k) lies at origin + spacing * (i, j, k). Positive numbers are inside.
struct ValueGrid {
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  double spacing = 1.0;
  std::array<Index, 3> nodes{};  ///< along each axis
  Buffer<float> values;          ///< i + nodes[0] * (j + nodes[1] * k)

  std::ptrdiff_t node(Index i, Index j, Index k) const {
    return i + static_cast<std::ptrdiff_t>(nodes[0]) * (j + static_cast<std::ptrdiff_t>(nodes[1]) * k);
  }
  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(nodes[0]) * nodes[1] * nodes[2]; }
  Eigen::RowVector3d place(Index i, Index j, Index k) const { return origin + spacing * Eigen::RowVector3d(i, j, k); }
  /// Linear in each direction; places outside take the number of the nearest place of the grid.
  double at(const Eigen::RowVector3d& place) const {
    std::array<Index, 3> cell{};
    std::array<double, 3> share{};
    for (int c = 0; c < 3; ++c) {
      const double step = std::clamp((place(c) - origin(c)) / spacing, 0.0, nodes[c] - 1.0);
      cell[c] = std::min(static_cast<Index>(step), nodes[c] - 2);
      share[c] = step - cell[c];
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const double weight = ((corner & 1) != 0 ? share[0] : 1.0 - share[0]) *
                            ((corner & 2) != 0 ? share[1] : 1.0 - share[1]) *
                            ((corner & 4) != 0 ? share[2] : 1.0 - share[2]);
      sum += weight * values[node(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1))];
    }
    return sum;
  }
};

/// A grid with its lowest node at `low` that reaches to `high`, without numbers.
inline ValueGrid grid_over(const Eigen::RowVector3d& low, const Eigen::RowVector3d& high, double spacing) {
  ValueGrid grid;
  grid.origin = low;
  grid.spacing = spacing;
  for (int c = 0; c < 3; ++c)
    grid.nodes[c] = std::max<Index>(2, static_cast<Index>(std::ceil((high(c) - low(c)) / spacing)) + 1);
  grid.values.resize(static_cast<std::size_t>(grid.count()));
  return grid;
}

}  // namespace batten
