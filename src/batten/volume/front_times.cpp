#include "batten/volume/front_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "batten/volume/voxel_flood.h"

namespace batten {

namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

/// The earlier of the two neighbours' times along an index, of voxels that the front has passed.
float earlier(const VolumeGrid& grid, const Front& front, const VoxelFlags& passed, std::ptrdiff_t voxel, int axis) {
  std::ptrdiff_t stride = 1;
  for (int c = 0; c < axis; ++c) stride *= grid.size[c];
  const auto at = static_cast<Index>(voxel / stride % grid.size[axis]);
  float time = kNever;
  if (at > 0 && passed[voxel - stride] != 0) time = front.times[voxel - stride];
  if (at + 1 < grid.size[axis] && passed[voxel + stride] != 0) time = std::min(time, front.times[voxel + stride]);
  return time;
}

/// The time T with sum over the axes of (T - time)^2 / spacing^2 = cost^2, of those axes whose time is before T.
double upwind_time(std::array<std::pair<double, double>, 3> times_and_spacings, double cost) {
  std::sort(times_and_spacings.begin(), times_and_spacings.end());
  double squares = 0.0;
  double linear = 0.0;
  double constant = -cost * cost;
  double found = kNever;
  for (const auto& [time, spacing] : times_and_spacings) {
    if (!(time < found)) break;
    const double weight = 1.0 / (spacing * spacing);
    squares += weight;
    linear += weight * time;
    constant += weight * time * time;
    const double root = linear * linear - squares * constant;
    if (root < 0.0) break;
    found = (linear + std::sqrt(root)) / squares;
  }
  return found;
}

}  // namespace

Front march_front(const VolumeGrid& grid, const Buffer<float>& costs, std::ptrdiff_t start) {
  Front front;
  front.times.assign(static_cast<std::size_t>(grid.count()), kNever);
  VoxelFlags passed(front.times.size(), 0);
  using Waiting = std::pair<float, std::ptrdiff_t>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
  front.times[start] = 0.0F;
  waiting.emplace(0.0F, start);
  while (!waiting.empty()) {
    const std::ptrdiff_t voxel = waiting.top().second;
    waiting.pop();
    if (passed[voxel] != 0) continue;
    passed[voxel] = 1;
    front.order.push_back(voxel);
    for_each_beside(grid, voxel, [&](std::ptrdiff_t next) {
      if (passed[next] != 0 || !std::isfinite(costs[next])) return;
      std::array<std::pair<double, double>, 3> times;
      for (int axis = 0; axis < 3; ++axis) times[axis] = {earlier(grid, front, passed, next, axis), grid.spacing(axis)};
      const auto time = static_cast<float>(upwind_time(times, costs[next]));
      if (!(time < front.times[next])) return;
      front.times[next] = time;
      waiting.emplace(time, next);
    });
  }
  return front;
}

}  // namespace batten
