/// \file From an image to the surface of a part of it, whatever there is to start from.
#pragma once
#include <optional>
#include <vector>

#include "batten/volume/seed_region.h"
#include "batten/volume/segment.h"
#include "batten/volume/segment_measures.h"

namespace batten {

/// What a surface starts from, and what it is drawn to.
struct SegmentRequest {
  SegmentOptions surface;  ///< its watch is shown all surfaces, also those that are drawn to edges
  /// The volume of labels, on a grid of its own; without, the image itself is one. Where the surface starts from
  /// something else, labels are only compared with.
  std::optional<Volume> labels;
  std::vector<double> label;  ///< one, or several as one; empty: all numbers but 0
  /// On the part's border, in the world: start (slices_mask() where they lie in slices, else points_mask()) and
  /// targets.
  Points points = Points(0, 3);
  std::optional<Eigen::Vector3d> seed;  ///< in the part, in the world: the start is seed_region()
  SeedOptions seed_options;
  std::optional<Mesh> start;  ///< a closed control mesh, in the world
  bool edges = false;         ///< draws the surface of labels to the image's edges, too
  /// How the surface is drawn to edges; without, the defaults, but from a seed or a mesh with half the fairness and
  /// without coarse rounds: they lie near the edges already.
  std::optional<ImageFitOptions> image;
};

/// Points become the border of the labels in every n-th slice (mask_contours()), as if only these slices had been
/// drawn. Labels that are painted in these slices only are not compared with: they say nothing of the others. Throws
/// Error(BadArgument) without labels, and where mask_contours() does.
void take_contours(SegmentRequest& request, Index every);

/// A surface, how it was found, and how it sits.
struct SegmentResult {
  Segmentation surface;
  std::optional<SeedRegion> region;  ///< of a seed
  Index slices = 0;                  ///< that the points lie in (find_slices()); 0 where they lie in none
  Index left_out = 0;                ///< points in gaps, to which the surface is not drawn (points_outside_gaps())
  SurfaceMeasures measures;
  std::optional<MaskAgreement> agreement;  ///< with labels
  EdgeStrength edges;
};

/// Labels, points, a seed or a mesh: at most one of the last three is given. Labels alone give segment_mask(); all else
/// is drawn to the image's edges by segment_image(). Throws Error(BadArgument) for two starts, a label beside a
/// start without labels, a start that is not closed or not in the image, Error(NotConverged) where the first surface
/// does not close, and what the functions named here throw; Cancelled.
SegmentResult segment_volume(const Volume& image, const SegmentRequest& request, const Progress& progress = {});

/// A surface that was found, and how it sits in the image and to a mask (label_mask()). Throws Error(NotConverged)
/// where it does not close; Cancelled.
SegmentResult measured_segment(Segmentation surface, const Volume& image, const std::optional<Volume>& mask,
                               const Progress& progress = {});

}  // namespace batten
