#include "batten/dynamics/place_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"

namespace batten {

namespace {

/// By the side of the mean face, were it a square.
int choose_points(const ElasticSurface& body) {
  constexpr double kSpacing = 0.02;
  const Scalars areas = element_areas(body.patches(), body.rest());
  const double side = areas.size() > 0 ? std::sqrt(areas.mean()) : 0.0;
  return static_cast<int>(std::clamp(std::ceil(side / (kSpacing * body.diagonal())), 2.0, 8.0));
}

}  // namespace

PlaceForce::PlaceForce(const ElasticSurface& body, PlaceFunction function, PlaceForceOptions options)
    : function_(std::move(function)),
      options_(std::move(options)),
      points_(options_.points ? *options_.points : choose_points(body)),
      samples_(std::make_shared<const SurfaceSamples>(body.patches(), GaussSamples{{points_, options_.levels}})) {
  if (!function_) throw Error(ErrorCode::BadArgument, options_.name + " has no function");
}

void PlaceForce::add(const ForceInput& input, ForceSum& sum) const {
  const Points jets = samples_->evaluate(input.positions);
  const Points velocities = samples_->evaluate(input.velocities);
  Points forces(samples_->count(), 3);
  for (Index e = 0; e < samples_->elements().count(); ++e) {
    const JetTable& table = samples_->table(e);
    for (std::size_t i = 0; i < table.places.size(); ++i) {
      const std::ptrdiff_t sample = samples_->begin(e) + static_cast<std::ptrdiff_t>(i);
      const std::ptrdiff_t row = 3 * sample;
      const SurfacePlace place{samples_->elements().base_face(e), table.places[i].u, table.places[i].v};
      const Eigen::Vector3d cross = Eigen::Vector3d(jets.row(row + 1)).cross(Eigen::Vector3d(jets.row(row + 2)));
      const double stretch = cross.norm();
      const Eigen::Vector3d normal = stretch > 0.0 ? Eigen::Vector3d(cross / stretch) : Eigen::Vector3d::Zero();
      const Eigen::Vector3d force = function_({place, input.time, jets.row(row), velocities.row(row), normal});
      if (!force.allFinite()) throw not_finite(force, options_.name + " on " + describe(place));
      forces.row(sample) = table.weights[i] * stretch * force;
    }
  }
  sum.force += samples_->pull_back(forces);
}

std::shared_ptr<const Force> PlaceForce::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<PlaceForce>(child, function_, options_);
}

}  // namespace batten
