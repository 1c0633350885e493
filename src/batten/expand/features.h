/// \file Finds the sharp edges of a shape by the angle between faces, so that noise is smoothed along them and not
/// across.
#pragma once
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// Meshes of fewer vertices do not tell noise from shape.
inline constexpr Index kFewestForNoise = 500;

/// What counts as a sharp edge.
struct FeatureOptions {
  double degrees = 40.0;   ///< the least angle between the normals of its two faces, in (0, 180)
  int least_edges = 5;     ///< of a connected set of sharp edges; smaller sets are noise. In strong noise twice as many
  int normal_passes = 10;  ///< smoothing passes over the normals before they are compared
};

/// The sharp edges as infinitely sharp creases, without those that already are creases or boundaries. Normals are
/// smoothed first: each face's with those of neighbours that are similar (bilateral filtering as in Zheng and others
/// 2011, key ZFAT11), which removes noise and keeps edges. Noise of more than 6 % of the mean edge (estimate_noise)
/// would mislead that: it is smoothed away from the points first, to a tenth of the mean edge, so that a normal is that
/// of a neighbourhood; and short ends of curves are taken away. Meshes of less than 500 vertices do not tell noise from
/// shape and are taken as they are. O(H) for each pass. points: V-by-3. Throws Error(BadShape, BadArgument, NotFinite,
/// Cancelled).
std::vector<Crease> find_features(const Topology& topology, ConstValuesRef points, const FeatureOptions& options = {},
                                  const Progress& progress = {});

}  // namespace batten
