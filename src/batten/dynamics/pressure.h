/// \file Pressure, as of air in a balloon.
#pragma once
#include <functional>
#include <memory>

#include "batten/dynamics/force.h"
#include "batten/surface/quadrature.h"

namespace batten {

class SurfaceSamples;

/// A number for each time in seconds.
using NumberPath = std::function<double(double time)>;

/// A number that stays.
inline NumberPath always(double number) {
  return [number](double) { return number; };
}

/// The pressure inside a body: given, made by holding its volume, or the sum of both.
struct PressureOptions {
  /// Inside less outside, N/m^2: positive pressure pushes along the outward normals. Empty: none.
  NumberPath pressure = {};
  /// The volume that the surface shall have, in the cube of the points' unit, more than 0. Empty: any. Closed surfaces
  /// only.
  NumberPath volume = {};
  /// How strongly it is held, N/m^2: at the volume V the pressure rises by bulk_modulus (1 - V / volume). Its energy is
  /// 1/2 bulk_modulus volume (V / volume - 1)^2.
  double bulk_modulus = 0.0;
  /// Five points are exact on regular faces. Volumes of a surface and of its refinement differ beside irregular
  /// vertices, less by a factor of four a level.
  QuadratureOptions quadrature{3, 3};
};

/// On closed surfaces exactly p times the gradient of the volume that the quadrature gives, which does not depend on
/// where the origin is: no net force and no torque, to rounding. The energy is -p V, and that of the held volume, which
/// is implicit: stable however large its modulus.
/// On open surfaces the force p (du x dv) at each place. It has no energy.
class Pressure : public Force {
 public:
  /// A microsecond a face. Throws Error(BadArgument) for options out of range, and for a volume of an open surface,
  /// Error(NotFinite).
  Pressure(const ElasticSurface& body, PressureOptions options);
  /// The same pressure always. Throws Error(NotFinite).
  Pressure(const ElasticSurface& body, double pressure);

  const PressureOptions& options() const { return options_; }
  bool is_closed() const { return closed_; }

  /// What the surface encloses, negative where its normals point inward; of open surfaces that of the cone to the
  /// control points' mean. positions: V-by-3.
  double volume(const Points& positions) const;
  /// Its derivative by the control points, V-by-3.
  Points volume_gradient(const Points& positions) const;

  std::string name() const override { return "pressure"; }
  /// 0.2 to 0.7 microseconds a regular face. Throws Error(NotFinite, BadArgument) for what the paths give.
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  struct Volume;
  Volume measure(const Points& positions) const;
  Points open_force(const Points& positions) const;

  PressureOptions options_;
  std::shared_ptr<const SurfaceSamples> samples_;
  bool closed_;
};

}  // namespace batten
