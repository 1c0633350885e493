#include "batten/volume/mask_contours.h"

#include <algorithm>
#include <array>
#include <vector>

#include "batten/error.h"

namespace batten {

namespace {

/// The numbers of the slices across an index that have voxels.
std::vector<Index> filled_slices(const Volume& mask, int axis) {
  std::vector<bool> filled(static_cast<std::size_t>(mask.grid.size[axis]), false);
  for (Index k = 0; k < mask.grid.size[2]; ++k) {
    for (Index j = 0; j < mask.grid.size[1]; ++j) {
      for (Index i = 0; i < mask.grid.size[0]; ++i) {
        if (mask.at(i, j, k) != 0.0F) filled[std::array<Index, 3>{i, j, k}[axis]] = true;
      }
    }
  }
  std::vector<Index> numbers;
  for (std::size_t n = 0; n < filled.size(); ++n) {
    if (filled[n]) numbers.push_back(static_cast<Index>(n));
  }
  return numbers;
}

bool are_apart(const std::vector<Index>& slices) {
  const auto beside = [](Index a, Index b) { return b == a + 1; };
  return slices.size() > 1 && std::adjacent_find(slices.begin(), slices.end(), beside) == slices.end();
}

/// The middles of the faces between voxels of one slice.
void add_contour(const Volume& mask, int axis, Index slice, std::vector<Eigen::Vector3d>& places) {
  const int along = (axis + 1) % 3;
  const int across = (axis + 2) % 3;
  const auto add = [&](const std::array<Index, 3>& at, int direction) {
    std::array<Index, 3> next = at;
    ++next[direction];
    if (next[direction] == mask.grid.size[direction]) return;
    if ((mask.at(at[0], at[1], at[2]) != 0.0F) == (mask.at(next[0], next[1], next[2]) != 0.0F)) return;
    places.emplace_back(
        mask.grid.to_world(Eigen::Vector3d(at[0], at[1], at[2]) + 0.5 * Eigen::Vector3d::Unit(direction)));
  };
  for (Index b = 0; b < mask.grid.size[across]; ++b) {
    for (Index a = 0; a < mask.grid.size[along]; ++a) {
      std::array<Index, 3> at{};
      at[axis] = slice;
      at[along] = a;
      at[across] = b;
      add(at, along);
      add(at, across);
    }
  }
}

}  // namespace

MaskContours mask_contours(const Volume& mask, Index every, Index first) {
  require_volume(mask);
  if (every < 1 || first < 0)
    throw Error(ErrorCode::BadArgument, "contours are taken in every slice, or in every second one, ...");
  MaskContours contours;
  std::vector<Index> slices = filled_slices(mask, contours.axis);
  for (const int axis : {2, 1, 0}) {
    const std::vector<Index> found = filled_slices(mask, axis);
    if (!are_apart(found)) continue;
    contours.axis = axis;
    contours.painted = true;
    slices = found;
    break;
  }
  std::vector<Eigen::Vector3d> places;
  int taken = 0;
  for (std::size_t n = 0; n < slices.size(); ++n) {
    const Index passed = contours.painted ? static_cast<Index>(n) : slices[n] - slices[0];
    if (passed < first || (passed - first) % every != 0) continue;
    add_contour(mask, contours.axis, slices[n], places);
    ++taken;
  }
  if (taken < 2)
    throw Error(ErrorCode::BadArgument, "the part lies in fewer than two of these slices; take more of them");
  contours.points.resize(static_cast<Eigen::Index>(places.size()), 3);
  for (Eigen::Index row = 0; row < contours.points.rows(); ++row) contours.points.row(row) = places[row].transpose();
  return contours;
}

}  // namespace batten
