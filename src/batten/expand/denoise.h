/// \file Removes noise from a mesh and keeps its shape.
#pragma once
#include "batten/expand/features.h"
#include "batten/expand/noise.h"

namespace batten {

/// Options of denoise.
struct DenoiseOptions {
  SeriesMatrix matrix = SeriesMatrix::Limit;
  int m = 2;               ///< a pass keeps the terms 0 to m; a larger m keeps more detail
  int passes = 4;          ///< see passes_for (expand/strength.h)
  bool automatic = false;  ///< choose m and passes by the measured noise
  bool keep_boundary = false;
  bool keep_volume = false;  ///< keep the volume of each closed component without kept vertices
  bool features = false;     ///< find sharp edges besides the tagged ones
  FeatureOptions feature_options;
};

/// The result of denoise.
struct DenoiseResult {
  Points points;              ///< V-by-3
  NoiseEstimate noise;        ///< of the input
  SmoothingChoice smoothing;  ///< the parameters used, whether chosen or given
  double removed = 0.0;       ///< root mean square of the vertices' movement along their normals
  double moved = 0.0;         ///< root mean square of the vertices' movement
  double most_moved = 0.0;
  Index most_moved_vertex = -1;
  std::vector<Crease> features;  ///< the sharp edges that were found
  Index features_left_out = 0;   ///< found, but not used: options.automatic expects no clearly smaller error with them
  Index closed_components = 0;
  Index scaled_components = 0;  ///< components whose volume was kept
  double volume_before = 0.0;   ///< of all closed components together, in cubes of the unit
  double volume_after = 0.0;
};

/// Applies Lai and Cheng's smoothing (8) to the points of a mesh. Creases, given or found, and boundaries are smoothed
/// along themselves; corners, and vertices where three creases or boundaries meet, keep their position, but those where
/// found edges meet go where the smoothed sides around them do. Cotangents are
/// those of the mesh after eight passes of the limit matrix with m = 2, because cotangents of the noisy mesh would be
/// noisy. O(H) for each pass. Throws Error: NotTriangles, NotFinite, BadArgument (m, passes, an angle), Cancelled, and
/// what Topology throws.
DenoiseResult denoise(const Mesh& mesh, const Scheme& scheme, const DenoiseOptions& options = {},
                      const Progress& progress = {});

/// The same where the topology is there already. points: V-by-3. Throws Error(BadShape) too.
DenoiseResult denoise(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                      const DenoiseOptions& options = {}, const Progress& progress = {});

}  // namespace batten
