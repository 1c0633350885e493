#include "batten/volume/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/fit/first_mesh.h"
#include "batten/fit/surface_fitter.h"
#include "batten/volume/guarded_steps.h"
#include "batten/volume/label_mask.h"

namespace batten {

namespace {

double rms_of(const Scalars& distances) {
  return std::sqrt(distances.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, distances.size())));
}

void require_options(const SegmentOptions& options) {
  if (is_interpolating(options.scheme.kind))
    throw Error(ErrorCode::BadArgument, "segments have Catmull-Clark or Loop surfaces");
  if (!(options.smoothing >= 0.0) || !std::isfinite(options.smoothing))
    throw Error(ErrorCode::BadArgument, "the smoothing is 0 voxels or more");
}

/// count: of the faces between the part's voxels and others. first_mesh() takes 20 points or more.
void require_faces(Eigen::Index count) {
  constexpr Eigen::Index kFewest = 20;
  if (count < kFewest)
    throw Error(ErrorCode::BadArgument, "the part has only " + std::to_string(count) +
                                            " outer faces of voxels, too few for a surface; resample the volume to "
                                            "smaller voxels, or leave the part out");
}

/// The border of a mask. A part of one voxel's thickness is thinner than the middles of its faces are apart, and comes
/// out in pieces: its faces have several points each, as many as the control points that are asked for can follow.
PointCloud border_to_follow(const Volume& mask, Index vertices) {
  constexpr double kThin = 1.5;    // faces a voxel; a plate of one voxel's thickness has more than two
  constexpr double kPoints = 2.0;  // a control point
  constexpr Index kLeast = 2;      // along a side
  constexpr Index kMost = 8;
  PointCloud border = mask_border(mask);
  const auto faces = static_cast<double>(border.points.rows());
  const auto voxels = static_cast<double>(std::count(mask.values.begin(), mask.values.end(), 1.0F));
  require_faces(border.points.rows());
  if (faces < kThin * voxels) return border;
  const auto along = static_cast<Index>(std::ceil(std::sqrt(kPoints * vertices / faces)));
  return mask_border(mask, std::clamp(along, kLeast, kMost));
}

/// The rounds: fairness falls until the surface is near enough. Returns that of the last step.
double draw_to_border(SurfaceFitter& fitter, GuardedSteps& steps, double wanted, const Progress& progress) {
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
  double taken = step.fairness;
  for (int round = 0; round < kMostRounds && steps.cut() < kMostCuts; ++round) {
    report_progress(progress, static_cast<double>(round) / kMostRounds);
    if (!steps.take(step)) {
      step.fairness *= kCutFall;
      continue;
    }
    taken = step.fairness;
    const double rms = rms_of(fitter.distances());
    if (rms <= wanted || rms > (1.0 - kGain) * last) break;
    last = rms;
    step.fairness *= kFall;
  }
  return taken;
}

}  // namespace

Segmentation segment_mask(const Volume& mask, const SegmentOptions& options, const Progress& progress) {
  require_options(options);
  const PointCloud border = border_to_follow(mask, options.vertices);
  FirstMeshOptions first;
  first.faces = options.scheme.kind == SchemeKind::Loop ? FaceKind::Triangles : FaceKind::Quads;
  first.vertices = options.vertices;
  first.genus = options.genus;
  first.bridge = 0.0;
  const FirstMesh start = first_mesh(border, first, progress_within(progress, 0.0, 0.5));
  SurfaceFitter fitter(Topology(start.mesh), options.scheme, start.mesh.points, border);
  GuardedSteps steps(fitter, options.within, options.watch);
  fitter.attach();
  Segmentation result{{}, fitter.topology(), options.scheme};
  result.genus = start.genus();
  result.components = static_cast<Index>(start.parts.size());
  result.dropped_parts = start.dropped_parts;
  const double voxel = std::cbrt(mask.grid.voxel_volume());
  result.fairness = draw_to_border(fitter, steps, options.smoothing * voxel, progress_within(progress, 0.5, 1.0));
  if (steps.meetings() > 0) steps.mend();
  result.rounds = steps.taken();
  result.cut_steps = steps.cut();
  result.border_rms = rms_of(fitter.distances());
  result.mesh = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
