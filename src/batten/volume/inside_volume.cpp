#include "batten/volume/inside_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "batten/error.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Twice the area of (a, b, p) in the plane of the last two indices; the same number, but for its sign, for (b, a, p).
double side_of(const Points& points, Index a, Index b, double y, double z) {
  const bool turned = b < a;
  if (turned) std::swap(a, b);
  const double area =
      (points(b, 1) - points(a, 1)) * (z - points(a, 2)) - (points(b, 2) - points(a, 2)) * (y - points(a, 1));
  return turned ? -area : area;
}

/// On which side a ray passes an edge; a ray through the edge passes on one side for both of its faces.
bool passes_left(const Points& points, Index a, Index b, double y, double z) {
  const double side = side_of(points, a, b, y, z);
  return side != 0.0 ? side > 0.0 : a < b;
}

/// A polygon of a triangle's part in a box of voxels.
class CutTriangle {
 public:
  explicit CutTriangle(const std::array<Eigen::RowVector3d, 3>& corners) : count_(3) {
    for (int r = 0; r < 3; ++r) corners_[r] = corners[r];
  }

  bool is_empty() const { return count_ < 3; }
  double low(int axis) const {
    double least = corners_[0](axis);
    for (int r = 1; r < count_; ++r) least = std::min(least, corners_[r](axis));
    return least;
  }
  double high(int axis) const {
    double most = corners_[0](axis);
    for (int r = 1; r < count_; ++r) most = std::max(most, corners_[r](axis));
    return most;
  }

  /// What lies between two places along an axis.
  CutTriangle between(int axis, double from, double to) const {
    return clipped(axis, from, 1.0).clipped(axis, to, -1.0);
  }

  /// The area as the first axis sees it, and the area times the mean place along that axis.
  std::array<double, 2> shadow() const {
    std::array<double, 2> sum{};
    for (int r = 1; r + 1 < count_; ++r) {
      const Eigen::RowVector3d b = corners_[r] - corners_[0];
      const Eigen::RowVector3d c = corners_[r + 1] - corners_[0];
      const double area = 0.5 * (b(1) * c(2) - b(2) * c(1));
      sum[0] += area;
      sum[1] += area * (corners_[0](0) + corners_[r](0) + corners_[r + 1](0)) / 3.0;
    }
    return sum;
  }

 private:
  CutTriangle() : count_(0) {}

  /// The part where sign * (place - limit) is positive.
  CutTriangle clipped(int axis, double limit, double sign) const {
    CutTriangle part;
    for (int r = 0; r < count_; ++r) {
      const Eigen::RowVector3d& a = corners_[r];
      const Eigen::RowVector3d& b = corners_[r + 1 < count_ ? r + 1 : 0];
      const double from = sign * (a(axis) - limit);
      const double to = sign * (b(axis) - limit);
      if (from >= 0.0) part.corners_[part.count_++] = a;
      if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
        Eigen::RowVector3d& cut = part.corners_[part.count_++];
        cut = a + from / (from - to) * (b - a);
        cut(axis) = limit;
      }
    }
    return part;
  }

  // Each of the six clips adds a corner at most.
  std::array<Eigen::RowVector3d, 10> corners_;
  int count_;
};

/// The triangles of a mesh in index coordinates.
class Filler {
 public:
  Filler(const Mesh& mesh, const VolumeGrid& grid, VoxelRule rule)
      : points_(grid.to_indices(mesh.points)),
        grid_(grid),
        rule_(rule),
        handed_(grid.axes.determinant() > 0.0 ? 1.0 : -1.0) {
    for (Index f = 0; f < mesh.face_count(); ++f)
      triangles_.push_back({mesh.face_vertices[3 * f], mesh.face_vertices[3 * f + 1], mesh.face_vertices[3 * f + 2]});
    sort_into_slices();
  }

  Volume fill() const {
    Volume result;
    result.grid = grid_;
    result.values.resize(static_cast<std::size_t>(grid_.count()));
    parallel_for_each(grid_.size[2], [&](std::ptrdiff_t k) { fill_slice(static_cast<Index>(k), result); });
    return result;
  }

 private:
  using Triangle = std::array<Index, 3>;

  /// The first and the last voxel along an axis that a stretch touches, of those there are; none where last < first.
  std::array<Index, 2> voxels_of(int axis, double low, double high) const {
    const double end = grid_.size[axis];
    return {static_cast<Index>(std::clamp(std::floor(low + 0.5), 0.0, end)),
            static_cast<Index>(std::clamp(std::floor(high + 0.5), -1.0, end - 1.0))};
  }

  std::array<Eigen::RowVector3d, 3> corners_of(const Triangle& triangle) const {
    return {points_.row(triangle[0]), points_.row(triangle[1]), points_.row(triangle[2])};
  }

  void sort_into_slices() {
    of_slice_.resize(static_cast<std::size_t>(grid_.size[2]));
    for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t) {
      const CutTriangle whole(corners_of(triangles_[t]));
      const std::array<Index, 2> slices = voxels_of(2, whole.low(2), whole.high(2));
      for (Index k = slices[0]; k <= slices[1]; ++k) of_slice_[k].push_back(t);
    }
  }

  /// From the differences between neighbours along the first index to the numbers themselves.
  void fill_slice(Index k, Volume& result) const {
    const Index width = grid_.size[0];
    const Index height = grid_.size[1];
    std::vector<double> differences(static_cast<std::size_t>(width + 1) * height, 0.0);
    for (const Index t : of_slice_[k]) {
      if (rule_ == VoxelRule::Centre) {
        meet_centres(triangles_[t], k, differences);
      } else {
        add_parts(triangles_[t], k, differences);
      }
    }
    for (Index j = 0; j < height; ++j) {
      double sum = 0.0;
      for (Index i = 0; i < width; ++i) {
        sum += differences[static_cast<std::size_t>(j) * (width + 1) + i];
        result.values[grid_.voxel(i, j, k)] = static_cast<float>(sum);
      }
    }
  }

  /// Each piece of a triangle in a voxel takes what lies beyond it along the first index to the inside, or out of it.
  /// Exact, because a piece's share of its voxel is linear in its place.
  void add_parts(const Triangle& triangle, Index k, std::vector<double>& differences) const {
    const CutTriangle slab = CutTriangle(corners_of(triangle)).between(2, k - 0.5, k + 0.5);
    if (slab.is_empty()) return;
    const std::array<Index, 2> rows = voxels_of(1, slab.low(1), slab.high(1));
    for (Index j = rows[0]; j <= rows[1]; ++j) {
      const CutTriangle row = slab.between(1, j - 0.5, j + 0.5);
      if (row.is_empty()) continue;
      double* const line = &differences[static_cast<std::size_t>(j) * (grid_.size[0] + 1)];
      if (row.low(0) < -0.5) line[0] -= handed_ * row.between(0, row.low(0), -0.5).shadow()[0];
      const std::array<Index, 2> voxels = voxels_of(0, row.low(0), row.high(0));
      for (Index i = voxels[0]; i <= voxels[1]; ++i) {
        const std::array<double, 2> shadow = row.between(0, i - 0.5, i + 0.5).shadow();
        const double beyond = shadow[1] - (i - 0.5) * shadow[0];
        line[i] -= handed_ * (shadow[0] - beyond);
        line[i + 1] -= handed_ * beyond;
      }
    }
  }

  /// Rays through the centres, moved by so little that they meet no edge.
  void meet_centres(const Triangle& triangle, Index k, std::vector<double>& differences) const {
    constexpr double kMoveY = 3.7e-9;
    constexpr double kMoveZ = 8.3e-9;
    const CutTriangle whole(corners_of(triangle));
    const std::array<Index, 2> rows = voxels_of(1, whole.low(1), whole.high(1));
    for (Index j = rows[0]; j <= rows[1]; ++j) {
      const double y = j + kMoveY;
      const double z = k + kMoveZ;
      int left = 0;
      for (int r = 0; r < 3; ++r) left += passes_left(points_, triangle[r], triangle[(r + 1) % 3], y, z) ? 1 : 0;
      if (left != 0 && left != 3) continue;
      double sum = 0.0;
      double x = 0.0;
      for (int r = 0; r < 3; ++r) {
        const double weight = side_of(points_, triangle[(r + 1) % 3], triangle[(r + 2) % 3], y, z);
        sum += weight;
        x += weight * points_(triangle[r], 0);
      }
      if (sum == 0.0) continue;
      // A triangle that turns left as the ray sees it has its front side, the outside, ahead.
      const double first = std::clamp(std::ceil(x / sum), 0.0, static_cast<double>(grid_.size[0]));
      differences[static_cast<std::size_t>(j) * (grid_.size[0] + 1) + static_cast<std::size_t>(first)] +=
          left == 3 ? -handed_ : handed_;
    }
  }

  Points points_;
  const VolumeGrid& grid_;
  VoxelRule rule_;
  double handed_;  ///< -1 where indices are left-handed in the world
  std::vector<Triangle> triangles_;
  std::vector<std::vector<Index>> of_slice_;
};

}  // namespace

Volume inside_volume(const Mesh& mesh, const VolumeGrid& grid, VoxelRule rule) {
  require_grid(grid);
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (topology.is_boundary_edge(e))
      throw Error(ErrorCode::BadArgument, "an open surface has no inside: close its holes");
  }
  return Filler(all_triangles(mesh) ? mesh : triangulated(mesh), grid, rule).fill();
}

}  // namespace batten
