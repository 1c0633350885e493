/// \file Sharp edges of a shape, found by the angle between faces: noise is smoothed along them and not across.
#pragma once
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// What counts as a sharp edge.
struct FeatureOptions {
  double degrees = 40.0;   ///< between the normals of its two faces, in (0, 180)
  int least_edges = 5;     ///< of a connected set of sharp edges; smaller ones are noise
  int normal_passes = 10;  ///< over the normals before they are compared
};

/// The sharp edges, as infinitely sharp creases; what is a crease or a boundary already is not among them. Normals are
/// smoothed first, each face's with its neighbours' whose normals are like its own (bilateral filtering as by Zheng and
/// others 2011, key ZFAT11), so that noise makes no edges and edges stay. O(H) a pass.
/// points: V-by-3. Throws Error(BadShape, BadArgument, Cancelled).
std::vector<Crease> find_features(const Topology& topology, ConstValuesRef points, const FeatureOptions& options = {},
                                  const Progress& progress = {});

}  // namespace batten
