#include "batten/volume/segment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"
#include "batten/fit/first_mesh.h"
#include "batten/fit/surface_fitter.h"
#include "batten/mesh/self_intersections.h"
#include "batten/refine/refinement.h"
#include "batten/volume/edge_search.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/segment_measures.h"

namespace batten {

namespace {

/// The surface is searched for places where it meets itself as a mesh of so many faces or more.
constexpr std::int64_t kSearchedFaces = 20000;

double rms_of(const Scalars& distances) {
  return std::sqrt(distances.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, distances.size())));
}

/// Pairs of triangles of the surface that meet.
std::int64_t meetings_of(const SurfaceFitter& fitter) {
  Mesh control = mesh_from_topology(fitter.topology());
  control.points = fitter.control();
  const Mesh fine = surface_of_faces(fitter.topology(), fitter.scheme(), control, kSearchedFaces);
  return find_self_intersections(Topology(fine), fine.points).count;
}

void require_options(const SegmentOptions& options) {
  if (is_interpolating(options.scheme.kind))
    throw Error(ErrorCode::BadArgument, "segments have Catmull-Clark or Loop surfaces");
  if (!(options.smoothing >= 0.0) || !std::isfinite(options.smoothing))
    throw Error(ErrorCode::BadArgument, "the smoothing is 0 voxels or more");
}

/// Takes one step after the other, but for those after which the surface meets itself.
class GuardedSteps {
 public:
  GuardedSteps(SurfaceFitter& fitter, Segmentation& result)
      : fitter_(fitter), result_(result), meetings_(meetings_of(fitter)) {}

  /// Needs attach() first and leaves the surface attached. False where the step was taken back.
  bool take(FitStep step) {
    constexpr double kEvenness = 100.0;
    constexpr double kMostEven = 3e-2;
    step.evenness = std::max(step.fairness, std::min(kMostEven, kEvenness * step.fairness));
    const Values before = fitter_.control();
    // The fitter looks for folds alone: whether the surface meets itself is looked at more closely here.
    fitter_.move_to(fitter_.stepped(before, fitter_.find_step(step), Soundness::Unfolded));
    const std::int64_t after = meetings_of(fitter_);
    const bool cut = after > 0 && after >= meetings_;
    if (cut) fitter_.move_to(before);
    fitter_.attach();
    ++(cut ? result_.cut_steps : result_.rounds);
    if (!cut) meetings_ = after;
    return !cut;
  }

 private:
  SurfaceFitter& fitter_;
  Segmentation& result_;
  std::int64_t meetings_;
};

/// The rounds: fairness falls until the surface is near enough.
void draw_to_border(SurfaceFitter& fitter, double wanted, Segmentation& result, const Progress& progress) {
  constexpr int kMostRounds = 24;
  // A round with half the fairness of the one before gains so much, or control points only move apart.
  constexpr double kGain = 0.04;
  constexpr double kFirstFairness = 0.1;
  constexpr double kFall = 0.5;
  constexpr double kCutFall = 0.2;
  constexpr int kMostCuts = 4;
  FitStep step;
  step.fairness = kFirstFairness;
  double last = std::numeric_limits<double>::infinity();
  GuardedSteps steps(fitter, result);
  for (int round = 0; round < kMostRounds && result.cut_steps < kMostCuts; ++round) {
    report_progress(progress, static_cast<double>(round) / kMostRounds);
    if (!steps.take(step)) {
      step.fairness *= kCutFall;
      continue;
    }
    const double rms = rms_of(fitter.distances());
    if (rms <= wanted || rms > (1.0 - kGain) * last) break;
    last = rms;
    step.fairness *= kFall;
  }
}

Mesh control_mesh(const SurfaceFitter& fitter) {
  Mesh mesh = mesh_from_topology(fitter.topology());
  mesh.points = fitter.control();
  state_scheme(fitter.scheme(), mesh);
  return mesh;
}

}  // namespace

Segmentation segment_mask(const Volume& mask, const SegmentOptions& options, const Progress& progress) {
  require_options(options);
  const PointCloud border = mask_border(mask);
  FirstMeshOptions first;
  first.faces = options.scheme.kind == SchemeKind::Loop ? FaceKind::Triangles : FaceKind::Quads;
  first.vertices = options.vertices;
  first.genus = options.genus;
  first.bridge = 0.0;
  const FirstMesh start = first_mesh(border, first, progress_within(progress, 0.0, 0.5));
  SurfaceFitter fitter(Topology(start.mesh), options.scheme, start.mesh.points, border);
  fitter.attach();
  Segmentation result{{}, fitter.topology(), options.scheme};
  result.genus = start.genus();
  result.components = static_cast<Index>(start.parts.size());
  result.dropped_parts = start.dropped_parts;
  const double voxel = std::cbrt(mask.grid.voxel_volume());
  draw_to_border(fitter, options.smoothing * voxel, result, progress_within(progress, 0.5, 1.0));
  result.border_rms = rms_of(fitter.distances());
  result.mesh = control_mesh(fitter);
  report_progress(progress, 1.0);
  return result;
}

namespace {

/// Places of the surface and their normals.
PointCloud surface_places(const SurfaceFitter& fitter, const SurfaceSamples& samples) {
  const Points jets = samples.evaluate(fitter.control());
  PointCloud cloud;
  cloud.points.resize(samples.count(), 3);
  cloud.normals.resize(samples.count(), 3);
  for (Eigen::Index i = 0; i < samples.count(); ++i) {
    const Eigen::RowVector3d du = jets.row(3 * i + 1);
    const Eigen::RowVector3d dv = jets.row(3 * i + 2);
    cloud.points.row(i) = jets.row(3 * i);
    cloud.normals.row(i) = du.cross(dv).normalized();
  }
  return cloud;
}

/// The edges that were found and the points, each with its weight, as what the surface is drawn to.
void set_targets(SurfaceFitter& fitter, const PointCloud& places, const FoundEdges& edges, const Points& points,
                 double point_weight) {
  const Eigen::Index count = places.points.rows();
  PointCloud cloud;
  cloud.points.resize(count + points.rows(), 3);
  cloud.points << edges.places, points;
  cloud.normals = Points::Zero(cloud.points.rows(), 3);
  cloud.normals.topRows(count) = places.normals;
  Scalars weights(cloud.points.rows());
  weights.head(count) = edges.weights;
  if (points.rows() > 0)
    weights.tail(points.rows())
        .setConstant(point_weight * std::max(edges.weights.sum(), 1e-3 * static_cast<double>(count)) /
                     static_cast<double>(points.rows()));
  // Places without an edge hold the surface a little where it is.
  weights.head(count).array() += 1e-3;
  fitter.set_cloud(std::move(cloud));
  fitter.set_weights(std::move(weights));
}

void require_options(const ImageFitOptions& options) {
  const bool good = options.smoothing > 0.0 && options.reach > 0.0 && options.point_weight >= 0.0 &&
                    options.fairness > 0.0 && options.rounds >= 1;
  if (!good) throw Error(ErrorCode::BadArgument, "smoothing, reach and fairness are greater than 0, rounds 1 or more");
}

}  // namespace

Segmentation segment_image(const Segmentation& start, const Volume& image, const Points& points,
                           const ImageFitOptions& options, const Progress& progress) {
  constexpr double kFirstSmoothing = 3.0;
  constexpr double kFirstReach = 2.0;
  constexpr double kFirstFairness = 0.3;
  constexpr Index kMargin = 24;
  constexpr double kPointsFirst = 30.0;  // the points alone make the shape before edges count
  require_options(options);
  Segmentation result = start;
  result.rounds = 0;
  result.cut_steps = 0;
  const double voxel = std::cbrt(image.grid.voxel_volume());
  const Volume near = cropped_around(image, start.mesh.points, kMargin);
  const SurfacePatches patches(start.topology, start.scheme);
  const SurfaceSamples samples(patches, GaussSamples{{2, 0}});
  SurfaceFitter fitter(start.topology, start.scheme, start.mesh.points,
                       {start.mesh.points, Points::Zero(start.mesh.points.rows(), 3)});
  GuardedSteps steps(fitter, result);
  std::optional<EdgeSearch> search;
  for (int round = 0; round < options.rounds; ++round) {
    report_progress(progress, static_cast<double>(round) / options.rounds);
    const double done = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1.0;
    const double early = std::max(0.0, 1.0 - 1.5 * done);
    // The image is smoothed anew a few times only.
    if (round % 6 == 0) search.emplace(near, options.smoothing * voxel * std::pow(kFirstSmoothing, early));
    const PointCloud places = surface_places(fitter, samples);
    const FoundEdges edges =
        search->find(places.points, places.normals, options.reach * voxel * std::pow(kFirstReach, early));
    set_targets(fitter, places, edges, points, options.point_weight * std::pow(kPointsFirst, early));
    fitter.attach();
    FitStep step;
    step.pull = 0.0;
    step.fairness = options.fairness * std::pow(std::max(1.0, kFirstFairness / options.fairness), early);
    steps.take(step);
  }
  result.mesh = control_mesh(fitter);
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
