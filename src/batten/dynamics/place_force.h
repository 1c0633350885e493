/// \file A force of the user's own.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "batten/dynamics/force.h"

namespace batten {

class SurfaceSamples;

/// What a PlaceForce is asked for.
struct PlaceMotion {
  SurfacePlace place;
  double time;               ///< seconds
  Eigen::Vector3d position;  ///< of the place
  Eigen::Vector3d velocity;  ///< of the place, per second
  Eigen::Vector3d normal;    ///< unit, outward; zero where the surface has none
};

/// The force per area of the surface as it is, N/m^2.
using PlaceFunction = std::function<Eigen::Vector3d(const PlaceMotion& motion)>;

/// What a force given by a function is called, and at how many places it is asked for.
struct PlaceForceOptions {
  std::string name = "place force";  ///< for messages
  /// Gauss points along a side of a face (surface/quadrature.h), 1 to 16. Empty: chosen by the size of the faces, so
  /// that points at rest lie about a fiftieth of the diagonal apart: 2 to 8.
  std::optional<int> points = {};
  int levels = 1;  ///< of the quadrature, beside irregular vertices
};

/// The function's force times the area at Gauss points. It is taken at the end of a step, as far as that is known; a
/// step that is long for a stiff function is as unstable as the function makes it. No energy.
class PlaceForce : public Force {
 public:
  /// Throws Error(BadArgument) for options out of range, and where there is no function.
  PlaceForce(const ElasticSurface& body, PlaceFunction function, PlaceForceOptions options = {});

  const PlaceForceOptions& options() const { return options_; }
  /// The points along a side that were given or chosen.
  int points() const { return points_; }

  std::string name() const override { return options_.name; }
  /// Calls the function for each point, one after the other in the calling thread. Throws Error(NotFinite) naming the
  /// force and the place, and what the function throws.
  void add(const ForceInput& input, ForceSum& sum) const override;
  /// Chooses the points anew where none were given.
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  PlaceFunction function_;
  PlaceForceOptions options_;
  int points_;
  std::shared_ptr<const SurfaceSamples> samples_;
};

}  // namespace batten
