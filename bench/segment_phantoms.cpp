/// The table of phantoms of docs/segment.md: bodies of known surface from one seed each.
#include <cstdio>

#include "volume/known_bodies.h"

namespace batten::bench {
namespace {

void print_row(const test::Phantom& phantom, double slice) {
  std::printf("| %s, voxels of 1 x 1 x %g mm |", phantom.name, slice);
  for (const double noise : {0.0, 0.05, 0.1}) {
    SegmentRequest request;
    request.seed = phantom.seed;
    const VolumeGrid grid = test::body_grid(slice);
    const SegmentResult found = segment_volume(test::imaged(phantom, grid, noise), request);
    const test::Truth truth = test::compared(found, phantom);
    std::printf(" %.3f, %.3f, %+.1f %% |", truth.dice, truth.distance / std::cbrt(grid.voxel_volume()),
                100.0 * (truth.volume - 1.0));
  }
  std::printf("\n");
}

}  // namespace
}  // namespace batten::bench

int main() {
  std::printf("| Dice, mean distance in voxels, volume | no noise | 5 %% | 10 %% |\n|---|---|---|---|\n");
  for (const double slice : {1.0, 3.0}) {
    for (const batten::test::Phantom& phantom : batten::test::kPhantoms) batten::bench::print_row(phantom, slice);
  }
}
