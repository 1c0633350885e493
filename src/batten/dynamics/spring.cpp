#include "batten/dynamics/spring.h"

#include <utility>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"
#include "batten/surface/limit_surface.h"

namespace batten {

namespace {

std::string spring_name(std::size_t i) { return "spring " + std::to_string(i); }

void require_spring(const Topology& base, const PointSprings::Spring& spring, const std::string& name) {
  require_not_negative(spring.stiffness, "the stiffness of " + name);
  if (!spring.target) throw Error(ErrorCode::BadArgument, name + " has no target");
  try {
    require_place(base, spring.place);
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

}  // namespace

PointSprings::PointSprings(const ElasticSurface& body, std::vector<Spring> springs)
    : springs_(std::move(springs)), stiffness_(static_cast<Eigen::Index>(springs_.size())) {
  std::vector<SurfacePlace> places;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    require_spring(body.patches().base(), springs_[i], spring_name(i));
    places.push_back(springs_[i].place);
    stiffness_[static_cast<Eigen::Index>(i)] = springs_[i].stiffness;
  }
  rows_ = std::make_shared<const PlaceRows>(place_rows(body.patches(), places));
}

void PointSprings::add(const ForceInput& input, ForceSum& sum) const {
  Points targets(stiffness_.size(), 3);
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Eigen::Vector3d target = springs_[i].target(input.time);
    require_finite_vector(target, "the target of " + spring_name(i) + " at " + std::to_string(input.time) + " s");
    targets.row(static_cast<Eigen::Index>(i)) = target;
  }
  const Points points = rows_->rows * input.positions;
  sum.energy += 0.5 * stiffness_.dot((targets - points).rowwise().squaredNorm());
  sum.springs.push_back({rows_, stiffness_, std::move(targets), true});
}

std::shared_ptr<const Force> PointSprings::refined(const ElasticSurface& body, const ElasticSurface& child) const {
  std::vector<Spring> springs = springs_;
  for (Spring& spring : springs) spring.place = place_on_refined(body.patches(), spring.place);
  return std::make_shared<PointSprings>(child, std::move(springs));
}

}  // namespace batten
