#include "batten/fit/surface_fitter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "batten/energy/surface_energy.h"
#include "batten/error.h"
#include "batten/fit/normal_equations.h"
#include "batten/fit/point_tree.h"
#include "batten/fit/relaxed_surface.h"
#include "batten/fit/surface_guard.h"
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

/// A surface and which of its faces are not sound.
struct JudgedSurface {
  Values control;
  Soundness asked;
  Buffer<std::uint8_t> flags;  ///< one a face of the control mesh
};

/// What belongs to one control mesh.
struct FitLevel {
  Topology topology;
  SurfacePatches patches;
  SurfaceWeights weights;
  NearestPoints nearest;
  LimitSurface surface;
  SurfaceGuard guard;
  Scalars stiffness;          ///< of each control point against moves along the surface
  Buffer<std::uint8_t> held;  ///< one flag a control point: the last step stopped it before faces folded
  NormalEquations equations;
  double energy_scale;
  SurfaceQuadrature samples;  ///< places that are drawn to the data
  std::vector<JudgedSurface> judged;

  FitLevel(const Topology& topology_in, const Scheme& scheme, ConstValuesRef control, const Progress& progress)
      : topology(topology_in),
        patches(topology, scheme, progress_within(progress, 0.0, 0.3)),
        weights(patches),
        nearest(patches, control, progress_within(progress, 0.3, 0.6)),
        surface(patches, control),
        guard(patches),
        stiffness(Scalars::Ones(topology.vertex_count())),
        held(static_cast<std::size_t>(topology.vertex_count()), 0),
        equations(
            SurfaceEnergy(patches, thin_plate()).matrix(EnergyKind::Stiffness, progress_within(progress, 0.6, 1.0))),
        energy_scale(scale_of(equations.energy())),
        samples(surface_quadrature(patches, {kSamplePoints, 0})) {}

  /// Keeps what is known of a surface: a round often asks about one that the last round has judged.
  void note(JudgedSurface one) {
    constexpr std::size_t kKept = 3;
    if (judged.size() == kKept) judged.erase(judged.begin());
    judged.push_back(std::move(one));
  }

  Buffer<std::uint8_t> flags_of(const Values& control, Soundness asked) {
    const auto known = std::find_if(judged.begin(), judged.end(), [&](const JudgedSurface& one) {
      return one.asked == asked && one.control == control;
    });
    if (known != judged.end()) return known->flags;
    note({control, asked, guard.unsound(control, asked)});
    return judged.back().flags;
  }

  Index unsound_count(const Values& control) {
    const Buffer<std::uint8_t> flags = flags_of(control, Soundness::Whole);
    return static_cast<Index>(std::count(flags.begin(), flags.end(), 1));
  }

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

/// Marks the vertices of a face and of those around it.
void hold_around(const Topology& topology, Index face, Buffer<std::uint8_t>& held) {
  for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h) {
    topology.for_each_outgoing(topology.origin(h), [&](Index around) {
      const Index other = topology.face(around);
      for (Index i = topology.face_begin(other); i < topology.face_end(other); ++i) held[topology.origin(i)] = 1;
    });
  }
}

/// The control points moved, where those around faces that would become unsound go a shorter way or none; these are
/// flagged in `held`. What is unsound already may stay so.
Values kept_sound(FitLevel& level, const Values& control, const Values& step, Soundness asked,
                  Buffer<std::uint8_t>& held) {
  constexpr int kHalvings = 3;
  constexpr int kTrials = 8;
  const Buffer<std::uint8_t> before = level.flags_of(control, asked);
  Scalars share = Scalars::Ones(control.rows());
  for (int trial = 0; trial < kTrials; ++trial) {
    Values moved = control + share.asDiagonal() * step;
    const Buffer<std::uint8_t> after = level.guard.unsound(moved, asked, before);
    Buffer<std::uint8_t> around(held.size(), 0);
    bool any = false;
    for (Index f = 0; f < static_cast<Index>(after.size()); ++f) {
      if (after[f] == 0 || before[f] != 0) continue;
      any = true;
      hold_around(level.topology, f, around);
    }
    if (!any) {
      level.note({moved, asked, after});
      return moved;
    }
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (around[v] == 0) continue;
      held[v] = 1;
      share[static_cast<Eigen::Index>(v)] *= trial < kHalvings ? 0.5 : 0.0;
    }
  }
  return control;
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

bool are_opposed(const Jet& jet, const PointCloud& cloud, Eigen::Index point) {
  return jet.du.cross(jet.dv).dot(cloud.normals.row(point).transpose()) < 0.0;
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

/// Solves the assembled system.
Values solve_step(const FitState& parts, const FitStep& options, const GivenMoves& given, SolveReport& report) {
  const FitLevel& level = *parts.level;
  Values normals = limit_normals(level.topology, parts.scheme, parts.control).vertices;
  const double unit = level.energy_scale;
  Fairness fairness{unit * options.fairness, unit * std::max(0.0, options.evenness - options.fairness), level.stiffness,
                    options.damping};
  if (options.mending > 0.0) {
    normals.setZero();
    fairness.tangent = unit * options.mending;
    for (std::size_t v = 0; v < level.held.size(); ++v)
      fairness.stiffness[static_cast<Eigen::Index>(v)] = level.held[v] != 0 ? 1.0 : 0.0;
  }
  return level.equations.solve(parts.control, normals, fairness, {options.tolerance, options.max_iterations, {}},
                               report, given);
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
  if (cloud.normals.rows() != count)
    throw Error(ErrorCode::BadShape, "a fit needs a normal for each point: there are " +
                                         std::to_string(cloud.normals.rows()) + " for " + std::to_string(count) +
                                         " points; see estimate_normals()");
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
SurfaceFitter& SurfaceFitter::operator=(SurfaceFitter&&) noexcept = default;

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
  Values step = solve_step(parts, options, {}, solved);
  if (report != nullptr) *report = std::move(solved);
  return step;
}

Values SurfaceFitter::find_step_beside(const FitStep& options, const Values& moves) const {
  SolveReport solved;
  return solve_step(*parts_, options, {parts_->level->held, moves}, solved);
}

bool SurfaceFitter::has_held() const {
  const Buffer<std::uint8_t>& held = parts_->level->held;
  return std::find(held.begin(), held.end(), 1) != held.end();
}

void SurfaceFitter::move_to(const Values& control) {
  parts_->level->nearest.set_control(control);
  parts_->level->surface.set_control(control);
  parts_->control = control;
}

Values SurfaceFitter::stepped(const Values& control, const Values& step, Soundness asked) {
  FitLevel& level = *parts_->level;
  require_control_points(level.topology, control);
  require_control_points(level.topology, step);
  std::fill(level.held.begin(), level.held.end(), std::uint8_t{0});
  Values moved = kept_sound(level, control, step, asked, level.held);
  for (Eigen::Index v = 0; v < level.stiffness.size(); ++v) {
    const bool held = level.held[static_cast<std::size_t>(v)] != 0;
    level.stiffness[v] = std::clamp(level.stiffness[v] * (held ? kStiffen : kSoften), 1.0, kStiffest);
  }
  return moved;
}

bool SurfaceFitter::relax(Soundness asked) {
  FitLevel& level = *parts_->level;
  if (std::count(level.held.begin(), level.held.end(), 1) == 0) return false;
  const Values control = relaxed_along(level.topology, parts_->scheme, parts_->control, level.held);
  Buffer<std::uint8_t> blocked(level.held.size(), 0);
  move_to(asked == Soundness::Unfolded ? control
                                       : kept_sound(level, parts_->control, control - parts_->control, asked, blocked));
  return true;
}

Index SurfaceFitter::unsound_faces() const { return unsound_faces(parts_->control); }

Index SurfaceFitter::unsound_faces(const Values& control) const { return parts_->level->unsound_count(control); }

void SurfaceFitter::even_out_unsound(double part) {
  FitLevel& level = *parts_->level;
  move_to(evened_out(level.topology, parts_->control, level.flags_of(parts_->control, Soundness::Whole), part));
}

Index SurfaceFitter::hold_unsound() {
  FitLevel& level = *parts_->level;
  const Buffer<std::uint8_t> flags = level.flags_of(parts_->control, Soundness::Whole);
  for (Index f = 0; f < static_cast<Index>(flags.size()); ++f) {
    if (flags[f] != 0) hold_around(level.topology, f, level.held);
  }
  return static_cast<Index>(std::count(flags.begin(), flags.end(), 1));
}

void SurfaceFitter::refine() {
  Parts& parts = *parts_;
  const Refinement refinement(parts.level->topology, parts.scheme);
  parts.control = refinement.apply(parts.control);
  parts.scheme = parts.scheme.after_first_step();
  parts.level = std::make_unique<FitLevel>(refinement.child(), parts.scheme, parts.control, Progress());
}

}  // namespace batten
