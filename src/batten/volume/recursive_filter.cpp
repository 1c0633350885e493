#include "batten/volume/recursive_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// A kernel w(m) e^|m| as a recursion: with r = e z^-1 the part m >= 0 is (here0 + here1 r) / (1 - r)^2, the part m < 0
/// in the other direction (back1 r + back2 r^2) / (1 - r)^2.
struct Recursion {
  double e;
  double here0;
  double here1;
  double back1;
  double back2;
};

Recursion recursion_of(FilterOrder order, double a, double spacing) {
  const double e = std::exp(-a);
  const double rest = 1.0 - e;
  const double linear = e / (rest * rest);                              // sum of m e^m over m > 0
  const double square = e * (1.0 + e) / (rest * rest * rest);           // of m^2 e^m
  const double cube = e * (1.0 + 4.0 * e + e * e) / std::pow(rest, 4);  // of m^3 e^m
  if (order == FilterOrder::Smooth) {
    const double k = 1.0 / ((1.0 + e) / rest + 2.0 * a * linear);
    return {e, k, k * (a - 1.0), k * (a + 1.0), -k};
  }
  if (order == FilterOrder::First) {
    // y = sum of w(m) x(n - m): a line of slope 1 gives the sum of -m w(m).
    const double k = -1.0 / (2.0 * square * spacing);
    return {e, 0.0, k, -k, 0.0};
  }
  const double c = (1.0 + e) / rest / (2.0 * linear);
  const double k = 1.0 / ((square - c * cube) * spacing * spacing);
  return {e, k, -k * (1.0 + c), k * (1.0 - c), -k};
}

/// Filters `width` lines side by side, of `length` numbers, in place. kept: as many numbers.
void filter_lines(float* lines, std::ptrdiff_t width, std::ptrdiff_t length, std::ptrdiff_t stride,
                  const Recursion& filter, std::vector<double>& kept) {
  const double e = filter.e;
  const double twice = 2.0 * e;
  const double squared = e * e;
  const double steady = 1.0 / ((1.0 - e) * (1.0 - e));
  kept.resize(static_cast<std::size_t>(width * (length + 3)));
  double* const one = kept.data() + width * length;  // the output a step before, and two
  double* const two = one + width;
  double* const other = two + width;  // the input a step before
  const auto start = [&](const float* edge, double sum) {
    for (std::ptrdiff_t i = 0; i < width; ++i) {
      one[i] = two[i] = sum * steady * edge[i];
      other[i] = edge[i];
    }
  };
  start(lines, filter.here0 + filter.here1 * e);
  for (std::ptrdiff_t n = 0; n < length; ++n) {
    const float* const in = lines + n * stride;
    double* const out = kept.data() + n * width;
    for (std::ptrdiff_t i = 0; i < width; ++i) {
      const double y = filter.here0 * in[i] + filter.here1 * e * other[i] + twice * one[i] - squared * two[i];
      two[i] = one[i];
      one[i] = y;
      other[i] = in[i];
      out[i] = y;
    }
  }
  start(lines + (length - 1) * stride, filter.back1 * e + filter.back2 * squared);
  std::vector<double> before(static_cast<std::size_t>(width));  // the input two steps before
  std::copy(other, other + width, before.begin());
  for (std::ptrdiff_t n = length - 1; n >= 0; --n) {
    float* const in = lines + n * stride;
    const double* const out = kept.data() + n * width;
    for (std::ptrdiff_t i = 0; i < width; ++i) {
      const double y =
          filter.back1 * e * other[i] + filter.back2 * squared * before[i] + twice * one[i] - squared * two[i];
      two[i] = one[i];
      one[i] = y;
      before[i] = other[i];
      other[i] = in[i];
      in[i] = static_cast<float>(out[i] + y);
    }
  }
}

/// Along one index, in place. Lines that lie side by side in memory go together; along the first index lines are turned
/// so that they do.
void filter_axis(Volume& volume, int axis, const Recursion& filter) {
  constexpr std::ptrdiff_t kWidth = 64;
  const std::array<Index, 3>& size = volume.grid.size;
  const std::ptrdiff_t length = size[axis];
  if (axis == 0) {
    const std::ptrdiff_t lines = volume.grid.count() / length;
    parallel_for(
        lines,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          const std::ptrdiff_t width = end - begin;
          std::vector<double> kept;
          std::vector<float> turned(static_cast<std::size_t>(width * length));
          float* const from = &volume.values[begin * length];
          for (std::ptrdiff_t i = 0; i < width; ++i) {
            for (std::ptrdiff_t n = 0; n < length; ++n) turned[n * width + i] = from[i * length + n];
          }
          filter_lines(turned.data(), width, length, width, filter, kept);
          for (std::ptrdiff_t i = 0; i < width; ++i) {
            for (std::ptrdiff_t n = 0; n < length; ++n) from[i * length + n] = turned[n * width + i];
          }
        },
        kWidth);
    return;
  }
  const std::ptrdiff_t stride = axis == 1 ? size[0] : static_cast<std::ptrdiff_t>(size[0]) * size[1];
  const std::ptrdiff_t strips = block_count(stride, kWidth);
  const std::ptrdiff_t slabs = volume.grid.count() / (stride * length);
  parallel_for_each(strips * slabs, [&](std::ptrdiff_t block) {
    const std::ptrdiff_t begin = block % strips * kWidth;
    std::vector<double> kept;
    filter_lines(&volume.values[block / strips * stride * length + begin], std::min(kWidth, stride - begin), length,
                 stride, filter, kept);
  });
}

}  // namespace

Volume filtered(const Volume& volume, const std::array<FilterOrder, 3>& orders, double alpha) {
  require_volume(volume);
  if (!(alpha > 0.0) || !std::isfinite(alpha))
    throw Error(ErrorCode::BadArgument, "the filter's alpha must be greater than 0");
  Volume result = volume;
  for (int axis = 0; axis < 3; ++axis) {
    if (orders[axis] == FilterOrder::None) continue;
    const double spacing = volume.grid.spacing(axis);
    filter_axis(result, axis, recursion_of(orders[axis], alpha * spacing, spacing));
  }
  return result;
}

Gradient gradient(const Volume& volume, double alpha) {
  Gradient result;
  result.grid = volume.grid;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<FilterOrder, 3> orders{FilterOrder::Smooth, FilterOrder::Smooth, FilterOrder::Smooth};
    orders[axis] = FilterOrder::First;
    result.along[axis] = std::move(filtered(volume, orders, alpha).values);
  }
  return result;
}

namespace {

/// Takes derivatives along indices, per mm, to the world: the gradient g has g . axis_c / |axis_c| as its c-th.
Eigen::Matrix3d to_world_gradient(const VolumeGrid& grid) {
  Eigen::Matrix3d directions = grid.axes;
  for (int c = 0; c < 3; ++c) directions.col(c) /= grid.spacing(c);
  return directions.transpose().inverse();
}

Eigen::Vector3d stored(const Gradient& gradient, std::ptrdiff_t voxel) {
  return {gradient.along[0][voxel], gradient.along[1][voxel], gradient.along[2][voxel]};
}

}  // namespace

Eigen::Vector3d world_gradient(const Gradient& gradient, const Eigen::Vector3d& index) {
  std::array<Index, 3> low{};
  Eigen::Vector3d share;
  for (int c = 0; c < 3; ++c) {
    const double place = std::clamp(index[c], 0.0, gradient.grid.size[c] - 1.0);
    low[c] = std::max(0, std::min(static_cast<Index>(place), gradient.grid.size[c] - 2));
    share[c] = place - low[c];
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<Index, 3> at = low;
    for (int c = 0; c < 3; ++c) {
      const int high = corner >> c & 1;
      weight *= high != 0 ? share[c] : 1.0 - share[c];
      at[c] = std::min(low[c] + high, gradient.grid.size[c] - 1);
    }
    if (weight > 0.0) sum += weight * stored(gradient, gradient.grid.voxel(at[0], at[1], at[2]));
  }
  return to_world_gradient(gradient.grid) * sum;
}

Volume edge_magnitude(const Gradient& gradient) {
  Volume result;
  result.grid = gradient.grid;
  result.values.resize(static_cast<std::size_t>(gradient.grid.count()));
  const Eigen::Matrix3d turn = to_world_gradient(gradient.grid);
  parallel_for(gradient.grid.count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      result.values[i] = static_cast<float>((turn * stored(gradient, i)).norm());
  });
  return result;
}

Volume edge_maxima(const Gradient& gradient) {
  const Volume magnitude = edge_magnitude(gradient);
  const VolumeGrid& grid = gradient.grid;
  const Eigen::Matrix3d turn = to_world_gradient(grid);
  const Eigen::Matrix3d to_index = grid.axes.inverse();
  const double step = std::min({grid.spacing(0), grid.spacing(1), grid.spacing(2)});
  Volume result = magnitude;
  parallel_for_each(grid.size[2], [&](std::ptrdiff_t slice) {
    const auto k = static_cast<Index>(slice);
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i) {
        const std::ptrdiff_t voxel = grid.voxel(i, j, k);
        const double here = magnitude.values[voxel];
        if (!(here > 0.0)) continue;
        const Eigen::Vector3d way = step / here * (to_index * (turn * stored(gradient, voxel)));
        const Eigen::Vector3d index(i, j, k);
        if (interpolated(magnitude, index + way) > here || interpolated(magnitude, index - way) > here)
          result.values[voxel] = 0.0F;
      }
    }
  });
  return result;
}

}  // namespace batten
