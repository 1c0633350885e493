/// \file Noise taken from a mesh, its shape left.
#pragma once
#include "batten/expand/features.h"
#include "batten/expand/noise.h"

namespace batten {

/// How to smooth.
struct DenoiseOptions {
  SeriesMatrix matrix = SeriesMatrix::Limit;
  int m = 2;               ///< terms kept in a pass, less one: the larger, the more detail stays
  int passes = 4;          ///< see passes_for (expand/strength.h)
  bool automatic = false;  ///< choose m and passes by the noise that is found
  bool keep_boundary = false;
  bool keep_volume = false;  ///< of each closed component in which nothing is kept
  bool features = false;     ///< find sharp edges, beside those that are tagged
  FeatureOptions feature_options;
};

/// The mesh and what was done.
struct DenoiseResult {
  Points points;              ///< V-by-3
  NoiseEstimate noise;        ///< in what was given
  SmoothingChoice smoothing;  ///< what was chosen, or m and passes as they were asked for
  double removed = 0.0;       ///< root mean square of the vertices' movement along their normals
  double moved = 0.0;         ///< root mean square of the vertices' movement
  double most_moved = 0.0;
  Index most_moved_vertex = -1;
  std::vector<Crease> features;  ///< the sharp edges that were found
  Index closed_components = 0;
  Index scaled_components = 0;  ///< whose volume was kept
  double volume_before = 0.0;   ///< of the closed components together, in cubes of the unit
  double volume_after = 0.0;
};

/// Lai and Cheng's smoothing (8) of the points of a mesh. Creases, given or found, and boundaries are smoothed along
/// themselves; corners, and vertices where three of them meet, stay. Cotangents are those of the mesh after eight
/// passes of the limit matrix with m = 2, since those of noise would be noise. O(H) a pass. Throws Error: NotTriangles,
/// NotFinite, BadArgument (m, passes, an angle), Cancelled, and what Topology throws.
DenoiseResult denoise(const Mesh& mesh, const Scheme& scheme, const DenoiseOptions& options = {},
                      const Progress& progress = {});

}  // namespace batten
