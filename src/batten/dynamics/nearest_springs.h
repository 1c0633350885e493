/// \file Springs from points in space to the nearest places of an elastic surface, wherever it moves.
#pragma once
#include <memory>
#include <vector>

#include "batten/dynamics/force.h"
#include "batten/nearest/nearest_point.h"
#include "batten/surface/quadrature.h"

namespace batten {

/// How strongly springs to the nearest places pull, and how widely each pull is spread.
struct NearestSpringOptions {
  std::vector<double> stiffness{1.0};  ///< N/m, 0 or more: one for all springs, or one each
  /// Above 0 a spring pulls at the places around the nearest one, not at it alone, so that it makes no spike: at those
  /// whose distance x from it, over the radius and in the rest shape, is below 1, by the weights (1 - x^2)^3 times the
  /// area, which sum to 1. Only where the rest shape's normal turns by less than a right angle: a thin body is not
  /// pulled at its other side. Where no place of the quadrature is that near, the spring pulls at the nearest alone.
  double radius = 0.0;
  QuadratureOptions quadrature{3, 1};  ///< the places that a radius spreads over
};

/// Each spring pulls the place s of the surface that is nearest to its point t by the force k (t - s); the energy is
/// 1/2 k |t - s|^2. Which place that is, is found anew for each position of the surface. As it is the nearest, another
/// place never raises the energy by more than k (distance) (tolerance()), which is rounding; the force is minus the
/// gradient of the energy, except where two places are equally near. With a radius the force is that gradient,
/// smoothed.
class NearestSprings : public Force {
 public:
  /// points: N-by-3. Builds NearestPoints: 10 to 50 microseconds a face. Throws Error(BadShape, BadArgument,
  /// NotFinite), naming the spring by its number from 0.
  NearestSprings(const ElasticSurface& body, ConstValuesRef points, NearestSpringOptions options = {});
  ~NearestSprings() override;

  const Points& points() const;
  const NearestSpringOptions& options() const;
  /// How much nearer than the place found the surface may be, in the points' unit.
  double tolerance() const;

  /// The nearest place for each spring. The last positions asked for are kept. Throws Error(BadShape, NotFinite).
  const std::vector<NearestPoint>& attach(const Points& positions) const;

  std::string name() const override { return "nearest springs"; }
  /// A third of the time of building NearestPoints, and a few microseconds a spring.
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
