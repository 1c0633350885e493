#include "batten/volume/slices_mask.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/slice_interval.h"

namespace batten {

namespace {

/// The points of each slice along and across it; z is 0.
std::vector<Points> flat_points(const Points& local, const PointSlices& slices) {
  std::vector<Points> planes;
  for (const std::vector<Eigen::Index>& rows : slices.rows) {
    planes.push_back(local(rows, Eigen::all));
    planes.back().col(2).setZero();
  }
  return planes;
}

/// The box of the points along the slices.
struct PlaneBox {
  Eigen::RowVector3d low;
  Eigen::RowVector3d high;
  double side() const { return (high - low).head<2>().maxCoeff(); }
};

/// A grid along the slices for disks of a radius, with room around the points for larger ones.
VolumeGrid plane_grid(const PlaneBox& box, double radius, double largest) {
  constexpr double kFinest = 256.0;   // cells along the longer side
  constexpr double kOfRadius = 0.25;  // a cell
  const double cell = std::max(kOfRadius * radius, box.side() / kFinest);
  const auto margin = static_cast<Index>(std::ceil(2.0 * largest / cell)) + 3;
  VolumeGrid plane;
  plane.axes *= cell;
  plane.size[2] = 1;
  for (int c = 0; c < 2; ++c) {
    plane.origin[c] = box.low[c] - margin * cell;
    plane.size[c] = static_cast<Index>(std::ceil((box.high[c] - box.low[c]) / cell)) + 1 + 2 * margin;
  }
  return plane;
}

/// The radius of the disk that closes the contours of a slice: `first`, or wider where disks up to four times as wide
/// would enclose much more: then a contour is open.
double closing_radius(const PlaneBox& box, const Points& points, double first, double last) {
  constexpr double kWider = 4.0;
  constexpr double kMuch = 1.25;
  constexpr double kGrowth = 1.4;
  std::vector<double> radii;
  std::vector<double> areas;
  for (double radius = first; radii.empty() || radius <= last; radius *= kGrowth) {
    const VolumeGrid grid = plane_grid(box, radius, radius);
    radii.push_back(radius);
    areas.push_back(static_cast<double>(count_of(enclosed_in_plane(grid, points, radius))) * grid.spacing(0) *
                    grid.spacing(1));
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    bool is_closed = true;
    for (std::size_t j = i + 1; j < radii.size() && radii[j] <= kWider * radii[i]; ++j)
      is_closed = is_closed && areas[j] <= kMuch * areas[i];
    if (is_closed) return radii[i];
  }
  return radii.back();
}

/// Where the mask lies: every `step`-th place of the planes, and as far apart across them.
VolumeGrid mask_grid(const PointSlices& slices, const VolumeGrid& plane, Index step) {
  const double cell = step * plane.spacing(0);
  double beyond = 0.0;
  for (std::size_t i = 1; i < slices.levels.size(); ++i)
    beyond = std::max(beyond, slices.levels[i] - slices.levels[i - 1]);
  const double height = slices.levels.back() - slices.levels.front() + 2.0 * beyond;
  VolumeGrid grid;
  grid.axes = slices.axes * cell;
  grid.size = {(plane.size[0] - 1) / step + 1, (plane.size[1] - 1) / step + 1,
               static_cast<Index>(std::ceil(height / cell)) + 1};
  grid.origin = slices.axes * Eigen::Vector3d(plane.origin[0], plane.origin[1], slices.levels.front() - beyond);
  require_grid(grid);
  return grid;
}

/// What lies between the slices, and beyond the first and the last one.
Volume interpolated_slices(const PointSlices& slices, const VolumeGrid& plane, const std::vector<FilledSlice>& filled,
                           Index step) {
  constexpr std::ptrdiff_t kSlicesAtOnce = 4;
  Volume mask;
  mask.grid = mask_grid(slices, plane, step);
  mask.values.assign(static_cast<std::size_t>(mask.grid.count()), 0.0F);
  std::vector<SliceInterval> intervals;
  for (std::ptrdiff_t above = 0; above <= static_cast<std::ptrdiff_t>(filled.size()); ++above)
    intervals.emplace_back(plane, filled, above);
  const std::array<Index, 3> size = mask.grid.size;
  const double lowest = (slices.axes.transpose() * mask.grid.origin)[2];
  const auto fill = [&](Index k) {
    const double level = lowest + k * mask.grid.spacing(2);
    const auto above = std::upper_bound(slices.levels.begin(), slices.levels.end(), level) - slices.levels.begin();
    for (Index j = 0; j < size[1]; ++j) {
      for (Index i = 0; i < size[0]; ++i) {
        if (intervals[above].value(level, plane.voxel(i * step, j * step, 0)) < 0.0)
          mask.values[mask.grid.voxel(i, j, k)] = 1.0F;
      }
    }
  };
  parallel_for(
      size[2],
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t k = begin; k < end; ++k) fill(static_cast<Index>(k));
      },
      kSlicesAtOnce);
  return mask;
}

}  // namespace

Volume slices_mask(const Points& points, const PointSlices& slices, Index cells) {
  constexpr double kClosing = 0.55;  // of the gaps: more than half
  constexpr double kMost = 0.95;     // of the gaps
  constexpr double kLeast = 1.0 / 64.0;
  constexpr double kLargest = 0.25;  // of the longer side: disks
  constexpr double kThin = 16.0;     // cells along a slice at least
  constexpr double kLong = 8.0;      // times as many cells as asked for, where slices are small
  if (cells < 8 || cells > 256) throw Error(ErrorCode::BadArgument, "a grid of 8 to 256 cells along a side");
  const Points local = points * slices.axes;
  const PlaneBox box{local.colwise().minCoeff(), local.colwise().maxCoeff()};
  const std::vector<Points> planes = flat_points(local, slices);
  std::vector<double> gaps = contour_gaps(planes);
  if (gaps.empty())
    throw Error(ErrorCode::BadArgument, "the points of a slice lie on a line; give some around the part");
  const double first = std::max(kClosing * quantile(gaps, kMost), kLeast * box.side());
  const double last = std::max(first, kLargest * box.side());
  const VolumeGrid plane = plane_grid(box, first, last);
  std::vector<FilledSlice> filled;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const VoxelFlags inside = enclosed_in_plane(plane, planes[i], closing_radius(box, planes[i], first, last));
    filled.push_back({slices.levels[i], slice_regions(plane, inside), signed_distances(plane, inside)});
  }
  const double longest = (box.high - box.low).maxCoeff();
  const double cell = std::clamp(box.side() / kThin, longest / (kLong * cells), longest / cells);
  const auto step = std::max<Index>(1, static_cast<Index>(std::lround(cell / plane.spacing(0))));
  const Volume mask = interpolated_slices(slices, plane, filled, step);
  if (std::all_of(mask.values.begin(), mask.values.end(), [](float value) { return value == 0.0F; }))
    throw Error(ErrorCode::BadArgument, "the points enclose nothing; give more points around the part");
  return label_mask(mask, {});
}

}  // namespace batten
