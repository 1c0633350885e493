/// \file From a label of a volume to a small, smooth control mesh.
#pragma once
#include <optional>

#include "batten/fit/point_cloud.h"
#include "batten/fit/surface_film.h"
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"
#include "batten/volume/volume.h"

namespace batten {

/// Options of segment_mask().
struct SegmentOptions {
  Scheme scheme;               ///< Catmull-Clark or Loop
  Index vertices = 386;        ///< about so many control points; 8 to 1,000,000
  std::optional<Index> genus;  ///< demanded; without, the one that most grids give
  /// How far the surface may stay away from the steps between voxels to be smooth: RMS, in voxels.
  double smoothing = 0.15;
  std::optional<VolumeGrid> within;  ///< the surface does not leave these voxels
  FrameWatcher watch;                ///< is shown the start and the surface after each step
};

/// A closed surface in the world, and how it was found.
struct Segmentation {
  Mesh mesh;  ///< with its scheme stated; millimetres, RAS
  Topology topology;
  Scheme scheme;
  Index genus = 0;          ///< of all components together
  Index components = 0;     ///< of the surface
  Index dropped_parts = 0;  ///< specks too small to follow
  int rounds = 0;           ///< steps that moved the surface
  int cut_steps = 0;        ///< steps taken back, because the surface would have met itself
  double fairness = 0.0;    ///< of the last step (FitStep)
  double border_rms = 0.0;  ///< of the distances from the middles of the voxels' outer faces, mm
};

/// The surface around the voxels of a mask (label_mask()). A first mesh of about the final number of control points
/// over mask_border() (fit/first_mesh.h) is drawn to it (fit/surface_fitter.h) while fairness falls, until the
/// distances are as small as the smoothing asks, or half the fairness no longer makes them smaller by 4 %. A step after
/// which triangles of the surface meet is taken back, and the next one is less fair; after four such the rounds end.
/// A part of one voxel's thickness (1.5 outer faces a voxel or more) has several points a face.
/// Thousands of voxels take a second. Throws Error: what first_mesh() throws; BadArgument.
Segmentation segment_mask(const Volume& mask, const SegmentOptions& options = {}, const Progress& progress = {});

/// Options of segment_image().
struct ImageFitOptions {
  double smoothing = 1.0;        ///< the width of the image's smoothing in the end, voxels
  double first_smoothing = 3.0;  ///< so many times as much at first
  double reach = 3.0;            ///< how far edges are searched along the normal in the end, voxels
  double first_reach = 2.0;      ///< so many times as far at first
  double point_weight = 300.0;   ///< of all points together beside all edges together
  double fairness = 0.1;         ///< in the end (FitStep)
  int rounds = 24;
  /// Moves the surface off the edges to where its own image, blurred, is most like the one that is there
  /// (volume/image_model.h); not with points.
  bool leave_blur = true;
  PointCloud held;             ///< with normals, holds the surface between the points: mask_border() of slices_mask()
  double held_weight = 100.0;  ///< of all of it together beside all edges together
  FrameWatcher watch;          ///< is shown the start and the surface after each step
};

/// Draws a surface to the edges of an image and to points. In each round every place of a grid on the surface looks
/// along its normal for the strongest edge (volume/edge_search.h); edges and points draw the surface as
/// fit/surface_fitter.h does, and steps are taken back as segment_mask() does; the smoothing of the image, the reach
/// and the fairness fall from round to round. Without points, the places go in 20 more rounds where a model of the
/// blurred image, whose blur is learnt, asks for; fairness then grows with the noise. The points stay more exact the
/// larger their weight. points: N-by-3, in the world, or without rows. Throws Error: BadArgument, BadShape, NotFinite,
/// Cancelled.
Segmentation segment_image(const Segmentation& start, const Volume& image, const Points& points,
                           const ImageFitOptions& options = {}, const Progress& progress = {});

}  // namespace batten
