/// \file One step of uniform refinement, and several in a row.
#pragma once
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// One refinement step: the child connectivity, built in closed form, and the map from control values to refined ones.
///
/// Vertex order of the child: vertex i of the parent, then one vertex an edge (V + e), then, for Catmull-Clark, one a
/// face (V + E + f). Catmull-Clark makes of each half-edge h of the parent the quad h: (origin(h), edge(h), face,
/// edge(previous(h))). The others make of each triangle f the triangles 4f..4f+2 at its corners and 4f+3 in the middle.
/// Rules: OpenSubdiv 3.5's, to rounding; the Butterflies' stand in refine/butterfly_rules.h. Cost O(H) time and memory.
class Refinement {
 public:
  /// vertex_alpha: empty, or Lai's alpha for each vertex instead of scheme.alpha.
  /// Throws Error(NotTriangles) for other schemes than Catmull-Clark on other faces, Error(BadArgument) for alpha out
  /// of [0, 1] or a tension that is not finite, Error(TooLarge), Error(Cancelled).
  Refinement(const Topology& topology, const Scheme& scheme, std::vector<double> vertex_alpha = {},
             const Progress& progress = {});

  const Topology& child() const { return child_; }
  const Scheme& scheme() const { return scheme_; }

  /// values: V-by-k, row i for vertex i. Returns V'-by-k. Throws Error(BadShape), Error(NotFinite) naming the row,
  /// Error(Cancelled).
  Values apply(ConstValuesRef values, const Progress& progress = {}) const;

  /// The same, written into `result`, V'-by-k: nothing is allocated where its rows follow each other in memory.
  void apply_into(ConstValuesRef values, ValuesRef result, const Progress& progress = {}) const;

 private:
  Topology topology_;
  Scheme scheme_;
  std::vector<double> vertex_alpha_;
  Topology child_;
};

/// A finer control mesh: its connectivity and its control points.
struct RefinedSurface {
  Topology topology;
  Values values;
};

/// `levels` steps; alpha acts in the first. Throws what Refinement throws, and Error(BadArgument) for negative levels.
RefinedSurface refine(const Topology& topology, const Scheme& scheme, ConstValuesRef values, int levels,
                      const Progress& progress = {});

/// The scheme that a mesh asks for: its own word, else Loop for triangles and Catmull-Clark for anything else.
Scheme choose_scheme(const Mesh& mesh);

/// The other way: what the surface depends on is said in the mesh, so that who reads it makes the same surface of it.
void state_scheme(const Scheme& scheme, Mesh& mesh);

/// Faces that are no part of the surface: tagged holes and, under BoundaryRule::None, the faces at boundary vertices
/// whose boundary edges are not all tagged sharp. One flag a face, or empty for none.
/// Ask on the control mesh: children inherit holes, and a child's own boundary faces are part of the surface.
Buffer<std::uint8_t> surface_holes(const Topology& topology, const Scheme& scheme);

/// The same connectivity with surface_holes() tagged as holes.
Topology with_surface_holes(const Topology& topology, const Scheme& scheme);

}  // namespace batten
