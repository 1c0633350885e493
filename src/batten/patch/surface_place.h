/// \file A place on a surface.
#pragma once
#include <Eigen/Core>

#include "batten/mesh/topology.h"

namespace batten {

/// A face of the base and (u, v) in it: u runs from its first corner to its second, v to a quad's fourth, to a
/// triangle's third.
struct SurfacePlace {
  Index face = 0;
  double u = 0.0;
  double v = 0.0;
};

/// The corner of a face where the surface has a vertex of the base that is not isolated: of its vertex_half_edge().
SurfacePlace place_of_vertex(const Topology& base, Index vertex);

/// The same place on the child of a Refinement of `base`, whose faces are all quads (refined by Catmull-Clark) or all
/// triangles. On lines between children any of them. Exact but for rounding.
SurfacePlace refined_place(const Topology& base, const SurfacePlace& place);

/// How the parameters of refined_place() change with those of `place`: column 0 with u, column 1 with v. The same all
/// over a child.
Eigen::Matrix2d refined_parameters(const Topology& base, const SurfacePlace& place);

/// The other way: a place of that child on `base`. Exact but for rounding.
SurfacePlace coarser_place(const Topology& base, const SurfacePlace& place);

}  // namespace batten
