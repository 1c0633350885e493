#include "batten/volume/distance_transform.h"

#include <cmath>
#include <limits>
#include <vector>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The lower envelope of the parabolas (x - i)^2 step^2 + in[i], at all i.
class Envelope {
 public:
  explicit Envelope(std::ptrdiff_t length)
      : in_(static_cast<std::size_t>(length)), apex_(in_.size()), from_(in_.size() + 1) {}

  void replace(float* line, std::ptrdiff_t stride, double step) {
    const auto length = static_cast<std::ptrdiff_t>(in_.size());
    for (std::ptrdiff_t i = 0; i < length; ++i) in_[i] = line[i * stride];
    const double square = step * step;
    std::ptrdiff_t count = 0;
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      if (!std::isfinite(in_[i])) continue;
      double begin = -std::numeric_limits<double>::infinity();
      while (count > 0) {
        const std::ptrdiff_t top = apex_[count - 1];
        begin = ((in_[i] - in_[top]) / square + static_cast<double>(i * i - top * top)) / (2.0 * (i - top));
        if (begin > from_[count - 1]) break;
        --count;
        begin = -std::numeric_limits<double>::infinity();
      }
      apex_[count] = i;
      from_[count++] = begin;
    }
    if (count == 0) return;
    std::ptrdiff_t at = 0;
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      while (at + 1 < count && from_[at + 1] <= static_cast<double>(i)) ++at;
      const auto far = static_cast<double>(i - apex_[at]);
      line[i * stride] = static_cast<float>(far * far * square + in_[apex_[at]]);
    }
  }

 private:
  std::vector<double> in_;
  std::vector<std::ptrdiff_t> apex_;
  std::vector<double> from_;
};

}  // namespace

Buffer<float> distance_transform(const VolumeGrid& grid, const Buffer<std::uint8_t>& flags) {
  constexpr double kRight = 1e-6;
  require_grid(grid);
  if (static_cast<std::ptrdiff_t>(flags.size()) != grid.count())
    throw Error(ErrorCode::BadShape, "a distance transform takes one flag a voxel");
  for (int c = 0; c < 3; ++c) {
    const int next = (c + 1) % 3;
    if (std::abs(grid.axes.col(c).dot(grid.axes.col(next))) > kRight * grid.spacing(c) * grid.spacing(next))
      throw Error(ErrorCode::BadArgument, "the axes of the volume are not at right angles");
  }
  Buffer<float> squares(flags.size());
  for (std::size_t i = 0; i < flags.size(); ++i)
    squares[i] = flags[i] != 0 ? 0.0F : std::numeric_limits<float>::infinity();
  std::ptrdiff_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t length = grid.size[axis];
    parallel_for(
        grid.count() / length,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          Envelope envelope(length);
          for (std::ptrdiff_t line = begin; line < end; ++line)
            envelope.replace(&squares[line / stride * stride * length + line % stride], stride, grid.spacing(axis));
        },
        256);
    stride *= length;
  }
  for (float& value : squares) value = std::sqrt(value);
  return squares;
}

}  // namespace batten
