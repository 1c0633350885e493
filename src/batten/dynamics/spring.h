/// \file Springs from places of an elastic surface to points in space.
#pragma once
#include <vector>

#include "batten/dynamics/force.h"
#include "batten/dynamics/supports.h"

namespace batten {

/// Each spring pulls its place s to its target t by the force k (t - s); it has no length at rest, and the energy
/// 1/2 k |t - s|^2. Implicit: stable however stiff.
class PointSprings : public Force {
 public:
  /// One spring: where it is fixed to the body, and what it pulls to.
  struct Spring {
    SurfacePlace place;      ///< of the body's base (surface/limit_surface.h)
    PointPath target;        ///< where it pulls to, for each time
    double stiffness = 1.0;  ///< k in N/m, 0 or more
  };

  /// O(springs), and 1 to 3 microseconds each. Throws Error(IndexOutOfRange, BadArgument, NotFinite), naming the
  /// spring by its number from 0.
  PointSprings(const ElasticSurface& body, std::vector<Spring> springs);

  const std::vector<Spring>& springs() const { return springs_; }

  std::string name() const override { return "springs"; }
  /// Throws Error(NotFinite) where a target is not finite, naming the spring.
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  std::vector<Spring> springs_;
  std::shared_ptr<const PlaceRows> rows_;
  Scalars stiffness_;
};

}  // namespace batten
