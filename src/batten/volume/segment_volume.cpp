#include "batten/volume/segment_volume.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "batten/error.h"
#include "batten/mesh/component_volumes.h"
#include "batten/refine/refinement.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/mask_contours.h"
#include "batten/volume/points_mask.h"
#include "batten/volume/slices_mask.h"

namespace batten {

namespace {

void require_request(const SegmentRequest& request) {
  const int starts = (request.points.rows() > 0 ? 1 : 0) + (request.seed ? 1 : 0) + (request.start ? 1 : 0);
  if (starts > 1) throw Error(ErrorCode::BadArgument, "a surface starts from points, from a seed or from a mesh");
  if (starts > 0 && !request.labels && !request.label.empty())
    throw Error(ErrorCode::BadArgument,
                "a label beside points, a seed or a mesh needs the volume of labels that it is in");
  if (request.seed_options.range && !request.seed)
    throw Error(ErrorCode::BadArgument, "a range of numbers goes with a seed");
}

bool is_closed(const Topology& topology, const Points& points) {
  const ComponentVolumes volumes = component_volumes(topology, points);
  return volumes.closed_count() == volumes.components.count;
}

/// A mesh as the start of segment_image().
Segmentation started_from(const Mesh& mesh, const Volume& image, Scheme scheme) {
  if (mesh.scheme) scheme = choose_scheme(mesh);
  Segmentation start{mesh, Topology(mesh), scheme};
  const Topology& topology = start.topology;
  if (!is_closed(topology, mesh.points))
    throw Error(ErrorCode::BadArgument, "the mesh to start from has holes; close them first");
  Points low(2, 3);
  low.row(0) = mesh.points.colwise().minCoeff();
  low.row(1) = mesh.points.colwise().maxCoeff();
  const Points middle = image.grid.to_indices(0.5 * (low.row(0) + low.row(1)));
  for (int c = 0; c < 3; ++c) {
    if (middle(0, c) < -0.5 || middle(0, c) > image.grid.size[c] - 0.5)
      throw Error(ErrorCode::BadArgument,
                  "the mesh to start from does not lie in the image; is it in the other world, RAS or LPS?");
  }
  start.components = connected_components(topology).count;
  start.genus = start.components - (topology.vertex_count() - topology.edge_count() + topology.face_count()) / 2;
  return start;
}

/// What is found on the way to the first surface.
struct Beginning {
  std::optional<SeedRegion> region;  ///< of a seed
  std::optional<Volume> filled;      ///< what points in slices enclose
  Index slices = 0;
  Points points = Points(0, 3);  ///< without those in gaps
};

/// What the edges of the image draw.
Segmentation first_surface(const Volume& image, const SegmentRequest& request, SegmentOptions options,
                           const Volume* mask, Beginning& beginning, const Progress& progress) {
  if (request.start) return started_from(*request.start, image, request.surface.scheme);
  if (request.points.rows() > 0) {
    const std::optional<PointSlices> slices = find_slices(request.points);
    if (!slices) {
      beginning.points = request.points(points_outside_gaps(request.points), Eigen::all);
      return segment_mask(points_mask(beginning.points), options, progress);
    }
    beginning.points = request.points;
    beginning.slices = static_cast<Index>(slices->levels.size());
    beginning.filled = slices_mask(request.points, *slices);
    return segment_mask(*beginning.filled, options, progress);
  }
  if (request.seed) {
    beginning.region = seed_region(image, *request.seed, request.seed_options, progress_within(progress, 0.0, 0.2));
    return segment_mask(beginning.region->mask, options, progress_within(progress, 0.2, 1.0));
  }
  if (!options.within) options.within = request.labels ? request.labels->grid : image.grid;
  return segment_mask(*mask, options, progress);
}

/// Is shown every surface once: one stage starts from what the stage before has shown.
FrameWatcher without_repeats(const FrameWatcher& watch) {
  if (!watch) return {};
  return [watch, last = std::make_shared<Points>(0, 3)](const SurfaceFrame& frame) {
    if (frame.control.rows() == last->rows() && frame.control == *last) return;
    *last = frame.control;
    watch(frame);
  };
}

/// What draws a surface to edges, where nothing is said: most starts lie near them already, and slices say more.
ImageFitOptions image_options(const SegmentRequest& request, const Beginning& beginning) {
  constexpr double kNearFairness = 0.05;
  constexpr int kNearRounds = 12;
  constexpr double kHeldFairness = 0.01;
  constexpr int kHeldRounds = 8;
  ImageFitOptions options = request.image.value_or(ImageFitOptions{});
  if (beginning.filled && options.held.points.rows() == 0) options.held = mask_border(*beginning.filled);
  if (!request.image && (request.seed || request.start || beginning.filled)) {
    options.fairness = beginning.filled ? kHeldFairness : kNearFairness;
    options.first_smoothing = 1.0;
    options.first_reach = 1.0;
    options.rounds = beginning.filled ? kHeldRounds : kNearRounds;
  }
  return options;
}

}  // namespace

void take_contours(SegmentRequest& request, Index every) {
  if (!request.labels)
    throw Error(ErrorCode::BadArgument, "contours in slices are those of labels, and there are none");
  MaskContours contours = mask_contours(label_mask(*request.labels, request.label), every);
  request.points = std::move(contours.points);
  if (!contours.painted) return;
  request.labels.reset();
  request.label.clear();
}

SegmentResult measured_segment(Segmentation surface, const Volume& image, const std::optional<Volume>& mask,
                               const Progress& progress) {
  constexpr double kAlpha = 2.0;  // of the smoothing before edges are measured, 1/mm
  if (!is_closed(surface.topology, surface.mesh.points))
    throw Error(ErrorCode::NotConverged,
                "the part is too thin for so few control points: its surface does not close; take more of them");
  SegmentResult result{std::move(surface), {}, 0, 0, {}, {}, {}};
  const Segmentation& found = result.surface;
  result.measures = measure_surface(found.topology, found.scheme, found.mesh, progress_within(progress, 0.0, 0.5));
  report_progress(progress, 0.5);
  if (mask) result.agreement = compare_with_mask(result.measures.fine, *mask);
  report_progress(progress, 0.7);
  result.edges = edge_strength(result.measures.fine, image, kAlpha);
  report_progress(progress, 1.0);
  return result;
}

SegmentResult segment_volume(const Volume& image, const SegmentRequest& request, const Progress& progress) {
  constexpr double kFound = 0.9;  // of the time, before the surface is measured
  require_request(request);
  require_volume(image);
  SegmentOptions first = request.surface;
  first.watch = without_repeats(first.watch);
  const bool started = request.points.rows() > 0 || request.seed || request.start;
  const bool drawn = started || request.edges;
  std::optional<Volume> mask;
  if (!started || request.labels) mask = label_mask(request.labels ? *request.labels : image, request.label);
  Beginning beginning;
  Segmentation surface = first_surface(image, request, first, mask ? &*mask : nullptr, beginning,
                                       progress_within(progress, 0.0, drawn ? 0.5 * kFound : kFound));
  if (drawn) {
    ImageFitOptions options = image_options(request, beginning);
    if (!options.watch) options.watch = first.watch;
    surface = segment_image(surface, image, beginning.points, options, progress_within(progress, 0.5 * kFound, kFound));
  }
  SegmentResult result = measured_segment(std::move(surface), image, mask, progress_within(progress, kFound, 1.0));
  result.region = std::move(beginning.region);
  result.slices = beginning.slices;
  result.left_out = static_cast<Index>(request.points.rows() - beginning.points.rows());
  return result;
}

}  // namespace batten
