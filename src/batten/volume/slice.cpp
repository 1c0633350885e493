#include "batten/volume/slice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "batten/error.h"

namespace batten {

namespace {

/// Which index of the volume runs along each axis of the world, most nearly; each index once.
std::array<int, 3> indices_along_world(const VolumeGrid& grid) {
  std::array<int, 3> order{0, 1, 2};
  std::array<int, 3> best = order;
  double most = -1.0;
  do {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) sum += std::abs(grid.axes(c, order[c])) / grid.spacing(order[c]);
    if (sum > most) {
      most = sum;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

/// A slice in the making: index `across` is fixed, `right` and `up` run along the picture.
struct Plane {
  int across;
  int right;
  int up;
  bool right_turned;  ///< the index falls from left to right
  bool up_turned;     ///< the index falls from the foot to the top
};

/// A range of voxels along an index.
struct Range {
  Index low;
  Index count;
};

Range range_of(const Points& indices, int axis, Index size) {
  constexpr double kMargin = 0.35;
  const double low = indices.col(axis).minCoeff();
  const double high = indices.col(axis).maxCoeff();
  const double margin = kMargin * (high - low) + 3.0;
  const auto first = static_cast<Index>(std::clamp(std::floor(low - margin), 0.0, size - 1.0));
  const auto last = static_cast<Index>(std::clamp(std::ceil(high + margin), 0.0, size - 1.0));
  return {first, last - first + 1};
}

/// Adds the line in which a triangle cuts the plane.
void cut_triangle(const Points& indices, const Index* corners, const Plane& plane, double at,
                  std::vector<std::array<double, 2>>& ends) {
  std::array<std::array<double, 2>, 3> found{};
  int count = 0;
  for (int r = 0; r < 3 && count < 3; ++r) {
    const Index a = corners[r];
    const Index b = corners[(r + 1) % 3];
    const double from = indices(a, plane.across) - at;
    const double to = indices(b, plane.across) - at;
    if ((from > 0.0) == (to > 0.0)) continue;
    const double share = from / (from - to);
    const Eigen::RowVector3d place = indices.row(a) + share * (indices.row(b) - indices.row(a));
    found[count++] = {place(plane.right), place(plane.up)};
  }
  if (count == 2) ends.insert(ends.end(), {found[0], found[1]});
}

VolumeSlice make_slice(const Volume& image, const Points& indices, const Mesh& fine, const Plane& plane, Index at) {
  const Range columns = range_of(indices, plane.right, image.grid.size[plane.right]);
  const Range rows = range_of(indices, plane.up, image.grid.size[plane.up]);
  VolumeSlice slice;
  slice.pixel_width = image.grid.spacing(plane.right);
  slice.pixel_height = image.grid.spacing(plane.up);
  slice.numbers.resize(rows.count, columns.count);
  std::array<Index, 3> voxel{};
  voxel[plane.across] = at;
  for (Index row = 0; row < rows.count; ++row) {
    voxel[plane.up] = rows.low + (plane.up_turned ? row : rows.count - 1 - row);
    for (Index column = 0; column < columns.count; ++column) {
      voxel[plane.right] = columns.low + (plane.right_turned ? columns.count - 1 - column : column);
      slice.numbers(row, column) = image.at(voxel[0], voxel[1], voxel[2]);
    }
  }
  std::vector<std::array<double, 2>> ends;
  for (std::size_t c = 0; c < fine.face_vertices.size(); c += 3)
    cut_triangle(indices, &fine.face_vertices[c], plane, at, ends);
  const auto x = [&](double index) {
    const double place = index - columns.low + 0.5;
    return plane.right_turned ? columns.count - place : place;
  };
  const auto y = [&](double index) {
    const double place = index - rows.low + 0.5;
    return plane.up_turned ? place : rows.count - place;
  };
  for (std::size_t i = 0; i < ends.size(); i += 2)
    slice.lines.push_back({x(ends[i][0]), y(ends[i][1]), x(ends[i + 1][0]), y(ends[i + 1][1])});
  return slice;
}

}  // namespace

std::vector<VolumeSlice> slices_through(const Volume& image, const Mesh& fine, int count) {
  require_volume(image);
  if (count < 1) throw Error(ErrorCode::BadArgument, "one slice or more");
  if (!all_triangles(fine)) throw Error(ErrorCode::NotTriangles, "slices cut triangles");
  constexpr std::array<const char*, 3> kNames{"sagittal, x", "coronal, y", "axial, z"};
  const Points indices = image.grid.to_indices(fine.points);
  const std::array<int, 3> along = indices_along_world(image.grid);
  std::vector<VolumeSlice> slices;
  for (int world = 0; world < 3; ++world) {
    const int right = world == 0 ? 1 : 0;
    const int up = world == 2 ? 1 : 2;
    const Plane plane{along[world], along[right], along[up], image.grid.axes(right, along[right]) < 0.0,
                      image.grid.axes(up, along[up]) < 0.0};
    const double low = indices.col(plane.across).minCoeff();
    const double high = indices.col(plane.across).maxCoeff();
    if (!(high > -0.5 && low < image.grid.size[plane.across] - 0.5))
      throw Error(ErrorCode::BadArgument, "the surface does not lie in the volume");
    for (int number = 0; number < count; ++number) {
      const double place = low + (high - low) * (number + 1.0) / (count + 1.0);
      const auto at = static_cast<Index>(std::clamp(std::round(place), 0.0, image.grid.size[plane.across] - 1.0));
      slices.push_back(make_slice(image, indices, fine, plane, at));
      Eigen::Vector3d middle = indices.colwise().mean().transpose();
      middle[plane.across] = at;
      std::array<char, 48> caption{};
      std::snprintf(caption.data(), caption.size(), "%s = %.1f mm", kNames[world], image.grid.to_world(middle)[world]);
      slices.back().caption = caption.data();
    }
  }
  return slices;
}

}  // namespace batten
