#include "batten/volume/slice_interval.h"

#include <algorithm>
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

SliceInterval::Cap SliceInterval::cap_of(const SliceRegion& region, const FilledSlice* inner) {
  return {&region, cap_height(region, inner)};
}

SliceInterval::SliceInterval(const std::vector<FilledSlice>& slices, std::ptrdiff_t above) {
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
  for (const Bridge& bridge : bridges_between(regions_below, regions_above)) {
    if (!bridge.below.empty() && !bridge.above.empty())
      bridges_.push_back(bridge);
    else if (bridge.above.empty())
      caps_below_.push_back(cap_of(regions_below[bridge.below.front()], further_down_));
    else
      caps_above_.push_back(cap_of(regions_above[bridge.above.front()], further_up_));
  }
}

double SliceInterval::value(double level, std::ptrdiff_t place) const {
  double least = std::numeric_limits<double>::infinity();
  if (below_ != nullptr) {
    const double up = (level - below_->level) / height_;
    for (const Bridge& bridge : bridges_) least = std::min(least, bridge_value(bridge, up, place));
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
