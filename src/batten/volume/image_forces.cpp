#include "batten/volume/image_forces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/volume/distance_transform.h"
#include "batten/volume/inside_volume.h"

namespace batten {

namespace {

/// The rows of the points of all places.
std::shared_ptr<const PlaceRows> all_rows(const SurfaceSamples& samples) {
  std::vector<std::ptrdiff_t> which(static_cast<std::size_t>(samples.count()));
  std::iota(which.begin(), which.end(), std::ptrdiff_t{0});
  return samples.point_rows(which);
}

/// du x dv of a place.
Eigen::Vector3d cross_of(const Points& jets, Eigen::Index sample) {
  return Eigen::Vector3d(jets.row(3 * sample + 1)).cross(Eigen::Vector3d(jets.row(3 * sample + 2)));
}

/// Adds springs along lines, and their energy.
void add_springs(PlaceSprings springs, const Points& points, ForceSum& sum) {
  const Scalars along = ((springs.targets - points).cwiseProduct(springs.directions)).rowwise().sum();
  sum.energy += 0.5 * springs.stiffness.dot(along.cwiseAbs2());
  sum.springs.push_back(std::move(springs));
}

void require_stiffness(double stiffness, const std::string& what) {
  require_not_negative(stiffness, "the stiffness of " + what);
}

}  // namespace

AreaPlaces area_places(const ElasticSurface& body, const QuadratureOptions& quadrature) {
  auto samples = std::make_shared<const SurfaceSamples>(body.patches(), GaussSamples{quadrature});
  Scalars areas = sample_areas(*samples, samples->evaluate(body.rest()));
  return {std::move(samples), std::move(areas)};
}

PotentialForce::PotentialForce(const ElasticSurface& body, std::shared_ptr<const SplineField> potential,
                               PotentialOptions options)
    : potential_(std::move(potential)), options_(options), places_(area_places(body, options_.quadrature)) {
  require_finite_number(options_.strength, "the strength of an image's potential");
  if (options_.guard && !(*options_.guard > 0.0 && std::isfinite(*options_.guard)))
    throw Error(ErrorCode::BadArgument, "the guard of an image's potential is more than 0");
}

void PotentialForce::add(const ForceInput& input, ForceSum& sum) const {
  const Points jets = places_.samples->evaluate(input.positions);
  Points forces(places_.areas.size(), 3);
  Scalars energies(places_.areas.size());
  parallel_for(forces.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const FieldValue field = potential_->at(jets.row(3 * i).transpose());
      const double size = options_.guard ? std::hypot(field.gradient.norm(), *options_.guard) : 1.0;
      forces.row(i) = options_.strength * places_.areas[i] / size * field.gradient.transpose();
      energies[i] = -options_.strength * places_.areas[i] * field.value;
    }
  });
  sum.force += places_.samples->pull_back(forces);
  if (!options_.guard) sum.energy += energies.sum();
}

std::shared_ptr<const Force> PotentialForce::refined(const ElasticSurface& /*body*/,
                                                     const ElasticSurface& child) const {
  return std::make_shared<PotentialForce>(child, potential_, options_);
}

EdgeSprings::EdgeSprings(const ElasticSurface& body, std::shared_ptr<const EdgeSearch> edges, EdgeSpringOptions options)
    : edges_(std::move(edges)),
      options_(options),
      places_(area_places(body, options_.quadrature)),
      rows_(all_rows(*places_.samples)) {
  require_stiffness(options_.stiffness, "edge springs");
  if (!(options_.reach > 0.0 && std::isfinite(options_.reach)))
    throw Error(ErrorCode::BadArgument, "the reach of edge springs is more than 0 mm");
}

void EdgeSprings::add(const ForceInput& input, ForceSum& sum) const {
  const Points jets = places_.samples->evaluate(input.positions);
  Points points(places_.areas.size(), 3);
  Points normals(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) = jets.row(3 * i);
    normals.row(i) = cross_of(jets, i).normalized().transpose();
  }
  FoundEdges found = edges_->find(points, normals, options_.reach);
  const Scalars stiffness = options_.stiffness * places_.areas.cwiseProduct(found.weights);
  add_springs({rows_, stiffness, std::move(found.places), false, std::move(normals)}, points, sum);
}

std::shared_ptr<const Force> EdgeSprings::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<EdgeSprings>(child, edges_, options_);
}

RegionMeans region_means(const Volume& image, const Mesh& fine, Index margin) {
  const Volume box = cropped_around(image, fine.points, margin);
  const Volume parts = inside_volume(fine, box.grid, VoxelRule::Part);
  double inside = 0.0;
  double outside = 0.0;
  RegionMeans means;
  for (std::size_t i = 0; i < box.values.size(); ++i) {
    const double part = std::clamp(static_cast<double>(parts.values[i]), 0.0, 1.0);
    inside += part;
    outside += 1.0 - part;
    means.inside += part * box.values[i];
    means.outside += (1.0 - part) * box.values[i];
  }
  if (!(inside > 0.0) || !(outside > 0.0))
    throw Error(ErrorCode::BadArgument, "no part of the image is inside the mesh, or none outside");
  return {means.inside / inside, means.outside / outside};
}

RegionForce::RegionForce(const ElasticSurface& body, std::shared_ptr<const SplineField> image, RegionMeans means,
                         RegionOptions options)
    : image_(std::move(image)),
      means_(means),
      options_(options),
      samples_(std::make_shared<const SurfaceSamples>(body.patches(), GaussSamples{options_.quadrature})) {
  require_finite_number(options_.strength, "the strength of a region");
  require_finite_number(means_.inside, "the mean inside");
  require_finite_number(means_.outside, "the mean outside");
  if (means_.inside == means_.outside)
    throw Error(ErrorCode::BadArgument, "the means inside and outside are equal: nothing tells them apart");
}

void RegionForce::add(const ForceInput& input, ForceSum& sum) const {
  const Points jets = samples_->evaluate(input.positions);
  Points forces(samples_->count(), 3);
  parallel_for(forces.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const double number = image_->at(jets.row(3 * i).transpose()).value;
      const double share = (2.0 * number - means_.inside - means_.outside) / (means_.inside - means_.outside);
      forces.row(i) =
          options_.strength * samples_->weight(i) * std::clamp(share, -1.0, 1.0) * cross_of(jets, i).transpose();
    }
  });
  sum.force += samples_->pull_back(forces);
}

std::shared_ptr<const Force> RegionForce::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<RegionForce>(child, image_, means_, options_);
}

Volume signed_distance(const Volume& mask) {
  require_volume(mask);
  Buffer<std::uint8_t> inside(mask.values.size());
  Buffer<std::uint8_t> outside(mask.values.size());
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < mask.values.size(); ++i) {
    inside[i] = mask.values[i] > 0.5F ? 1 : 0;
    outside[i] = 1 - inside[i];
    count += inside[i];
  }
  if (count == 0 || count == mask.grid.count())
    throw Error(ErrorCode::BadArgument, "a mask with a border has voxels inside and outside");
  const Buffer<float> to_inside = distance_transform(mask.grid, inside);
  const Buffer<float> to_outside = distance_transform(mask.grid, outside);
  const auto half = static_cast<float>(0.5 * std::cbrt(mask.grid.voxel_volume()));
  Volume result{mask.grid, Buffer<float>(mask.values.size())};
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = inside[i] != 0 ? half - to_outside[i] : to_inside[i] - half;
  return result;
}

MaskSprings::MaskSprings(const ElasticSurface& body, std::shared_ptr<const SplineField> distance,
                         MaskSpringOptions options)
    : distance_(std::move(distance)),
      options_(options),
      places_(area_places(body, options_.quadrature)),
      rows_(all_rows(*places_.samples)) {
  require_stiffness(options_.stiffness, "mask springs");
}

/// A spring of stiffness k |grad d|^2 to where d would be 0, were it linear: its force is -k d grad d.
void MaskSprings::add(const ForceInput& input, ForceSum& sum) const {
  const Points jets = places_.samples->evaluate(input.positions);
  const Eigen::Index count = places_.areas.size();
  Points points(count, 3);
  PlaceSprings springs{rows_, Scalars::Zero(count), Points(count, 3), false, Points::Zero(count, 3)};
  double energy = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    points.row(i) = jets.row(3 * i);
    const FieldValue field = distance_->at(points.row(i).transpose());
    const double square = field.gradient.squaredNorm();
    springs.targets.row(i) = points.row(i);
    energy += 0.5 * options_.stiffness * places_.areas[i] * field.value * field.value;
    if (!(square > 0.0)) continue;  // in the middle, or outside the mask's box
    springs.stiffness[i] = options_.stiffness * places_.areas[i] * square;
    springs.targets.row(i) -= field.value / square * field.gradient.transpose();
    springs.directions.row(i) = field.gradient.transpose() / std::sqrt(square);
  }
  sum.springs.push_back(std::move(springs));
  sum.energy += energy;
}

std::shared_ptr<const Force> MaskSprings::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<MaskSprings>(child, distance_, options_);
}

}  // namespace batten
