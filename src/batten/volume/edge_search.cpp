#include "batten/volume/edge_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

/// Of the derivatives along one normal, at equal steps: the best place, in steps from the middle, and its strength.
struct Peak {
  double at = 0.0;
  double strength = 0.0;
};

Peak best_peak(const std::vector<double>& values, double sign) {
  const auto middle = static_cast<int>(values.size() / 2);
  const auto size = [&](int i) { return sign == 0.0 ? std::abs(values[i]) : sign * values[i]; };
  const auto score = [&](int i) {
    const double far = (i - middle) / (1.5 * middle);
    return size(i) * (1.0 - far * far);
  };
  Peak peak;
  double best = 0.0;
  for (int i = 1; i + 1 < static_cast<int>(values.size()); ++i) {
    if (score(i) <= best || size(i) < size(i - 1) || size(i) < size(i + 1)) continue;
    best = score(i);
    const double bend = size(i - 1) - 2.0 * size(i) + size(i + 1);
    const double move = bend < 0.0 ? 0.5 * (size(i - 1) - size(i + 1)) / bend : 0.0;
    peak = {i - middle + std::clamp(move, -0.5, 0.5), size(i)};
  }
  return peak;
}

}  // namespace

EdgeSearch::EdgeSearch(const Volume& image, double width)
    : slope_(gradient(image, 2.0 / width)),
      to_index_(image.grid.axes.inverse()),
      step_(0.4 * std::min({image.grid.spacing(0), image.grid.spacing(1), image.grid.spacing(2)})) {
  constexpr float kRounding = 1e-5F;  // of the image's numbers: weaker derivatives are those of no edge
  float most = 0.0F;
  for (const float value : image.values) most = std::max(most, std::abs(value));
  least_ = kRounding * most / step_;
}

FoundEdges EdgeSearch::find(const Points& points, const Points& normals, double reach) const {
  constexpr double kSameStep = 0.6;
  constexpr double kStrong = 0.75;
  if (points.rows() != normals.rows())
    throw Error(ErrorCode::BadShape, "a normal for each place where edges are searched");
  const int half = std::max(2, static_cast<int>(std::ceil(reach / step_)));
  const auto count = static_cast<std::size_t>(points.rows());
  std::vector<std::vector<double>> profiles(count, std::vector<double>(static_cast<std::size_t>(2 * half + 1)));
  parallel_for(
      points.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          const Eigen::Vector3d normal = normals.row(row).transpose();
          for (int i = -half; i <= half; ++i) {
            const Eigen::Vector3d place = points.row(row).transpose() + i * step_ * normal;
            profiles[row][i + half] = world_gradient(slope_, to_index_ * (place - slope_.grid.origin)).dot(normal);
          }
        }
      },
      64);
  double signed_sum = 0.0;
  double sum = 0.0;
  for (const std::vector<double>& profile : profiles) {
    signed_sum += profile[half];
    sum += std::abs(profile[half]);
  }
  const double sign = std::abs(signed_sum) > kSameStep * sum ? (signed_sum > 0.0 ? 1.0 : -1.0) : 0.0;
  std::vector<Peak> peaks(count);
  std::vector<double> strengths(count);
  for (std::size_t i = 0; i < count; ++i) {
    peaks[i] = best_peak(profiles[i], sign);
    strengths[i] = peaks[i].strength;
  }
  const double strong = count > 0 ? quantile(strengths, kStrong) : 0.0;
  FoundEdges found{points, Scalars::Zero(points.rows())};
  for (std::size_t i = 0; i < count; ++i) {
    if (!(peaks[i].strength > least_)) continue;
    const auto row = static_cast<Eigen::Index>(i);
    found.places.row(row) += peaks[i].at * step_ * normals.row(row);
    found.weights[row] = std::pow(std::min(1.0, peaks[i].strength / strong), 2.0);
  }
  return found;
}

}  // namespace batten
