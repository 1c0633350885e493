/// \file Simple forces for tests of elastic surfaces.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "batten/dynamics/force.h"

namespace batten::test {

/// The same force on the control points, whatever they do.
class FixedLoad : public Force {
 public:
  explicit FixedLoad(Points force) : force_(std::move(force)) {}
  std::string name() const override { return "fixed load"; }
  void add(const ForceInput& input, ForceSum& sum) const override {
    sum.force += force_;
    sum.energy -= force_.cwiseProduct(input.positions).sum();
  }
  std::shared_ptr<const Force> refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const override {
    return std::make_shared<FixedLoad>(Points::Zero(child.rest().rows(), 3));
  }

 private:
  Points force_;
};

/// Springs from places to points in space; not lasting if the stiffness is to be solved for in each round.
class SpringLoad : public Force {
 public:
  SpringLoad(const ElasticSurface& surface, std::vector<SurfacePlace> places, Points targets, double stiffness,
             bool lasting = true)
      : places_(std::move(places)),
        springs_{std::make_shared<PlaceRows>(place_rows(surface.patches(), places_)),
                 Scalars::Constant(targets.rows(), stiffness), std::move(targets), lasting} {}
  std::string name() const override { return "springs"; }
  void add(const ForceInput& input, ForceSum& sum) const override {
    sum.springs.push_back(springs_);
    const Points stretch = springs_.targets - springs_.rows->rows * input.positions;
    for (Eigen::Index i = 0; i < stretch.rows(); ++i) {
      sum.energy += 0.5 * springs_.stiffness[i] * stretch.row(i).squaredNorm();
    }
  }
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override {
    std::vector<SurfacePlace> places;
    for (const SurfacePlace& place : places_) places.push_back(place_on_refined(body.patches(), place));
    return std::make_shared<SpringLoad>(child, places, springs_.targets, springs_.stiffness[0], springs_.lasting);
  }

 private:
  std::vector<SurfacePlace> places_;
  PlaceSprings springs_;
};

}  // namespace batten::test
