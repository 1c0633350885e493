#include "batten/expand/color_ramp.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"

namespace batten {
namespace {

using Curve = std::vector<Eigen::RowVector3d>;

/// Solves (a + 4 b + c)/6 = color for the inner control points by Thomas's elimination. The end points are their
/// colours.
Curve control_points(const Curve& colors) {
  Curve points = colors;
  const std::size_t last = colors.size() - 1;
  std::vector<double> factors(colors.size(), 0.0);
  for (std::size_t i = 1; i < last; ++i) {
    factors[i] = 1.0 / (4.0 - factors[i - 1]);
    points[i] = (6.0 * colors[i] - points[i - 1]) * factors[i];
  }
  for (std::size_t i = last; i-- > 1;) points[i] -= factors[i] * points[i + 1];
  return points;
}

}  // namespace

ColorRamp::ColorRamp(const std::vector<std::array<double, 3>>& colors) {
  if (colors.empty()) throw Error(ErrorCode::BadArgument, "a colour ramp needs a colour at least");
  Curve through;
  for (const std::array<double, 3>& color : colors) {
    for (const double value : color) {
      if (!(value >= 0.0 && value <= 1.0)) {
        throw Error(ErrorCode::BadArgument, "colour " + std::to_string(through.size()) +
                                                " of the ramp is not in [0, 1]: " + std::to_string(value));
      }
    }
    through.emplace_back(color[0], color[1], color[2]);
  }
  if (through.size() == 1) through.push_back(through.front());
  const Curve inner = control_points(through);
  control_.push_back(2.0 * inner[0] - inner[1]);
  control_.insert(control_.end(), inner.begin(), inner.end());
  control_.push_back(2.0 * inner.back() - inner[inner.size() - 2]);
}

Eigen::RowVector3d ColorRamp::color(double position) const {
  const std::size_t pieces = control_.size() - 3;
  const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(pieces);
  const std::size_t piece = std::min(static_cast<std::size_t>(place), pieces - 1);
  const double t = place - static_cast<double>(piece);
  const double s = 1.0 - t;
  const Eigen::RowVector3d* p = control_.data() + piece;
  const Eigen::RowVector3d sum = s * s * s * p[0] + (4.0 - 6.0 * t * t + 3.0 * t * t * t) * p[1] +
                                 (4.0 - 6.0 * s * s + 3.0 * s * s * s) * p[2] + t * t * t * p[3];
  return (sum / 6.0).cwiseMax(0.0).cwiseMin(1.0);
}

}  // namespace batten
