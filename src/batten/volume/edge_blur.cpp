#include "batten/volume/edge_blur.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "batten/quantile.h"

namespace batten {

namespace {

/// What the derivative is beside an edge as a share of that on it, after a Gaussian blur and the search's smoothing.
class FallTable {
 public:
  explicit FallTable(double width) : width_(width) {
    for (int i = 0; i < kCount; ++i) falls_[i] = fall_of(sigma_of(i));
  }

  /// The variance of the blur.
  double variance_of(double fall) const {
    if (fall <= falls_.front()) return 0.0;
    int i = 1;
    while (i + 1 < kCount && falls_[i] < fall) ++i;
    const double share = std::clamp((fall - falls_[i - 1]) / (falls_[i] - falls_[i - 1]), 0.0, 1.0);
    const double sigma = sigma_of(i - 1) + share * (sigma_of(i) - sigma_of(i - 1));
    return sigma * sigma;
  }

 private:
  static constexpr int kCount = 48;

  double sigma_of(int i) const { return width_ * i / 16.0; }

  double fall_of(double sigma) const {
    const double alpha = 2.0 / width_;
    const auto kernel = [&](double x) { return (alpha * std::abs(x) + 1.0) * std::exp(-alpha * std::abs(x)); };
    constexpr int kSteps = 40;
    double on = 0.0;
    double beside = 0.0;
    for (int i = -kSteps; i <= kSteps; ++i) {
      const double x = 4.0 * i / kSteps;
      const double count = std::exp(-0.5 * x * x);
      on += count * kernel(x * sigma);
      beside += count * kernel(EdgeSearch::kBeside * width_ - x * sigma);
    }
    return beside / on;
  }

  double width_;
  std::array<double, kCount> falls_{};
};

/// How far blur moves the parts of a bent surface along its normal: half the bend times the variance along each of the
/// principal directions.
std::array<double, 2> sinks_of(const PointCurvature& curvature, const Eigen::Matrix3d& covariance) {
  if (!std::isfinite(curvature.greatest) || !std::isfinite(curvature.least)) return {0.0, 0.0};
  const auto sink = [&](double bend, const Eigen::Vector3d& direction) {
    return 0.5 * bend * direction.dot(covariance * direction);
  };
  return {sink(curvature.greatest, curvature.greatest_direction), sink(curvature.least, curvature.least_direction)};
}

/// The variance of what sinks_of() means.
double spread_of(const std::array<double, 2>& sinks) { return 2.0 * (sinks[0] * sinks[0] + sinks[1] * sinks[1]); }

/// Variances along directions of the grid that fit those along the normals best, in the sense of least squares with
/// weights; numbers farther from `squares` than `limit` do not count. limit becomes twice the median distance.
Eigen::Vector3d fitted_variances(const Points& shares, const Scalars& variances, const Scalars& weights,
                                 const Eigen::Vector3d& squares, double& limit) {
  constexpr double kFar = 2.0;
  constexpr double kEqual = 0.01;  // how much the axes are drawn to each other
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::vector<double> distances;
  for (Eigen::Index row = 0; row < shares.rows(); ++row) {
    if (!(weights[row] > 0.0)) continue;
    const Eigen::Vector3d share = shares.row(row).transpose();
    distances.push_back(std::abs(variances[row] - share.dot(squares)));
    if (distances.back() > limit) continue;
    matrix += weights[row] * share * share.transpose();
    right += weights[row] * variances[row] * share;
  }
  if (!(matrix.trace() > 0.0)) return squares;
  matrix += kEqual * matrix.trace() * (Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3.0));
  limit = kFar * quantile(distances, 0.5);
  const Eigen::Vector3d found = matrix.inverse() * right;
  return found.cwiseMax(0.0);
}

}  // namespace

Eigen::Matrix3d edge_covariance(const VolumeGrid& grid, double width, const FoundEdges& edges,
                                std::span<const PointCurvature> curvatures) {
  constexpr int kRounds = 6;
  const Eigen::Matrix3d directions = grid.axes.colwise().normalized();
  const FallTable table(width);
  Points shares(edges.places.rows(), 3);
  Scalars found(shares.rows());
  Scalars weights = edges.weights;
  for (Eigen::Index row = 0; row < shares.rows(); ++row) {
    shares.row(row) = (directions.transpose() * curvatures[row].normal).cwiseAbs2().transpose();
    found[row] = table.variance_of(edges.falls[row]);
    if (!(edges.falls[row] > 0.0)) weights[row] = 0.0;
  }
  const Eigen::Matrix3d own = width * width * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d covariance = own;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double limit = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    // A bent edge is wider by what its parts sink by.
    Scalars variances = found;
    for (Eigen::Index row = 0; row < found.size(); ++row) {
      if (round > 0) variances[row] = std::max(0.0, found[row] - spread_of(sinks_of(curvatures[row], covariance)));
    }
    squares = fitted_variances(shares, variances, weights, squares, limit);
    covariance = own + directions * squares.asDiagonal() * directions.transpose();
  }
  return covariance;
}

double edge_shift(const PointCurvature& curvature, const Eigen::Matrix3d& covariance) {
  const std::array<double, 2> sinks = sinks_of(curvature, covariance);
  const double across = curvature.normal.dot(covariance * curvature.normal);
  const double spread = across + spread_of(sinks);
  const double skew = 8.0 * (std::pow(sinks[0], 3.0) + std::pow(sinks[1], 3.0));
  const double most = std::sqrt(across);
  return spread > 0.0 ? std::clamp(sinks[0] + sinks[1] - 0.5 * skew / spread, -most, most) : 0.0;
}

}  // namespace batten
