#include "batten/fit/field_grid.h"

#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr Index kCubeCells = 4;

/// The cubes of a grid and a coarser grid of their corners.
class FieldCubes {
 public:
  FieldCubes(ValueGrid& grid, const WindingField& field, double level) : grid_(grid), field_(field), level_(level) {
    corners_.origin = grid.origin;
    corners_.spacing = kCubeCells * grid.spacing;
    for (int c = 0; c < 3; ++c) corners_.nodes[c] = (grid.nodes[c] + kCubeCells - 2) / kCubeCells + 1;
    corners_.values.resize(static_cast<std::size_t>(corners_.count()));
  }

  void fill(const Points& points, const Progress& progress) {
    parallel_for_each(static_cast<std::ptrdiff_t>(corners_.nodes[1]) * corners_.nodes[2], [&](std::ptrdiff_t row) {
      const auto j = static_cast<Index>(row % corners_.nodes[1]);
      const auto k = static_cast<Index>(row / corners_.nodes[1]);
      for (Index i = 0; i < corners_.nodes[0]; ++i)
        corners_.values[corners_.node(i, j, k)] = exact(corners_.place(i, j, k));
    });
    mark_near(points);
    mark_crossed();
    parallel_for_each(
        static_cast<std::ptrdiff_t>(grid_.nodes[1]) * grid_.nodes[2],
        [&](std::ptrdiff_t row) {
          fill_row(static_cast<Index>(row % grid_.nodes[1]), static_cast<Index>(row / grid_.nodes[1]));
        },
        progress);
  }

 private:
  float exact(const Eigen::RowVector3d& place) const { return static_cast<float>(field_.value(place) - level_); }

  /// Cubes with points in them or nearby.
  void mark_near(const Points& points) {
    constexpr double kNearCells = 1.5;
    near_.assign(corners_.values.size(), 0);
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      for (int corner = 0; corner < 8; ++corner) {
        std::array<Index, 3> cube{};
        for (int c = 0; c < 3; ++c) {
          const double step = (corner >> c & 1) != 0 ? kNearCells : -kNearCells;
          const double place = points(row, c) + step * grid_.spacing - corners_.origin(c);
          cube[c] = std::clamp<Index>(static_cast<Index>(place / corners_.spacing), 0, corners_.nodes[c] - 1);
        }
        near_[corners_.node(cube[0], cube[1], cube[2])] = 1;
      }
    }
  }

  void mark_crossed() {
    constexpr float kFar = 0.2F;
    for (Index k = 0; k + 1 < corners_.nodes[2]; ++k) {
      for (Index j = 0; j + 1 < corners_.nodes[1]; ++j) {
        for (Index i = 0; i + 1 < corners_.nodes[0]; ++i) {
          float low = corners_.values[corners_.node(i, j, k)];
          float high = low;
          for (int corner = 1; corner < 8; ++corner) {
            const float value =
                corners_.values[corners_.node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1))];
            low = std::min(low, value);
            high = std::max(high, value);
          }
          if (low < kFar && high > -kFar) near_[corners_.node(i, j, k)] = 1;
        }
      }
    }
  }

  void fill_row(Index j, Index k) {
    const Index cube_j = std::min(j / kCubeCells, corners_.nodes[1] - 2);
    const Index cube_k = std::min(k / kCubeCells, corners_.nodes[2] - 2);
    for (Index i = 0; i < grid_.nodes[0]; ++i) {
      const Index cube_i = std::min(i / kCubeCells, corners_.nodes[0] - 2);
      const Eigen::RowVector3d place = grid_.place(i, j, k);
      grid_.values[grid_.node(i, j, k)] =
          near_[corners_.node(cube_i, cube_j, cube_k)] != 0 ? exact(place) : static_cast<float>(corners_.at(place));
    }
  }

  ValueGrid& grid_;
  const WindingField& field_;
  double level_;
  ValueGrid corners_;
  Buffer<std::uint8_t> near_;
};

}  // namespace

void fill_from_field(ValueGrid& grid, const WindingField& field, double level, const Points& points,
                     const Progress& progress) {
  FieldCubes(grid, field, level).fill(points, progress);
}

}  // namespace batten
