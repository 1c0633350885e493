#include "batten/volume/image_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"
#include "batten/volume/gaussian_filter.h"
#include "batten/volume/inside_volume.h"
#include "batten/volume/recursive_filter.h"

namespace batten {

namespace {

/// A line f = a + c m through the numbers around a voxel.
struct LocalLine {
  double step = 0.0;        ///< c
  double difference = 0.0;  ///< of the image at the voxel
  double variance = 0.0;    ///< of the image around
  double explained = 0.0;   ///< the line's share of it
};

/// Along each index: the voxel before less twice this one and the one after; beyond the border is as this one.
Eigen::Vector3d second_differences(const Volume& volume, std::ptrdiff_t voxel) {
  Eigen::Vector3d differences;
  std::ptrdiff_t stride = 1;
  for (int c = 0; c < 3; ++c) {
    const auto at = static_cast<Index>(voxel / stride % volume.grid.size[c]);
    const double before = volume.values[at > 0 ? voxel - stride : voxel];
    const double after = volume.values[at + 1 < volume.grid.size[c] ? voxel + stride : voxel];
    differences[c] = before - 2.0 * volume.values[voxel] + after;
    stride *= volume.grid.size[c];
  }
  return differences;
}

/// The weighted sum of the variances of noise, by second differences along the index where they are least: those of
/// numbers without a relation have six times their variance.
double noise_of(const Volume& volume, const Buffer<float>& weights) {
  constexpr double kOfNumbers = 1.0 / 6.0;
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (std::ptrdiff_t voxel = 0; voxel < volume.grid.count(); ++voxel) {
    if (weights[voxel] > 0.0F) sums += kOfNumbers * weights[voxel] * second_differences(volume, voxel).cwiseAbs2();
  }
  return sums.minCoeff();
}

Volume averaged(const Volume& volume, double width) {
  return filtered(volume, {FilterOrder::Smooth, FilterOrder::Smooth, FilterOrder::Smooth}, 2.0 / width);
}

}  // namespace

/// Weighted means of the model m and the image f around each voxel.
struct ImageModel::Around {
  Buffer<float> band;  ///< the weights: 1 on the surface, 0 far from it
  std::array<Volume, 6> sums;

  LocalLine line_at(std::ptrdiff_t voxel, double m, double f) const {
    constexpr double kLeastWeight = 1e-6;
    constexpr double kLeastVariance = 1e-4;  // of m: no surface is near
    const auto sum = [&](int n) { return static_cast<double>(sums[n].values[voxel]); };
    const double weight = std::max(kLeastWeight, sum(0));
    const double mean_m = sum(1) / weight;
    const double mean_f = sum(2) / weight;
    const double of_m = sum(3) / weight - mean_m * mean_m;
    const double of_both = sum(4) / weight - mean_m * mean_f;
    LocalLine line;
    line.variance = std::max(0.0, sum(5) / weight - mean_f * mean_f);
    if (of_m > kLeastVariance) {
      line.step = of_both / of_m;
      if (line.variance > 0.0) line.explained = std::min(1.0, line.step * of_both / line.variance);
    }
    line.difference = f - mean_f - line.step * (m - mean_m);
    return line;
  }
};

ImageModel::ImageModel(Volume image) : image_(std::move(image)) {
  require_volume(image_);
  double mean = 0.0;
  for (const float value : image_.values) mean += value;
  mean /= static_cast<double>(image_.grid.count());
  for (float& value : image_.values) value -= static_cast<float>(mean);
  Eigen::Vector3d variances;
  for (int c = 0; c < 3; ++c) variances[c] = image_.grid.spacing(c) * image_.grid.spacing(c);
  set_blur(variances);
}

void ImageModel::set_blur(const Eigen::Vector3d& variances) {
  for (int c = 0; c < 3; ++c) {
    const double spacing = image_.grid.spacing(c);
    const double own = spacing * spacing / 12.0;
    blur_[c] = std::max(variances[c], own);
    sigmas_[c] = std::sqrt(blur_[c] - own) / spacing;
  }
  wanted_ = blur_;
}

ImageModel::Around ImageModel::sums_around(const Volume& parts, const Volume& model) const {
  constexpr double kBand = 2.0;    // widths of the blur: as far as it reaches
  constexpr double kWindow = 4.0;  // wider, or a larger step looks like a larger part
  const double blur = std::sqrt(std::max(blur_.maxCoeff(), std::pow(image_.grid.voxel_volume(), 2.0 / 3.0)));
  Around around;
  for (Volume& sum : around.sums) {
    sum.grid = image_.grid;
    sum.values.resize(image_.values.size());
  }
  const Volume wide = averaged(parts, kBand * blur);
  around.band.resize(image_.values.size());
  for (std::size_t i = 0; i < image_.values.size(); ++i) {
    const float inside = wide.values[i];
    const float weight = std::max(0.0F, 4.0F * inside * (1.0F - inside));
    const float m = model.values[i];
    const float f = image_.values[i];
    around.band[i] = weight;
    around.sums[0].values[i] = weight;
    around.sums[1].values[i] = weight * m;
    around.sums[2].values[i] = weight * f;
    around.sums[3].values[i] = weight * m * m;
    around.sums[4].values[i] = weight * m * f;
    around.sums[5].values[i] = weight * f * f;
  }
  for (Volume& sum : around.sums) sum = averaged(sum, kWindow * blur);
  return around;
}

void ImageModel::set_surface(const Mesh& fine) {
  constexpr double kEven = 1e-3;  // of the matrix's trace: an index along which nothing is seen keeps its blur
  const VolumeGrid& grid = image_.grid;
  const Volume parts = inside_volume(fine, grid, VoxelRule::Part);
  const Volume model = gaussian_smoothed(parts, sigmas_);
  const Around around = sums_around(parts, model);
  pulls_ = steps_ = trust_ = model;
  Volume differences = model;
  const Eigen::Vector3d squares = grid.axes.colwise().squaredNorm().transpose();
  double all = 0.0;
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::ptrdiff_t voxel = 0; voxel < grid.count(); ++voxel) {
    const double m = model.values[voxel];
    const LocalLine line = around.line_at(voxel, m, image_.values[voxel]);
    steps_.values[voxel] = static_cast<float>(line.step);
    pulls_.values[voxel] = static_cast<float>(line.step * line.difference);
    trust_.values[voxel] = static_cast<float>(line.explained);
    differences.values[voxel] = static_cast<float>(line.difference);
    const double weight = around.band[voxel];
    if (!(weight > 0.0)) continue;
    all += weight * line.variance;
    // What m gains by a unit of variance.
    const Eigen::Vector3d bends = 0.5 * line.step * second_differences(model, voxel).cwiseQuotient(squares);
    matrix += weight * bends * bends.transpose();
    right += weight * line.difference * bends;
  }
  noise_ = all > 0.0 ? noise_of(differences, around.band) / all : 0.0;
  wanted_ = blur_;
  if (matrix.trace() > 0.0) {
    matrix.diagonal().array() += kEven * matrix.trace();
    wanted_ += matrix.inverse() * right;
  }
  pulls_ = gaussian_smoothed(std::move(pulls_), sigmas_);
}

void ImageModel::learn_blur() {
  constexpr double kMost = 2.0;
  set_blur(wanted_.cwiseMin(kMost * blur_).cwiseMax(blur_ / kMost));
}

ModelMoves ImageModel::moves(const Points& points, const Points& normals) const {
  if (points.rows() != normals.rows()) throw Error(ErrorCode::BadShape, "a normal for each place that moves");
  constexpr double kStrong = 0.75;
  const VolumeGrid& grid = image_.grid;
  const Eigen::Matrix3d directions = grid.axes.colwise().normalized();
  const Points indices = grid.to_indices(points);
  ModelMoves result{Scalars::Zero(points.rows()), Scalars::Zero(points.rows())};
  Scalars squares = Scalars::Zero(points.rows());
  parallel_for(points.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      const Eigen::Vector3d at = indices.row(row).transpose();
      const double step = interpolated(steps_, at);
      squares[row] = step * step;
      if (!(squares[row] > 0.0)) continue;
      // A flat surface that moves by d changes m by d times a Gaussian along the normal; seen through the blur that is
      // d / (2 sqrt(pi) sigma).
      const double sigma = std::sqrt((directions.transpose() * normals.row(row).transpose()).cwiseAbs2().dot(blur_));
      const double move = 2.0 * std::sqrt(std::numbers::pi) * sigma * interpolated(pulls_, at) / (step * step);
      result.moves[row] = std::clamp(move, -sigma, sigma);
      result.weights[row] = interpolated(trust_, at);
    }
  });
  if (points.rows() == 0) return result;
  Scalars sorted = squares;
  const double strong = quantile(sorted, kStrong);
  if (strong > 0.0) result.weights.array() *= (squares / strong).array().min(1.0);
  return result;
}

}  // namespace batten
