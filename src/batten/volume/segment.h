/// \file From a label of a volume to a small, smooth control mesh.
#pragma once
#include <optional>

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
  double border_rms = 0.0;  ///< of the distances from the middles of the voxels' outer faces, mm
};

/// The surface around the voxels of a mask (label_mask()). A first mesh of about the final number of control points
/// over mask_border() (fit/first_mesh.h) is drawn to it (fit/surface_fitter.h) while fairness falls, until the
/// distances are as small as the smoothing asks, or half the fairness no longer makes them smaller by 4 %. A step after
/// which triangles of the surface meet is taken back, and the next one is less fair; after four such the rounds end.
/// Thousands of voxels take a second. Throws Error: what first_mesh() throws; BadArgument.
Segmentation segment_mask(const Volume& mask, const SegmentOptions& options = {}, const Progress& progress = {});

}  // namespace batten
