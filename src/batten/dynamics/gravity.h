/// \file Weight.
#pragma once
#include "batten/dynamics/force.h"

namespace batten {

/// The same acceleration a for all of the body: the force on the control points is M a, M the mass matrix. Energy: the
/// mass times -a . (the centre of mass), 0 at the origin.
class Gravity : public Force {
 public:
  /// acceleration: m/s^2; the earth's where z points up unless told otherwise. O(entries of M). Throws
  /// Error(NotFinite).
  explicit Gravity(const ElasticSurface& body, const Eigen::Vector3d& acceleration = {0.0, 0.0, -9.81});

  const Eigen::Vector3d& acceleration() const { return acceleration_; }

  std::string name() const override { return "gravity"; }
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  Eigen::Vector3d acceleration_;
  Scalars masses_;  ///< what each control point carries
};

}  // namespace batten
