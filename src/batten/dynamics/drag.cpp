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

/// What the force on each place is over its area: of a second, or, where there is a step, of the way in it.
Points Drag::carry(const Points& jets, const Points& start, const ForceInput& input) const {
  Points way(samples_->count(), 3);
  for (std::ptrdiff_t i = 0; i < samples_->count(); ++i) {
    const Eigen::Vector3d point = jets.row(3 * i);
    Eigen::Vector3d wind = Eigen::Vector3d::Zero();
    if (options_.wind) wind = options_.wind(point, input.time);
    if (!wind.allFinite()) throw not_finite(wind, "the wind at " + describe(point));
    Eigen::Vector3d motion = wind;
    if (input.step > 0.0) motion = Eigen::Vector3d(start.row(3 * i)) + input.step * wind - point;
    const Eigen::Vector3d cross = Eigen::Vector3d(jets.row(3 * i + 1)).cross(Eigen::Vector3d(jets.row(3 * i + 2)));
    const Eigen::Vector3d normal = cross.stableNormalized();
    const Eigen::Vector3d across = normal.dot(motion) * normal;
    way.row(i) = options_.normal * across + options_.tangential * (motion - across);
  }
  return way;
}

void Drag::add(const ForceInput& input, ForceSum& sum) const {
  const double most = std::max(options_.normal, options_.tangential);
  if (most == 0.0) return;
  const Points jets = samples_->evaluate(input.positions);
  if (input.step <= 0.0) {
    Points forces = carry(jets, jets, input);
    forces.array().colwise() *= areas_.array();
    sum.force += samples_->pull_back(forces);
    return;
  }
  Points targets = carry(jets, samples_->evaluate(input.start), input) / most;
  for (std::ptrdiff_t i = 0; i < samples_->count(); ++i) targets.row(i) += jets.row(3 * i);
  sum.springs.push_back({rows_, areas_ * (most / input.step), std::move(targets), true});
}

std::shared_ptr<const Force> Drag::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<Drag>(child, options_);
}

}  // namespace batten
