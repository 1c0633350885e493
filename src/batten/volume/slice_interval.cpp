#include "batten/volume/slice_interval.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace batten {

namespace {

bool do_overlap(const VoxelFlags& a, const VoxelFlags& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != 0 && b[i] != 0) return true;
  }
  return false;
}

/// To the nearest of some regions.
double nearest_region(const FilledSlice& slice, const std::vector<std::size_t>& regions, std::ptrdiff_t place) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t region : regions) least = std::min<double>(least, slice.regions[region].distances[place]);
  return least;
}

/// How high the cap over a region is, as a share of the way to the next slice. inner: the slice on the other side. The
/// squared depth of a round end falls in proportion to the height.
double cap_height(const SliceRegion& region, const FilledSlice* inner) {
  constexpr double kUnknown = 0.5;  // ends lie anywhere between two slices
  if (inner == nullptr) return kUnknown;
  double depth = 0.0;
  for (std::size_t i = 0; i < region.inside.size(); ++i) {
    if (region.inside[i] != 0) depth = std::max<double>(depth, -inner->distances[i]);
  }
  const double here = region.depth * region.depth;
  const double fall = depth * depth - here;
  return 0.5 * (kUnknown + (fall > here ? here / fall : 1.0));
}

/// How far a region stays away from another one of the next slice, seen along the slices' normal.
double gap_between(const SliceRegion& one, const SliceRegion& other) {
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < one.inside.size(); ++i) {
    if (one.inside[i] != 0) least = std::min(least, other.distances[i]);
  }
  return least;
}

/// The region nearest to one, or null.
const SliceRegion* nearest_of(const SliceRegion& one, const std::vector<const SliceRegion*>& others) {
  const SliceRegion* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const SliceRegion* other : others) {
    const double gap = gap_between(one, *other);
    if (gap >= least) continue;
    least = gap;
    nearest = other;
  }
  return nearest;
}

/// The number at a place that lies so many cells away, or at the nearest one of the plane.
double moved_value(const VolumeGrid& plane, const Buffer<float>& values, std::ptrdiff_t place,
                   const Eigen::Vector2d& by) {
  const auto at = [&](Index from, double cells, int axis) {
    return std::clamp(from + static_cast<Index>(std::lround(cells)), 0, plane.size[axis] - 1);
  };
  const Index i = at(static_cast<Index>(place % plane.size[0]), by[0], 0);
  const Index j = at(static_cast<Index>(place / plane.size[0]), by[1], 1);
  return values[plane.voxel(i, j, 0)];
}

/// The slope of a monotone cubic where two lines meet.
double monotone_slope(double before, double after) {
  return before * after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
}

}  // namespace

/// Regions that overlap belong to one bridge, and so do all that these overlap.
std::vector<SliceInterval::Bridge> SliceInterval::bridges_between(const std::vector<SliceRegion>& below,
                                                                  const std::vector<SliceRegion>& above) {
  std::vector<std::size_t> group(below.size() + above.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t i = 0; i < below.size(); ++i) {
    for (std::size_t j = 0; j < above.size(); ++j) {
      const std::size_t from = group[i];
      const std::size_t to = group[below.size() + j];
      if (from != to && do_overlap(below[i].inside, above[j].inside))
        std::replace(group.begin(), group.end(), from, to);
    }
  }
  std::vector<Bridge> bridges(group.size());
  for (std::size_t i = 0; i < below.size(); ++i) bridges[group[i]].below.push_back(i);
  for (std::size_t j = 0; j < above.size(); ++j) bridges[group[below.size() + j]].above.push_back(j);
  std::erase_if(bridges, [](const Bridge& bridge) { return bridge.below.empty() && bridge.above.empty(); });
  return bridges;
}

double SliceInterval::Cap::value(double away, std::ptrdiff_t place) const {
  return region->distances[place] + region->depth * away * away / (height * height);
}

/// The border moves along the way: places on it are looked up where they come from and where they go.
double SliceInterval::Passage::value(const VolumeGrid& plane, double up, std::ptrdiff_t place) const {
  return (1.0 - up) * moved_value(plane, below->distances, place, -up * way) +
         up * moved_value(plane, above->distances, place, (1.0 - up) * way);
}

/// Regions that overlap none, and of which each is the other's nearest, are joined where they are not farther from each
/// other than the slices: a part does not lie flatter than that between them. They are taken out of the lists.
void SliceInterval::add_passages(std::vector<const SliceRegion*>& below, std::vector<const SliceRegion*>& above) {
  for (auto from = below.begin(); from != below.end();) {
    const SliceRegion* to = nearest_of(**from, above);
    if (to == nullptr || nearest_of(*to, below) != *from || gap_between(**from, *to) > height_) {
      ++from;
      continue;
    }
    passages_.push_back({*from, to, to->centre - (*from)->centre});
    std::erase(above, to);
    from = below.erase(from);
  }
}

SliceInterval::Cap SliceInterval::cap_of(const SliceRegion& region, const FilledSlice* inner) {
  return {&region, cap_height(region, inner)};
}

SliceInterval::SliceInterval(const VolumeGrid& plane, const std::vector<FilledSlice>& slices, std::ptrdiff_t above)
    : plane_(plane) {
  const auto slice = [&](std::ptrdiff_t i) {
    return i >= 0 && i < static_cast<std::ptrdiff_t>(slices.size()) ? &slices[i] : nullptr;
  };
  above_ = slice(above);
  below_ = slice(above - 1);
  further_up_ = slice(above + 1);
  further_down_ = slice(above - 2);
  if (below_ != nullptr && above_ != nullptr)
    height_ = above_->level - below_->level;
  else
    height_ = below_ != nullptr ? below_->level - further_down_->level : further_up_->level - above_->level;
  static const std::vector<SliceRegion> none;
  const std::vector<SliceRegion>& regions_below = below_ != nullptr ? below_->regions : none;
  const std::vector<SliceRegion>& regions_above = above_ != nullptr ? above_->regions : none;
  std::vector<const SliceRegion*> alone_below;
  std::vector<const SliceRegion*> alone_above;
  for (const Bridge& bridge : bridges_between(regions_below, regions_above)) {
    if (!bridge.below.empty() && !bridge.above.empty())
      bridges_.push_back(bridge);
    else if (bridge.above.empty())
      alone_below.push_back(&regions_below[bridge.below.front()]);
    else
      alone_above.push_back(&regions_above[bridge.above.front()]);
  }
  add_passages(alone_below, alone_above);
  for (const SliceRegion* region : alone_below) caps_below_.push_back(cap_of(*region, further_down_));
  for (const SliceRegion* region : alone_above) caps_above_.push_back(cap_of(*region, further_up_));
}

double SliceInterval::value(double level, std::ptrdiff_t place) const {
  double least = std::numeric_limits<double>::infinity();
  if (below_ != nullptr) {
    const double up = (level - below_->level) / height_;
    for (const Bridge& bridge : bridges_) least = std::min(least, bridge_value(bridge, up, place));
    for (const Passage& passage : passages_) least = std::min(least, passage.value(plane_, up, place));
    for (const Cap& cap : caps_below_) least = std::min(least, cap.value(up, place));
  }
  for (const Cap& cap : caps_above_) least = std::min(least, cap.value((above_->level - level) / height_, place));
  return least;
}

double SliceInterval::bridge_value(const Bridge& bridge, double up, std::ptrdiff_t place) const {
  const double from = nearest_region(*below_, bridge.below, place);
  const double to = nearest_region(*above_, bridge.above, place);
  const double rise = to - from;
  double before = rise;
  double after = rise;
  if (further_down_ != nullptr)
    before = (from - further_down_->distances[place]) * height_ / (below_->level - further_down_->level);
  if (further_up_ != nullptr)
    after = (further_up_->distances[place] - to) * height_ / (further_up_->level - above_->level);
  const double leaving = monotone_slope(before, rise);
  const double arriving = monotone_slope(rise, after);
  const double down = 1.0 - up;
  return from + rise * up * up * (3.0 - 2.0 * up) + up * down * (leaving * down - arriving * up);
}

}  // namespace batten
