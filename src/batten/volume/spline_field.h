/// \file A volume as a function of the place with a continuous derivative.
#pragma once
#include "batten/volume/volume.h"

namespace batten {

/// A number and its derivative in the world, per mm.
struct FieldValue {
  double value = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// The sum of quadratic B-splines at the voxels with their numbers as coefficients: linear volumes come out as they
/// are, others a little smoother, by a Gaussian of half a voxel. The gradient is that of the value, exactly; it has no
/// kinks at voxels. Places outside take the value of the nearest place inside.
class SplineField {
 public:
  /// Keeps the volume. Throws what require_volume() throws.
  explicit SplineField(Volume volume);

  const VolumeGrid& grid() const { return volume_.grid; }
  /// Safe from several threads.
  FieldValue at(const Eigen::Vector3d& world) const;

 private:
  Volume volume_;
  Eigen::Matrix3d to_index_;
};

}  // namespace batten
