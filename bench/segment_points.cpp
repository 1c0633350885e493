/// The table of points of docs/segment.md: atlas labels of Debian's mricron-data, from points on their borders and the
/// image. Each row is a label's mean, least and greatest Dice.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

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

double dice_from(const Volume& image, const Volume& mask, const Points& points) {
  SegmentRequest request;
  request.points = points;
  request.labels = mask;
  return segment_volume(image, request).agreement->dice;
}

void print_row(const char* name, const std::vector<double>& dices) {
  double sum = 0.0;
  for (const double dice : dices) sum += dice;
  std::printf("| %s | %.3f (%.3f to %.3f) |\n", name, sum / static_cast<double>(dices.size()),
              *std::min_element(dices.begin(), dices.end()), *std::max_element(dices.begin(), dices.end()));
  std::fflush(stdout);
}

void print_slices(const Volume& image, const Volume& labels, double label, const char* name) {
  const Volume mask = label_mask(labels, {label});
  std::vector<double> dices;
  for (Index offset = 0; offset < 4; ++offset) dices.push_back(dice_from(image, mask, points_in_slices(mask, offset)));
  print_row(name, dices);
}

}  // namespace
}  // namespace batten::bench

int main() {
  using namespace batten;
  const Volume brain = read_volume(bench::kFolder + "ch2.nii.gz");
  const Volume atlas = read_volume(bench::kFolder + "aal.nii.gz");
  std::printf("| part | Dice |\n|---|---|\n");
  bench::print_slices(brain, atlas, 71, "caudate, left (71), every 4th slice");
  bench::print_slices(brain, atlas, 72, "caudate, right (72), every 4th slice");
  bench::print_slices(brain, atlas, 37, "hippocampus, left (37), every 4th slice");
  std::vector<double> cerebellum;
  for (int label = 91; label <= 108; ++label) cerebellum.push_back(label);
  const Volume whole = label_mask(atlas, cerebellum);
  bench::print_row("cerebellum (91 to 108), 60 points spread",
                   {bench::dice_from(brain, whole, bench::spread_points(whole, 60))});
  const Volume macaque = read_volume(bench::kFolder + "inia19-t1-brain.nii.gz");
  const Volume parts = read_volume(bench::kFolder + "inia19-NeuroMaps.nii.gz");
  for (const double label : {98.0, 1098.0}) {
    const Volume mask = label_mask(parts, {label});
    const std::string name = "macaque, putamen (" + std::to_string(static_cast<int>(label)) + "), 60 points spread";
    bench::print_row(name.c_str(), {bench::dice_from(macaque, mask, bench::spread_points(mask, 60))});
  }
}
