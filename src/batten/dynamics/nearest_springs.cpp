#include "batten/dynamics/nearest_springs.h"

#include <utility>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/spread_places.h"
#include "batten/error.h"
#include "batten/mesh/checked_values.h"

namespace batten {

struct NearestSprings::Parts {
  SurfacePatches patches;
  Points points;
  NearestSpringOptions options;
  NearestPoints nearest;
  std::unique_ptr<const SpreadPlaces> spread;  ///< with a radius
  Points positions;                            ///< those that `attached` is of
  std::vector<NearestPoint> attached;

  double stiffness(std::size_t i) const { return options.stiffness[options.stiffness.size() == 1 ? 0 : i]; }
  void add_at_places(const std::vector<std::size_t>& which, ForceSum& sum) const;
  std::vector<std::size_t> add_spread(const Points& positions, ForceSum& sum) const;
};

/// Of the springs in `which`, each at its place alone.
void NearestSprings::Parts::add_at_places(const std::vector<std::size_t>& which, ForceSum& sum) const {
  const auto count = static_cast<Eigen::Index>(which.size());
  std::vector<SurfacePlace> places;
  PlaceSprings springs{nullptr, Scalars(count), Points(count, 3)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t spring = which[static_cast<std::size_t>(i)];
    places.push_back(attached[spring].place);
    springs.stiffness[i] = stiffness(spring);
    springs.targets.row(i) = points.row(static_cast<Eigen::Index>(spring));
  }
  springs.rows = std::make_shared<const PlaceRows>(place_rows(patches, places));
  sum.springs.push_back(std::move(springs));
}

/// Those that have places around them: each place has its share of the stiffness and is pulled by the same way as the
/// nearest. Returns the springs that have none.
std::vector<std::size_t> NearestSprings::Parts::add_spread(const Points& now, ForceSum& sum) const {
  std::vector<SurfacePlace> places;
  for (const NearestPoint& found : attached) places.push_back(found.place);
  const std::vector<std::vector<SpreadPlaces::Share>> shares = spread->around(places);
  std::vector<std::size_t> alone;
  std::vector<std::ptrdiff_t> samples;
  std::vector<double> stiffnesses;
  std::vector<std::size_t> owners;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (shares[i].empty()) alone.push_back(i);
    for (const SpreadPlaces::Share& share : shares[i]) {
      samples.push_back(share.sample);
      stiffnesses.push_back(stiffness(i) * share.weight);
      owners.push_back(i);
    }
  }
  if (samples.empty()) return alone;
  PlaceSprings springs{spread->samples().point_rows(samples), Scalars(static_cast<Eigen::Index>(samples.size())), {}};
  springs.targets = springs.rows->rows * now;
  for (Eigen::Index i = 0; i < springs.stiffness.size(); ++i) {
    const std::size_t owner = owners[static_cast<std::size_t>(i)];
    springs.stiffness[i] = stiffnesses[static_cast<std::size_t>(i)];
    springs.targets.row(i) += points.row(static_cast<Eigen::Index>(owner)) - attached[owner].point.transpose();
  }
  sum.springs.push_back(std::move(springs));
  return alone;
}

NearestSprings::NearestSprings(const ElasticSurface& body, ConstValuesRef points, NearestSpringOptions options) {
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "the points of nearest springs need three columns");
  require_finite(points, "points of nearest springs");
  require_not_negative(options.radius, "the radius of nearest springs");
  const auto count = static_cast<std::size_t>(points.rows());
  if (options.stiffness.size() != 1 && options.stiffness.size() != count) {
    throw Error(ErrorCode::BadShape, std::to_string(count) + " nearest springs need one stiffness or one each, not " +
                                         std::to_string(options.stiffness.size()));
  }
  for (std::size_t i = 0; i < options.stiffness.size(); ++i) {
    require_not_negative(options.stiffness[i], "the stiffness of nearest spring " + std::to_string(i));
  }
  std::unique_ptr<const SpreadPlaces> spread;
  if (options.radius > 0.0) spread = std::make_unique<const SpreadPlaces>(body, options.radius, options.quadrature);
  parts_ = std::make_unique<Parts>(Parts{body.patches(),
                                         points,
                                         std::move(options),
                                         NearestPoints(body.patches(), body.rest()),
                                         std::move(spread),
                                         {},
                                         {}});
}

NearestSprings::~NearestSprings() = default;

const Points& NearestSprings::points() const { return parts_->points; }
const NearestSpringOptions& NearestSprings::options() const { return parts_->options; }
double NearestSprings::tolerance() const { return parts_->nearest.tolerance(); }

const std::vector<NearestPoint>& NearestSprings::attach(const Points& positions) const {
  Parts& parts = *parts_;
  if (parts.positions.rows() == positions.rows() && parts.positions == positions) return parts.attached;
  parts.positions.resize(0, 3);
  parts.nearest.set_control(positions);
  parts.attached.resize(static_cast<std::size_t>(parts.points.rows()));
  parts.nearest.nearest(parts.points, parts.attached);
  parts.positions = positions;
  return parts.attached;
}

void NearestSprings::add(const ForceInput& input, ForceSum& sum) const {
  const std::vector<NearestPoint>& attached = attach(input.positions);
  std::vector<std::size_t> alone;
  for (std::size_t i = 0; i < attached.size(); ++i) {
    sum.energy += 0.5 * parts_->stiffness(i) * attached[i].distance * attached[i].distance;
    if (!parts_->spread) alone.push_back(i);
  }
  if (parts_->spread) alone = parts_->add_spread(input.positions, sum);
  if (!alone.empty()) parts_->add_at_places(alone, sum);
}

std::shared_ptr<const Force> NearestSprings::refined(const ElasticSurface& /*body*/,
                                                     const ElasticSurface& child) const {
  return std::make_shared<NearestSprings>(child, parts_->points, parts_->options);
}

}  // namespace batten
