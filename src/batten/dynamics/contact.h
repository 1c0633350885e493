/// \file Contact with obstacles that a signed distance describes.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "batten/dynamics/force.h"

namespace batten {

class SurfaceSamples;

/// The signed distance from an obstacle: negative inside it. It must change by no more than the distance between two
/// points (1-Lipschitz, as every distance does): faces that are farther away than their size are not looked at.
/// `gradient` becomes the direction away from the obstacle, of any length but 0.
using SignedDistance = std::function<double(const Eigen::Vector3d& point, Eigen::Vector3d& gradient)>;

/// All that lies below the plane through `point`; the normal points upward, of any length. Throws Error(BadArgument,
/// NotFinite).
SignedDistance plane_obstacle(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);
/// A ball. Throws Error(BadArgument, NotFinite) unless the radius is above 0.
SignedDistance sphere_obstacle(const Eigen::Vector3d& center, double radius);
/// All that lies outside a box, which keeps the body inside. Throws Error(BadArgument, NotFinite) unless low < high.
SignedDistance box_inside_obstacle(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// What touching an obstacle does, and where on the surface it is looked for.
struct ContactOptions {
  double stiffness = 1e4;  ///< force per depth and area at rest, N/m^3, 0 or more
  double friction = 0.0;   ///< mu, 0 or more
  double thickness = 0.0;  ///< how far the surface is kept away, 0 or more
  int intervals = 2;       ///< places along each side of a face, one more than these, corners among them; 1 to 64
};

/// Places that are nearer than the thickness are pushed out by stiffness times area times depth; the energy is 1/2
/// stiffness area depth^2. Implicit: stable however stiff.
/// Friction: a place that has slipped along the obstacle since the begin of the step is pulled back by stiffness times
/// area times the way, at most mu times what pushes it out. So what sticks under a load creeps, by load over stiffness
/// a step. In an equilibrium there is no friction: nothing moves.
class Contact : public Force {
 public:
  /// Throws Error(BadArgument, NotFinite) for options out of range.
  Contact(const ElasticSurface& body, SignedDistance obstacle, const ContactOptions& options = {});

  const ContactOptions& options() const { return options_; }

  std::string name() const override { return "contact"; }
  /// 0.1 microseconds a face, and 5 for each that is near. Calls the obstacle in the calling thread. Throws
  /// Error(NotFinite, BadArgument) naming the point where distance or gradient is not finite, or the gradient 0.
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  struct Touch;
  std::vector<Touch> find_touches(const Points& positions) const;
  double distance(const Eigen::Vector3d& point, Eigen::Vector3d& gradient) const;

  SignedDistance obstacle_;
  ContactOptions options_;
  std::shared_ptr<const SurfaceSamples> samples_;
  Scalars face_areas_;  ///< of the elements at rest
};

}  // namespace batten
