#include "batten/volume/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/fit/first_mesh.h"
#include "batten/fit/surface_fitter.h"
#include "batten/mesh/self_intersections.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/volume/label_mask.h"

namespace batten {

namespace {

/// Levels of the mesh in which the surface is searched for places where it meets itself.
constexpr int kSearchedLevels = 2;

double rms_of(const Scalars& distances) {
  return std::sqrt(distances.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, distances.size())));
}

/// Pairs of triangles of the surface that meet.
std::int64_t meetings_of(const SurfaceFitter& fitter) {
  Mesh control = mesh_from_topology(fitter.topology());
  control.points = fitter.control();
  const Mesh fine = surface_mesh(fitter.topology(), fitter.scheme(), control, kSearchedLevels);
  return find_self_intersections(Topology(fine), fine.points).count;
}

void require_options(const SegmentOptions& options) {
  if (is_interpolating(options.scheme.kind))
    throw Error(ErrorCode::BadArgument, "segments have Catmull-Clark or Loop surfaces");
  if (!(options.smoothing >= 0.0) || !std::isfinite(options.smoothing))
    throw Error(ErrorCode::BadArgument, "the smoothing is 0 voxels or more");
}

/// The rounds: fairness falls until the surface is near enough.
void draw_to_border(SurfaceFitter& fitter, double wanted, Segmentation& result, const Progress& progress) {
  constexpr int kMostRounds = 24;
  // A round with half the fairness of the one before gains so much, or control points only move apart.
  constexpr double kGain = 0.04;
  constexpr double kFirstFairness = 0.1;
  constexpr double kFall = 0.5;
  constexpr double kEvenness = 100.0;
  constexpr double kMostEven = 3e-2;
  FitStep step;
  step.fairness = kFirstFairness;
  constexpr double kCutFall = 0.2;
  constexpr int kMostCuts = 4;
  double last = std::numeric_limits<double>::infinity();
  std::int64_t meetings = meetings_of(fitter);
  for (int round = 0; round < kMostRounds; ++round) {
    report_progress(progress, static_cast<double>(round) / kMostRounds);
    step.evenness = std::max(step.fairness, std::min(kMostEven, kEvenness * step.fairness));
    const Values before = fitter.control();
    fitter.move_to(fitter.stepped(before, fitter.find_step(step)));
    const std::int64_t after = meetings_of(fitter);
    const bool cut = after > 0 && after >= meetings;
    if (cut) fitter.move_to(before);
    fitter.attach();
    if (cut) {
      step.fairness *= kCutFall;
      if (++result.cut_steps == kMostCuts) break;
      continue;
    }
    meetings = after;
    ++result.rounds;
    const double rms = rms_of(fitter.distances());
    if (rms <= wanted || rms > (1.0 - kGain) * last) break;
    last = rms;
    step.fairness *= kFall;
  }
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
  result.mesh = mesh_from_topology(fitter.topology());
  result.mesh.points = fitter.control();
  state_scheme(options.scheme, result.mesh);
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
