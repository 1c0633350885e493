#include "batten/volume/edge_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
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

/// The three weights of a quadratic B-spline and the first of their voxels.
struct SplineWeights {
  Index first = 0;
  std::array<double, 3> weights{};

  explicit SplineWeights(double place) {
    const double middle = std::round(place);
    const double far = place - middle;
    first = static_cast<Index>(middle) - 1;
    weights = {0.5 * (0.5 - far) * (0.5 - far), 0.75 - far * far, 0.5 * (0.5 + far) * (0.5 + far)};
  }
};

}  // namespace

double EdgeSearch::derivative(const Eigen::Vector3d& place, const Eigen::Vector3d& along) const {
  const VolumeGrid& grid = slope_.grid;
  const Eigen::Vector3d index = to_index_ * (place - grid.origin);
  std::array<SplineWeights, 3> splines{SplineWeights(0.0), SplineWeights(0.0), SplineWeights(0.0)};
  for (int c = 0; c < 3; ++c) splines[c] = SplineWeights(std::clamp(index[c], -1.0, static_cast<double>(grid.size[c])));
  const auto voxel = [&](int c, int i) { return std::clamp(splines[c].first + i, 0, grid.size[c] - 1); };
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const double weight = splines[2].weights[k] * splines[1].weights[j];
      for (int i = 0; i < 3; ++i) {
        const std::ptrdiff_t at = grid.voxel(voxel(0, i), voxel(1, j), voxel(2, k));
        const double slope =
            along[0] * slope_.along[0][at] + along[1] * slope_.along[1][at] + along[2] * slope_.along[2][at];
        sum += weight * splines[0].weights[i] * slope;
      }
    }
  }
  return sum;
}

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
  const Eigen::Matrix3d to_steps = slope_.grid.axes.colwise().normalized().inverse();
  std::vector<std::vector<double>> profiles(count, std::vector<double>(static_cast<std::size_t>(2 * half + 1)));
  parallel_for(
      points.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          const Eigen::Vector3d normal = normals.row(row).transpose();
          const Eigen::Vector3d along = to_steps * normal;
          for (int i = -half; i <= half; ++i) {
            const Eigen::Vector3d place = points.row(row).transpose() + i * step_ * normal;
            profiles[row][i + half] = derivative(place, along);
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
