/// \file The control mesh of a fair surface, with all that hangs on the mesh given.
#pragma once
#include "batten/interpolate/fair_interpolation.h"
#include "batten/interpolate/interpolated_mesh.h"

namespace batten {

/// The control mesh and what was achieved.
struct FairMesh {
  Mesh mesh;     ///< refined; the scheme of its surface is stated in it
  Values plain;  ///< control points of the surface that Interpolator gives, on the same connectivity
  Topology topology;
  Scheme scheme;
  FairReport report;
  std::vector<InterpolationReport> attributes;  ///< of those at vertices that were solved for, in their order
};

/// Points as interpolate_fairly() places them; the rest of the mesh is interpolated as without it (under `rule`,
/// interpolate/interpolated_mesh.h) and refined as often. Throws what either does.
FairMesh interpolate_fairly(const Topology& topology, const Scheme& scheme, Mesh mesh, AttributeRule rule,
                            const FairOptions& options = {}, const Progress& progress = {});

}  // namespace batten
