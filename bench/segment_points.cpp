/// The table of points of docs/segment.md: atlas labels of Debian's mricron-data, from points on their borders and the
/// image. Each row is a label's mean, least and greatest Dice.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "batten/volume/distance_transform.h"
#include "batten/volume/inside_volume.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/mask_contours.h"
#include "batten/volume/segment_volume.h"
#include "batten/volume/volume_file.h"
#include "batten/volume/voxel_flood.h"

namespace batten::bench {
namespace {

const std::string kFolder = "/usr/share/mricron/templates/";
constexpr Index kWide = 20;  // a margin in which balls have room
constexpr Index kEvery = 4;  // slice has points; the margin of masks is as wide

/// The mask with all that a ball outside of it does not reach, so that clefts narrower than twice the radius are
/// closed, and without holes. The mask must have a margin of that width.
Volume closed_mask(Volume mask, double radius) {
  const auto flag = [&](const auto& is_set) {
    VoxelFlags flags(mask.values.size());
    for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = is_set(i) ? 1 : 0;
    return flags;
  };
  const Buffer<float> to_mask =
      distance_transform(mask.grid, flag([&](std::size_t i) { return mask.values[i] > 0.5F; }));
  const Buffer<float> to_centres =
      distance_transform(mask.grid, flag([&](std::size_t i) { return to_mask[i] > radius; }));
  const VoxelFlags closed = without_holes(mask.grid, flag([&](std::size_t i) { return to_centres[i] > radius; }));
  std::copy(closed.begin(), closed.end(), mask.values.begin());
  return mask;
}

/// So many points of the border, each as far from those before as can be. draw: chooses the first one; 0 for row 0.
Points spread_points(const Volume& mask, Index count, unsigned draw) {
  const Points border = mask_border(mask).points;
  std::mt19937 random(draw);
  Scalars far = Scalars::Constant(border.rows(), std::numeric_limits<double>::infinity());
  Points points(count, 3);
  Eigen::Index next = 0;
  if (draw > 0) next = static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(border.rows()));
  for (Index i = 0; i < count; ++i) {
    points.row(i) = border.row(next);
    far = far.cwiseMin((border.rowwise() - border.row(next)).rowwise().norm());
    far.maxCoeff(&next);
  }
  return points;
}

/// Of all voxels, and of those in slices that no point lies in.
struct Agreement {
  double all = 0.0;
  double hidden = 0.0;
};

SegmentResult segmented(const Volume& image, const Points& points) {
  SegmentRequest request;
  request.points = points;
  return segment_volume(image, request);
}

Agreement agreement_in_slices(const Volume& image, const Volume& mask, Index offset) {
  const SegmentResult found = segmented(image, mask_contours(mask, kEvery, offset).points);
  Volume inside = inside_volume(found.measures.fine, mask.grid, VoxelRule::Centre);
  Volume shown = mask;
  const double all = dice(inside, mask);
  for (std::ptrdiff_t voxel = 0; voxel < mask.grid.count(); ++voxel) {
    const auto slice = voxel / (static_cast<std::ptrdiff_t>(mask.grid.size[0]) * mask.grid.size[1]);
    if (slice % kEvery == offset) inside.values[voxel] = shown.values[voxel] = 0.0F;
  }
  return {all, dice(inside, shown)};
}

std::string text_of(const std::vector<double>& dices) {
  double sum = 0.0;
  for (const double dice : dices) sum += dice;
  char text[64];
  std::snprintf(text, sizeof text, "%.3f (%.3f to %.3f)", sum / static_cast<double>(dices.size()),
                *std::min_element(dices.begin(), dices.end()), *std::max_element(dices.begin(), dices.end()));
  return text;
}

void print_slices(const Volume& image, const Volume& labels, double label, const char* name) {
  const Volume mask = label_mask(labels, {label});
  std::vector<double> all;
  std::vector<double> hidden;
  for (Index offset = 0; offset < kEvery; ++offset) {
    const Agreement found = agreement_in_slices(image, mask, offset);
    all.push_back(found.all);
    hidden.push_back(found.hidden);
  }
  std::printf("| %s (%g), every 4th slice | %s | %s |\n", name, label, text_of(all).c_str(), text_of(hidden).c_str());
  std::fflush(stdout);
}

/// The mean of three draws, with the least and the greatest.
void print_spread(const Volume& image, const Volume& mask, const char* name) {
  for (const Index count : {60, 30}) {
    std::vector<double> dices;
    for (unsigned draw = 0; draw < 3; ++draw) {
      const SegmentResult found = segmented(image, spread_points(mask, count, draw));
      dices.push_back(dice(inside_volume(found.measures.fine, mask.grid, VoxelRule::Centre), mask));
    }
    std::printf("| %s, %d points spread | %s | |\n", name, count, text_of(dices).c_str());
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace batten::bench

int main() {
  using namespace batten;
  const Volume brain = read_volume(bench::kFolder + "ch2.nii.gz");
  const Volume atlas = read_volume(bench::kFolder + "aal.nii.gz");
  std::printf("| part | Dice | in slices without points |\n|---|---|---|\n");
  bench::print_slices(brain, atlas, 71, "caudate, left");
  bench::print_slices(brain, atlas, 72, "caudate, right");
  bench::print_slices(brain, atlas, 37, "hippocampus, left");
  // These were not looked at while the settings were chosen.
  bench::print_slices(brain, atlas, 41, "amygdala, left");
  bench::print_slices(brain, atlas, 74, "putamen, right");
  bench::print_slices(brain, atlas, 78, "thalamus, right");
  const Volume macaque = read_volume(bench::kFolder + "inia19-t1-brain.nii.gz");
  const Volume parts = read_volume(bench::kFolder + "inia19-NeuroMaps.nii.gz");
  bench::print_slices(macaque, parts, 1098, "macaque, putamen");
  bench::print_spread(macaque, label_mask(parts, {98.0}), "macaque, putamen (98)");
  bench::print_spread(macaque, label_mask(parts, {1098.0}), "macaque, putamen (1098)");
  std::vector<double> cerebellum;
  for (int label = 91; label <= 108; ++label) cerebellum.push_back(label);
  bench::print_spread(brain, label_mask(atlas, cerebellum), "cerebellum (91 to 108)");
  for (int label = 109; label <= 116; ++label) cerebellum.push_back(label);
  const Volume whole = label_mask(atlas, cerebellum, bench::kWide);
  bench::print_spread(brain, whole, "cerebellum with its vermis (91 to 116)");
  bench::print_spread(brain, bench::closed_mask(whole, 15.0), "the same, closed by a ball of 15 mm");
}
