#include "batten/volume/spline_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace batten {

namespace {

/// The three splines that reach a place along one index.
struct FieldSplines {
  std::array<Index, 3> voxels;
  std::array<double, 3> values;
  std::array<double, 3> slopes;  ///< per voxel
};

FieldSplines field_splines(double index, Index size) {
  const double last = size - 1.0;
  const double place = std::clamp(index, 0.0, last);
  const double middle = std::round(place);
  const double t = place - middle;
  FieldSplines weights{
      {}, {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)}, {t - 0.5, -2.0 * t, t + 0.5}};
  if (index < 0.0 || index > last) weights.slopes = {0.0, 0.0, 0.0};
  for (int k = 0; k < 3; ++k) weights.voxels[k] = std::clamp(static_cast<Index>(middle) + k - 1, 0, size - 1);
  return weights;
}

}  // namespace

SplineField::SplineField(Volume volume) : volume_(std::move(volume)) {
  require_volume(volume_);
  to_index_ = volume_.grid.axes.inverse();
}

FieldValue SplineField::at(const Eigen::Vector3d& world) const {
  const Eigen::Vector3d index = to_index_ * (world - volume_.grid.origin);
  const FieldSplines x = field_splines(index[0], volume_.grid.size[0]);
  const FieldSplines y = field_splines(index[1], volume_.grid.size[1]);
  const FieldSplines z = field_splines(index[2], volume_.grid.size[2]);
  double value = 0.0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    for (int b = 0; b < 3; ++b) {
      double along = 0.0;
      double steep = 0.0;
      for (int a = 0; a < 3; ++a) {
        const double number = volume_.at(x.voxels[a], y.voxels[b], z.voxels[c]);
        along += x.values[a] * number;
        steep += x.slopes[a] * number;
      }
      value += y.values[b] * z.values[c] * along;
      slope += Eigen::Vector3d(y.values[b] * z.values[c] * steep, y.slopes[b] * z.values[c] * along,
                               y.values[b] * z.slopes[c] * along);
    }
  }
  return {value, to_index_.transpose() * slope};
}

}  // namespace batten
