/// \file Drag of the air, and wind.
#pragma once
#include <functional>
#include <memory>

#include "batten/dynamics/force.h"
#include "batten/surface/quadrature.h"

namespace batten {

class SurfaceSamples;

/// The velocity of the air, in the points' unit per second, at a point in space and a time in seconds.
using WindField = std::function<Eigen::Vector3d(const Eigen::Vector3d& point, double time)>;

/// The same velocity everywhere and always.
inline WindField steady_wind(const Eigen::Vector3d& velocity) {
  return [velocity](const Eigen::Vector3d&, double) { return velocity; };
}

/// The air that a surface moves through, and how much it resists.
struct DragOptions {
  WindField wind = {};      ///< empty: still air
  double normal = 1.0;      ///< force per area and speed against motion along the normal, kg/(m^2 s), 0 or more
  double tangential = 0.1;  ///< likewise along the surface
  /// Areas are those at rest, so that drag changes nothing about a step's system but what its length says.
  QuadratureOptions quadrature{2, 1};
};

/// The force on a place of area A that moves with v in the wind w: A (normal (w - v)_n + tangential (w - v)_t), by the
/// parts along the normal and along the surface. Both sides of a sheet are alike. In still air it only takes energy
/// out. Implicit: each place is also a spring, to where it is, so that steps are stable however light the body is. An
/// equilibrium has v = 0.
/// The springs are lasting for steps of one length.
class Drag : public Force {
 public:
  /// Half a microsecond a place, and 400 bytes. Throws Error(BadArgument, NotFinite) for options out of range.
  explicit Drag(const ElasticSurface& body, DragOptions options = {});

  const DragOptions& options() const { return options_; }

  std::string name() const override { return "drag"; }
  /// Asks for the wind at each place, one after the other in the calling thread. Throws Error(NotFinite) naming the
  /// point where the wind is not finite.
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  DragOptions options_;
  std::shared_ptr<const SurfaceSamples> samples_;
  std::shared_ptr<const PlaceRows> rows_;
  Scalars areas_;
};

}  // namespace batten
