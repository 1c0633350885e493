#include "batten/dynamics/drag.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/surface_samples.h"

namespace batten {

Drag::Drag(const ElasticSurface& body, DragOptions options)
    : options_(std::move(options)),
      samples_(std::make_shared<const SurfaceSamples>(body.patches(), GaussSamples{options_.quadrature})) {
  require_not_negative(options_.normal, "the normal coefficient of drag");
  require_not_negative(options_.tangential, "the tangential coefficient of drag");
  areas_ = sample_areas(*samples_, samples_->evaluate(body.rest()));
  std::vector<std::ptrdiff_t> all(static_cast<std::size_t>(samples_->count()));
  std::iota(all.begin(), all.end(), std::ptrdiff_t{0});
  rows_ = samples_->point_rows(all);
}

void Drag::add(const ForceInput& input, ForceSum& sum) const {
  const double most = std::max(options_.normal, options_.tangential);
  const Points jets = samples_->evaluate(input.positions);
  const Points velocities = samples_->evaluate(input.velocities);
  Points points(samples_->count(), 3);
  Points forces(samples_->count(), 3);
  for (std::ptrdiff_t i = 0; i < samples_->count(); ++i) {
    points.row(i) = jets.row(3 * i);
    const Eigen::Vector3d point = points.row(i);
    Eigen::Vector3d wind = Eigen::Vector3d::Zero();
    if (options_.wind) wind = options_.wind(point, input.time);
    if (!wind.allFinite()) throw not_finite(wind, "the wind at " + describe(point));
    const Eigen::Vector3d cross = Eigen::Vector3d(jets.row(3 * i + 1)).cross(Eigen::Vector3d(jets.row(3 * i + 2)));
    const Eigen::Vector3d normal = cross.stableNormalized();
    const Eigen::Vector3d speed = wind - Eigen::Vector3d(velocities.row(3 * i));
    const Eigen::Vector3d across = normal.dot(speed) * normal;
    forces.row(i) = areas_[i] * (options_.normal * across + options_.tangential * (speed - across));
  }
  sum.force += samples_->pull_back(forces);
  // Springs to where the places are: their stiffness alone says how the force changes with the end of the step.
  if (input.step > 0.0) sum.springs.push_back({rows_, areas_ * (most / input.step), std::move(points), true});
}

std::shared_ptr<const Force> Drag::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<Drag>(child, options_);
}

}  // namespace batten
