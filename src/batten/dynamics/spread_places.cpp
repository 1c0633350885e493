#include "batten/dynamics/spread_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

SpreadPlaces::SpreadPlaces(const ElasticSurface& body, double radius, const QuadratureOptions& quadrature)
    : radius_(radius),
      samples_(body.patches(), GaussSamples{quadrature}),
      surface_(body.patches(), body.rest()),
      jets_(samples_.evaluate(body.rest())),
      areas_(sample_areas(samples_, jets_)),
      centers_(samples_.elements().count(), 3),
      radii_(samples_.elements().count()) {
  for (Index e = 0; e < samples_.elements().count(); ++e) {
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    for (std::ptrdiff_t i = samples_.begin(e); i < samples_.end(e); ++i) center += jets_.row(3 * i);
    centers_.row(e) = center / static_cast<double>(samples_.end(e) - samples_.begin(e));
    double squared = 0.0;
    for (std::ptrdiff_t i = samples_.begin(e); i < samples_.end(e); ++i) {
      squared = std::max(squared, (jets_.row(3 * i) - centers_.row(e)).squaredNorm());
    }
    radii_[e] = std::sqrt(squared);
  }
}

std::vector<SpreadPlaces::Share> SpreadPlaces::around(const SurfacePlace& place) const {
  const Jet jet = surface_.jet(place);
  const Eigen::Vector3d normal = jet.du.cross(jet.dv);
  const Eigen::RowVector3d center = jet.point;
  std::vector<Share> shares;
  double sum = 0.0;
  for (Index e = 0; e < samples_.elements().count(); ++e) {
    const double reach = radius_ + radii_[e];
    if ((centers_.row(e) - center).squaredNorm() >= reach * reach) continue;
    for (std::ptrdiff_t i = samples_.begin(e); i < samples_.end(e); ++i) {
      const double squared = (jets_.row(3 * i) - center).squaredNorm() / (radius_ * radius_);
      const Eigen::Vector3d du = jets_.row(3 * i + 1);
      const Eigen::Vector3d dv = jets_.row(3 * i + 2);
      if (squared >= 1.0 || du.cross(dv).dot(normal) <= 0.0) continue;
      const double left = 1.0 - squared;
      shares.push_back({i, left * left * left * areas_[i]});
      sum += shares.back().weight;
    }
  }
  for (Share& share : shares) share.weight /= sum;
  return shares;
}

std::vector<std::vector<SpreadPlaces::Share>> SpreadPlaces::around(std::span<const SurfacePlace> places) const {
  std::vector<std::vector<Share>> shares(places.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(places.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) shares[i] = around(places[i]);
      },
      4);
  return shares;
}

}  // namespace batten
