#include "batten/volume/seed_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "batten/error.h"
#include "batten/quantile.h"
#include "batten/volume/front_times.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/recursive_filter.h"
#include "batten/volume/voxel_flood.h"

namespace batten {

namespace {

/// The image around the seed.
struct SeedBox {
  Volume smooth;
  Volume edges;               ///< |gradient|
  std::array<Index, 3> at;    ///< the seed's voxel
  std::array<bool, 3> grows;  ///< the image goes on beyond the box along the index
};

SeedBox box_around(const Volume& image, const Eigen::Vector3d& seed, Index margin) {
  Points place(1, 3);
  place.row(0) = seed.transpose();
  const Volume part = cropped_around(image, place, margin);
  const double alpha = 2.0 / std::cbrt(image.grid.voxel_volume());
  SeedBox box;
  box.smooth = filtered(part, {FilterOrder::Smooth, FilterOrder::Smooth, FilterOrder::Smooth}, alpha);
  box.edges = edge_magnitude(gradient(part, alpha));
  const Points index = part.grid.to_indices(place);
  for (int c = 0; c < 3; ++c) {
    box.at[c] = std::clamp<Index>(static_cast<Index>(std::lround(index(0, c))), 0, part.grid.size[c] - 1);
    box.grows[c] = part.grid.size[c] < image.grid.size[c];
  }
  return box;
}

/// The numbers of the part, as those around the seed say.
struct Likeness {
  double mean = 0.0;
  double width = 0.0;
};

/// Of the voxels within two voxels.
Likeness likeness_of(const SeedBox& box, double strong) {
  constexpr Index kReach = 2;
  constexpr double kWidths = 3.0;  // of the scatter
  constexpr double kLeast = 0.1;   // of the step that a strong edge makes in a voxel
  const VolumeGrid& grid = box.smooth.grid;
  double count = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (Index k = box.at[2] - kReach; k <= box.at[2] + kReach; ++k) {
    for (Index j = box.at[1] - kReach; j <= box.at[1] + kReach; ++j) {
      for (Index i = box.at[0] - kReach; i <= box.at[0] + kReach; ++i) {
        const bool there = i >= 0 && j >= 0 && k >= 0 && i < grid.size[0] && j < grid.size[1] && k < grid.size[2];
        if (!there) continue;
        const double number = box.smooth.at(i, j, k);
        count += 1.0;
        sum += number;
        squares += number * number;
      }
    }
  }
  const double mean = sum / count;
  const double scatter = std::sqrt(std::max(0.0, squares / count - mean * mean));
  return {mean, std::max(kWidths * scatter, kLeast * strong * std::cbrt(grid.voxel_volume()))};
}

Buffer<float> costs_of(const SeedBox& box, const SeedOptions& options) {
  constexpr double kStrong = 0.9;
  constexpr double kMost = 30.0;
  std::vector<float> edges(box.edges.values.begin(), box.edges.values.end());
  const double strong =
      std::max<double>(quantile(edges, kStrong), 1e-6 * *std::max_element(edges.begin(), edges.end()));
  const Likeness like = likeness_of(box, strong);
  Buffer<float> costs(box.smooth.values.size(), 1.0F);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const double number = box.smooth.values[i];
    const double edge = strong > 0.0 ? box.edges.values[i] / strong : 0.0;
    const double far = like.width > 0.0 ? (number - like.mean) / like.width : 0.0;
    const bool out = options.range && (number < options.range->low || number > options.range->high);
    costs[i] = out ? std::numeric_limits<float>::infinity()
                   : static_cast<float>((1.0 + std::pow(edge, 4.0)) *
                                        (options.range ? 1.0 : std::exp(std::min(kMost, far * far))));
  }
  return costs;
}

/// A region is compared with those up to so many times its size.
constexpr std::size_t kBeyond = 2;

/// One of the nested regions: the first `count` voxels of a front's order.
struct Stage {
  std::size_t count = 0;
  double edges = 0.0;  ///< the mean under the border
};

/// The area of a voxel's face across an index.
std::array<double, 3> face_areas(const VolumeGrid& grid) {
  std::array<double, 3> areas{};
  for (int c = 0; c < 3; ++c) areas[c] = grid.axes.col((c + 1) % 3).cross(grid.axes.col((c + 2) % 3)).norm();
  return areas;
}

/// Across which index two voxels beside each other lie.
int axis_between(const VolumeGrid& grid, std::ptrdiff_t a, std::ptrdiff_t b) {
  const std::ptrdiff_t far = std::abs(a - b);
  return far == 1 && grid.size[0] > 1 ? 0 : far == grid.size[0] ? 1 : 2;
}

/// The nested regions, each an eighth larger than the one before.
std::vector<Stage> stages_of(const SeedBox& box, const Front& front) {
  constexpr double kGrowth = 1.125;
  constexpr double kLeast = 20.0;
  const VolumeGrid& grid = box.smooth.grid;
  const std::array<double, 3> areas = face_areas(grid);
  VoxelFlags inside(front.times.size(), 0);
  std::vector<Stage> stages;
  double area = 0.0;
  double sum = 0.0;
  double next = kLeast;
  for (std::size_t n = 0; n < front.order.size(); ++n) {
    const std::ptrdiff_t voxel = front.order[n];
    inside[voxel] = 1;
    for_each_beside(grid, voxel, [&](std::ptrdiff_t beside) {
      const double sign = inside[beside] != 0 ? -1.0 : 1.0;
      const double face = sign * areas[axis_between(grid, voxel, beside)];
      area += face;
      sum += face * 0.5 * (box.edges.values[voxel] + box.edges.values[beside]);
    });
    if (static_cast<double>(n + 1) < next || !(area > 0.0)) continue;
    stages.push_back({n + 1, sum / area});
    next = kGrowth * static_cast<double>(n + 1);
  }
  return stages;
}

/// The first stage whose edges are stronger than those of all up to twice as large, or none. A front that ends
/// has ended at the range that was given: then the last stage is as good as any.
const Stage* choose_stage(const std::vector<Stage>& stages, bool ends) {
  constexpr double kOfBest = 1.0 / 3.0;
  double best = 0.0;
  for (const Stage& stage : stages) best = std::max(best, stage.edges);
  if (!(best > 0.0)) return nullptr;
  for (auto stage = stages.begin(); stage != stages.end(); ++stage) {
    if (stage->edges < kOfBest * best) continue;
    const auto end =
        std::find_if(stage, stages.end(), [&](const Stage& s) { return s.count > kBeyond * stage->count; });
    if (end == stages.end() && !ends) return nullptr;
    if (std::all_of(stage, end, [&](const Stage& later) { return later.edges <= stage->edges; })) return &*stage;
  }
  return nullptr;
}

/// The share of the border's area with edges of less than a quarter of `mean`.
double open_share(const SeedBox& box, const VoxelFlags& region, double mean) {
  constexpr double kWeak = 0.25;
  const VolumeGrid& grid = box.smooth.grid;
  const std::array<double, 3> areas = face_areas(grid);
  double area = 0.0;
  double weak = 0.0;
  for (std::ptrdiff_t voxel = 0; voxel < grid.count(); ++voxel) {
    if (region[voxel] == 0) continue;
    for_each_beside(grid, voxel, [&](std::ptrdiff_t beside) {
      if (region[beside] != 0) return;
      const double face = areas[axis_between(grid, voxel, beside)];
      area += face;
      if (0.5 * (box.edges.values[voxel] + box.edges.values[beside]) < kWeak * mean) weak += face;
    });
  }
  return area > 0.0 ? weak / area : 0.0;
}

/// Whether the region reaches a side of the box beyond which the image goes on.
bool touches_side(const SeedBox& box, const VoxelFlags& region) {
  const VolumeGrid& grid = box.smooth.grid;
  for (Index k = 0; k < grid.size[2]; ++k) {
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i) {
        if (region[grid.voxel(i, j, k)] == 0) continue;
        const std::array<Index, 3> at{i, j, k};
        for (int c = 0; c < 3; ++c) {
          if (box.grows[c] && (at[c] == 0 || at[c] + 1 == grid.size[c])) return true;
        }
      }
    }
  }
  return false;
}

void require_seed(const Volume& image, const Eigen::Vector3d& seed, const SeedOptions& options) {
  if (!seed.allFinite()) throw Error(ErrorCode::NotFinite, "the seed is not finite");
  if (options.range && !(options.range->low <= options.range->high))
    throw Error(ErrorCode::BadArgument, "a range begins with its lower number");
  Points place(1, 3);
  place.row(0) = seed.transpose();
  const Points index = image.grid.to_indices(place);
  for (int c = 0; c < 3; ++c) {
    if (!(index(0, c) >= -0.5 && index(0, c) <= image.grid.size[c] - 0.5))
      throw Error(ErrorCode::BadArgument, "the seed lies outside the image; it is given in the world's mm");
  }
}

/// Without what is thinner than the smoothing, where that leaves most of it: one piece without holes.
VoxelFlags smoothed(const VolumeGrid& grid, const VoxelFlags& region) {
  constexpr double kMost = 0.5;
  Volume part;
  part.grid = grid;
  part.values.assign(region.begin(), region.end());
  const double alpha = 2.0 / std::cbrt(grid.voxel_volume());
  part = filtered(part, {FilterOrder::Smooth, FilterOrder::Smooth, FilterOrder::Smooth}, alpha);
  VoxelFlags smooth(region.size());
  for (std::size_t i = 0; i < smooth.size(); ++i) smooth[i] = part.values[i] > 0.5F ? 1 : 0;
  smooth = without_holes(grid, largest_piece(grid, smooth));
  return static_cast<double>(count_of(smooth)) > kMost * static_cast<double>(count_of(region)) ? smooth : region;
}

/// The region as a mask, with what is known of it; nothing where the front finds no edges, or the region reaches a side
/// of the box.
std::optional<SeedRegion> region_in(const SeedBox& box, const SeedOptions& options) {
  const VolumeGrid& grid = box.smooth.grid;
  const std::ptrdiff_t seed = grid.voxel(box.at[0], box.at[1], box.at[2]);
  const Front front = march_front(grid, costs_of(box, options), seed);
  const std::vector<Stage> stages = stages_of(box, front);
  const Stage* const stage = choose_stage(stages, options.range.has_value());
  if (stage == nullptr) return {};
  VoxelFlags region(front.times.size(), 0);
  for (std::size_t n = 0; n < stage->count; ++n) region[front.order[n]] = 1;
  region = smoothed(grid, without_holes(grid, region));
  const bool grows = std::any_of(box.grows.begin(), box.grows.end(), [](bool more) { return more; });
  if (grows && touches_side(box, region)) return {};
  SeedRegion found;
  Volume mask;
  mask.grid = grid;
  mask.values.assign(region.begin(), region.end());
  found.mask = label_mask(mask, {});
  found.volume = grid.voxel_volume() * static_cast<double>(count_of(region));
  found.edges = stage->edges;
  found.open = open_share(box, region, stage->edges);
  const auto beyond =
      std::find_if(stages.begin(), stages.end(), [&](const Stage& s) { return s.count >= kBeyond * stage->count; });
  found.edges_beyond = beyond == stages.end() ? 0.0 : beyond->edges / stage->edges;
  return found;
}

}  // namespace

SeedRegion seed_region(const Volume& image, const Eigen::Vector3d& seed, const SeedOptions& options,
                       const Progress& progress) {
  constexpr Index kFirstMargin = 32;
  constexpr Index kLastMargin = 128;
  require_volume(image);
  require_seed(image, seed, options);
  for (Index margin = kFirstMargin;; margin *= 2) {
    report_progress(progress, 0.0);
    const SeedBox box = box_around(image, seed, margin);
    const double number = box.smooth.at(box.at[0], box.at[1], box.at[2]);
    if (options.range && !(number >= options.range->low && number <= options.range->high))
      throw Error(ErrorCode::BadArgument,
                  "the smoothed image has " + std::to_string(number) + " at the seed, which is not in the range");
    std::optional<SeedRegion> found = region_in(box, options);
    if (found) return std::move(*found);
    const bool whole = std::none_of(box.grows.begin(), box.grows.end(), [](bool grows) { return grows; });
    if (whole || margin >= kLastMargin)
      throw Error(ErrorCode::BadArgument,
                  "nothing with edges around it is found at the seed; give the range of its numbers, or another start");
  }
}

}  // namespace batten
