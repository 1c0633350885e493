/// The table of points of docs/segment.md: atlas labels of Debian's mricron-data, from points on their borders and the
/// image. Each row is a label's mean, least and greatest Dice.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "batten/volume/inside_volume.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/segment_volume.h"
#include "batten/volume/volume_file.h"

namespace batten::bench {
namespace {

const std::string kFolder = "/usr/share/mricron/templates/";

/// The border of a mask in every fourth slice: the middles of the faces between voxels of a slice.
Points points_in_slices(const Volume& mask, Index offset) {
  const Points border = mask_border(mask).points;
  const Points indices = mask.grid.to_indices(border);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < border.rows(); ++row) {
    const double slice = indices(row, 2);
    const bool within = std::abs(slice - std::round(slice)) < 0.1;
    if (within && std::lround(slice) % 4 == offset) rows.push_back(row);
  }
  return border(rows, Eigen::all);
}

/// So many points of the border, each as far from those before as can be.
Points spread_points(const Volume& mask, Index count) {
  const Points border = mask_border(mask).points;
  Scalars far = Scalars::Constant(border.rows(), std::numeric_limits<double>::infinity());
  Points points(count, 3);
  Eigen::Index next = 0;
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
  const SegmentResult found = segmented(image, points_in_slices(mask, offset));
  Volume inside = inside_volume(found.measures.fine, mask.grid, VoxelRule::Centre);
  Volume shown = mask;
  const double all = dice(inside, mask);
  for (std::ptrdiff_t voxel = 0; voxel < mask.grid.count(); ++voxel) {
    const auto slice = voxel / (static_cast<std::ptrdiff_t>(mask.grid.size[0]) * mask.grid.size[1]);
    if (slice % 4 == offset) inside.values[voxel] = shown.values[voxel] = 0.0F;
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
  for (Index offset = 0; offset < 4; ++offset) {
    const Agreement found = agreement_in_slices(image, mask, offset);
    all.push_back(found.all);
    hidden.push_back(found.hidden);
  }
  std::printf("| %s (%g), every 4th slice | %s | %s |\n", name, label, text_of(all).c_str(), text_of(hidden).c_str());
  std::fflush(stdout);
}

void print_spread(const Volume& image, const Volume& labels, const std::vector<double>& label, const char* name) {
  const Volume mask = label_mask(labels, label);
  for (const Index count : {60, 30}) {
    const SegmentResult found = segmented(image, spread_points(mask, count));
    std::printf("| %s, %d points spread | %.3f | |\n", name, count,
                dice(inside_volume(found.measures.fine, mask.grid, VoxelRule::Centre), mask));
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
  std::vector<double> cerebellum;
  for (int label = 91; label <= 108; ++label) cerebellum.push_back(label);
  bench::print_spread(brain, atlas, cerebellum, "cerebellum (91 to 108)");
  for (int label = 109; label <= 116; ++label) cerebellum.push_back(label);
  bench::print_spread(brain, atlas, cerebellum, "cerebellum with its vermis (91 to 116)");
  bench::print_spread(macaque, parts, {98.0}, "macaque, putamen (98)");
  bench::print_spread(macaque, parts, {1098.0}, "macaque, putamen (1098)");
}
