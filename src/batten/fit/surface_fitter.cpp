#include "batten/fit/surface_fitter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "batten/energy/surface_energy.h"
#include "batten/error.h"
#include "batten/fit/normal_equations.h"
#include "batten/fit/point_tree.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"
#include "batten/refine/refinement.h"
#include "batten/solve/sparse_product.h"
#include "batten/surface/quadrature.h"
#include "batten/surface/surface_weights.h"

namespace batten {

namespace {

/// A little of it keeps faces of equal size where the thin plate would let them slide.
constexpr double kTension = 1e-2;

/// Where control points had to stop before faces folded, they resist moves along the surface the more.
constexpr double kStiffen = 2.0;
constexpr double kSoften = 0.8;
constexpr double kStiffest = 100.0;

/// A side of a face has so many places that are drawn to the data.
constexpr int kSamplePoints = 2;

EnergyOptions thin_plate() {
  EnergyOptions options;
  options.tension = {kTension};
  return options;
}

}  // namespace

/// What belongs to one control mesh.
struct FitLevel {
  Topology topology;
  SurfacePatches patches;
  SurfaceWeights weights;
  NearestPoints nearest;
  LimitSurface surface;
  Scalars stiffness;  ///< of each control point against moves along the surface
  NormalEquations equations;
  double energy_scale;
  SurfaceQuadrature samples;  ///< places that are drawn to the data

  FitLevel(const Topology& topology_in, const Scheme& scheme, ConstValuesRef control, const Progress& progress)
      : topology(topology_in),
        patches(topology, scheme, progress),
        weights(patches),
        nearest(patches, control, progress),
        surface(patches, control),
        stiffness(Scalars::Ones(topology.vertex_count())),
        equations(SurfaceEnergy(patches, thin_plate()).matrix(EnergyKind::Stiffness, progress)),
        energy_scale(scale_of(equations.energy())),
        samples(surface_quadrature(patches, {kSamplePoints, 0})) {}

  /// Makes the mean diagonal 1/V, as that of the mean squared distance is about.
  static double scale_of(const NormalEquations::Matrix& energy) {
    const double trace = energy.diagonal().sum();
    return trace > 0.0 ? 1.0 / trace : 0.0;
  }
};

/// All that a fitter knows.
struct FitState {
  Scheme scheme;
  PointCloud cloud;
  PointTree tree{Points(0, 3)};
  Values control;
  Scalars weights;
  double weight_sum;
  double spacing;  ///< the median distance between neighbouring points
  std::unique_ptr<FitLevel> level;
  std::vector<NearestPoint> attached;
  Scalars distances;
};

struct SurfaceFitter::Parts : FitState {};

namespace {

double median_spacing(const PointTree& tree) {
  if (tree.size() < 2) return 0.0;
  Buffer<double> distances = find_neighbours(tree, 1).distances;
  return quantile(distances, 0.5);
}

/// One flag a face of the base: between neighbours of a grid of places on it the normal turns by more than a right
/// angle.
Buffer<std::uint8_t> folded_faces(const FitLevel& level) {
  constexpr int kSide = 6;
  constexpr std::ptrdiff_t kBlock = 64;
  const Index faces = level.patches.base().face_count();
  Buffer<std::uint8_t> folded(static_cast<std::size_t>(faces), 0);
  const bool quads = level.patches.quads();
  const double middle = quads ? 0.5 : 1.0 / 3.0;
  parallel_for(
      faces,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::array<Eigen::Vector3d, static_cast<std::size_t>(kSide)> row;
        for (auto f = static_cast<Index>(begin); f < static_cast<Index>(end); ++f) {
          for (int j = 0; j < kSide; ++j) {
            Eigen::Vector3d last = Eigen::Vector3d::Zero();
            for (int i = 0; i < (quads ? kSide : kSide - j); ++i) {
              const Jet jet = level.surface.jet({f, (i + middle) / kSide, (j + middle) / kSide});
              const Eigen::Vector3d normal = jet.du.cross(jet.dv);
              Eigen::Vector3d& below = row[static_cast<std::size_t>(i)];
              if ((i > 0 && normal.dot(last) < 0.0) || (j > 0 && normal.dot(below) < 0.0)) folded[f] = 1;
              below = normal;
              last = normal;
            }
          }
        }
      },
      kBlock);
  return folded;
}

/// Marks the vertices of a face and of those around it.
void hold_around(const Topology& topology, Index face, Buffer<std::uint8_t>& held) {
  for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h) {
    topology.for_each_outgoing(topology.origin(h), [&](Index around) {
      const Index other = topology.face(around);
      for (Index i = topology.face_begin(other); i < topology.face_end(other); ++i) held[topology.origin(i)] = 1;
    });
  }
}

/// Places of the surface, where each is drawn to and how.
struct Pulls {
  std::vector<SurfacePlace> places;
  std::vector<Form> forms;
  Points offsets;

  void resize(std::size_t count) {
    places.resize(count);
    forms.assign(count, Form{});
    offsets = Points::Zero(static_cast<Eigen::Index>(count), 3);
  }
};

void scale(double factor, Form& form) {
  for (double& number : form) number *= factor;
}

bool are_opposed(const Jet& jet, const PointCloud& cloud, Eigen::Index point) {
  return cloud.normals.rows() > 0 && jet.du.cross(jet.dv).dot(cloud.normals.row(point).transpose()) < 0.0;
}

/// Each point draws the place nearest to it, or where that faces the other way the nearest sample that does not.
void pull_to_surface(const FitState& parts, const std::vector<Jet>& jets, Pulls& pulls) {
  constexpr Index kCandidates = 32;
  const std::ptrdiff_t count = parts.cloud.points.rows();
  const auto samples = static_cast<std::ptrdiff_t>(parts.level->samples.places.size());
  Points sample_points(samples, 3);
  for (std::ptrdiff_t i = 0; i < samples; ++i)
    sample_points.row(i) = jets[static_cast<std::size_t>(count + i)].point.transpose();
  const PointTree tree(std::move(sample_points));
  parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Index found[kCandidates];
    double squares[kCandidates];
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const auto point = static_cast<std::size_t>(i);
      Form& form = pulls.forms[point];
      if (!are_opposed(jets[point], parts.cloud, i)) {
        const Eigen::Vector3d offset = parts.cloud.points.row(i).transpose() - jets[point].point;
        pulls.offsets.row(i) = offset.transpose();
        form = distance_form(jets[point], offset);
      } else {
        const Index near = tree.nearest(parts.cloud.points.row(i), kCandidates, found, squares);
        Index k = 0;
        while (k < near && are_opposed(jets[static_cast<std::size_t>(count + found[k])], parts.cloud, i)) ++k;
        if (k == near) continue;
        pulls.places[point] = parts.level->samples.places[static_cast<std::size_t>(found[k])];
        pulls.offsets.row(i) = parts.cloud.points.row(i) - tree.points().row(found[k]);
        form = kPointForm;
      }
      scale(parts.weights[i] / parts.weight_sum, form);
    }
  });
}

/// Each sample of the surface is drawn to the nearest point whose normal agrees; points of no weight draw nothing.
void pull_to_data(const FitState& parts, const std::vector<Jet>& jets, double weight, Pulls& pulls) {
  constexpr Index kCandidates = 8;
  const FitLevel& level = *parts.level;
  const Scalars areas = area_weights(level.surface, level.samples);
  const double unit = weight / areas.sum();
  const Eigen::Index first = parts.cloud.points.rows();
  parallel_for(areas.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Index found[kCandidates];
    double squares[kCandidates];
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const Jet& jet = jets[static_cast<std::size_t>(first + i)];
      const Index count = parts.tree.nearest(jet.point.transpose(), kCandidates, found, squares);
      Index k = 0;
      while (k < count && (!(parts.weights[found[k]] > 0.0) || are_opposed(jet, parts.cloud, found[k]))) ++k;
      if (k == count) continue;
      const Eigen::Vector3d offset = parts.cloud.points.row(found[k]).transpose() - jet.point;
      pulls.offsets.row(first + i) = offset.transpose();
      Form& form = pulls.forms[static_cast<std::size_t>(first + i)];
      form = plane_form(parts.cloud.normals.row(found[k]).transpose(), offset, parts.spacing);
      scale(unit * areas[i], form);
    }
  });
}

}  // namespace

SurfaceFitter::SurfaceFitter(const Topology& topology, const Scheme& scheme, ConstValuesRef control, PointCloud cloud,
                             const Progress& progress)
    : parts_(std::make_unique<Parts>()) {
  require_control_points(topology, control);
  set_cloud(std::move(cloud));
  parts_->scheme = scheme;
  parts_->control = control;
  parts_->level = std::make_unique<FitLevel>(topology, scheme, control, progress);
}

void SurfaceFitter::set_cloud(PointCloud cloud) {
  require_finite(cloud.points, "points");
  require_finite(cloud.normals, "normals");
  const Eigen::Index count = cloud.points.rows();
  if (count == 0) throw Error(ErrorCode::BadArgument, "there are no points to fit");
  if (cloud.normals.rows() != 0 && cloud.normals.rows() != count)
    throw Error(ErrorCode::BadShape, "there are " + std::to_string(cloud.normals.rows()) + " normals for " +
                                         std::to_string(count) + " points");
  Parts& parts = *parts_;
  parts.tree = PointTree(cloud.points);
  parts.cloud = std::move(cloud);
  parts.weights = Scalars::Ones(count);
  parts.weight_sum = static_cast<double>(count);
  parts.attached.resize(static_cast<std::size_t>(count));
  parts.distances = Scalars::Zero(count);
  parts.spacing = median_spacing(parts.tree);
}

SurfaceFitter::~SurfaceFitter() = default;
SurfaceFitter::SurfaceFitter(SurfaceFitter&&) noexcept = default;

const Topology& SurfaceFitter::topology() const { return parts_->level->topology; }
const Scheme& SurfaceFitter::scheme() const { return parts_->scheme; }
const Values& SurfaceFitter::control() const { return parts_->control; }
const PointCloud& SurfaceFitter::cloud() const { return parts_->cloud; }
std::span<const NearestPoint> SurfaceFitter::attached() const { return parts_->attached; }
const Scalars& SurfaceFitter::distances() const { return parts_->distances; }
const Scalars& SurfaceFitter::weights() const { return parts_->weights; }
double SurfaceFitter::spacing() const { return parts_->spacing; }

void SurfaceFitter::attach(const Progress& progress) {
  Parts& parts = *parts_;
  parts.level->nearest.nearest(parts.cloud.points, parts.attached, progress);
  for (std::size_t i = 0; i < parts.attached.size(); ++i)
    parts.distances[static_cast<Eigen::Index>(i)] = parts.attached[i].distance;
}

void SurfaceFitter::set_weights(Scalars weights) {
  Parts& parts = *parts_;
  if (weights.size() != parts.cloud.points.rows() || !(weights.minCoeff() >= 0.0) || !(weights.sum() > 0.0))
    throw Error(ErrorCode::BadArgument, "weights must be one a point, not negative, and not all zero");
  parts.weights = std::move(weights);
  parts.weight_sum = parts.weights.sum();
}

double SurfaceFitter::objective(double fairness) const {
  const Parts& parts = *parts_;
  const FitLevel& level = *parts.level;
  Values product;
  multiply(level.equations.energy(), parts.control, product);
  const double energy = parts.control.cwiseProduct(product).sum();
  return parts.distances.cwiseAbs2().dot(parts.weights) / parts.weight_sum + fairness * level.energy_scale * energy;
}

Values SurfaceFitter::find_step(const FitStep& options, SolveReport* report) const {
  const Parts& parts = *parts_;
  FitLevel& level = *parts.level;
  Pulls pulls;
  const std::size_t count = parts.attached.size();
  pulls.resize(count + level.samples.places.size());
  for (std::size_t i = 0; i < count; ++i) pulls.places[i] = parts.attached[i].place;
  std::copy(level.samples.places.begin(), level.samples.places.end(),
            pulls.places.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<Jet> jets(pulls.places.size());
  level.surface.jets(pulls.places, jets);
  pull_to_surface(parts, jets, pulls);
  if (options.pull > 0.0) pull_to_data(parts, jets, options.pull, pulls);
  level.equations.assemble(level.weights.rows(pulls.places), pulls.forms, pulls.offsets);
  SolveReport solved;
  const Values normals = limit_normals(level.topology, parts.scheme, parts.control).vertices;
  const double unit = level.energy_scale;
  const Fairness fairness{unit * options.fairness, unit * std::max(0.0, options.evenness - options.fairness),
                          level.stiffness, options.damping};
  Values step =
      level.equations.solve(parts.control, normals, fairness, {options.tolerance, options.max_iterations, {}}, solved);
  if (report != nullptr) *report = std::move(solved);
  return step;
}

void SurfaceFitter::move_to(const Values& control) {
  parts_->level->nearest.set_control(control);
  parts_->level->surface.set_control(control);
  parts_->control = control;
}

Values SurfaceFitter::stepped(const Values& control, const Values& step) {
  constexpr int kHalvings = 4;
  FitLevel& level = *parts_->level;
  level.surface.set_control(control);
  const Buffer<std::uint8_t> before = folded_faces(level);
  level.stiffness = (kSoften * level.stiffness).cwiseMax(1.0);
  Scalars share = Scalars::Ones(control.rows());
  Values moved;
  for (int halving = 0; halving <= kHalvings; ++halving) {
    moved = control + share.asDiagonal() * step;
    level.surface.set_control(moved);
    const Buffer<std::uint8_t> after = folded_faces(level);
    Buffer<std::uint8_t> held(static_cast<std::size_t>(control.rows()), 0);
    bool any = false;
    for (Index f = 0; f < static_cast<Index>(after.size()); ++f) {
      if (after[f] == 0 || before[f] != 0) continue;
      any = true;
      hold_around(level.topology, level.patches.control_face(f), held);
    }
    if (!any) break;
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (held[v] == 0) continue;
      const auto row = static_cast<Eigen::Index>(v);
      share[row] *= halving + 1 < kHalvings ? 0.5 : 0.0;
      if (halving == 0) level.stiffness[row] = std::min(kStiffest, level.stiffness[row] * kStiffen);
    }
  }
  return moved;
}

void SurfaceFitter::refine() {
  Parts& parts = *parts_;
  const Refinement refinement(parts.level->topology, parts.scheme);
  parts.control = refinement.apply(parts.control);
  parts.scheme = parts.scheme.after_first_step();
  parts.level = std::make_unique<FitLevel>(refinement.child(), parts.scheme, parts.control, Progress());
}

}  // namespace batten
