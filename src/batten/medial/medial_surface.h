/// \file The smooth surface through the ends of a medial model's spokes, and how well it fits the atoms.
#pragma once
#include <vector>

#include "batten/interpolate/local_normals.h"
#include "batten/medial/medial_boundary.h"
#include "batten/mesh/vertex_measure.h"

namespace batten {

/// Thall's metrics at each spoke's end: how well the surface fits the atoms. NaN where one has no meaning.
struct MedialErrors {
  Scalars distances;  ///< V: from the spoke's end to the limit position of its vertex
  Scalars angles;     ///< V: between the spoke and the limit normal, in radians
  /// V: the shift |p - p'| / r of the atom, at both its ends, NaN at the crest. p' is the atom that fits the reached
  /// positions b and normals n: it minimises sum |p' + s r_k n_k - b_k|^2 over p' and the scale s, where r_k are the
  /// lengths of the two spokes and r their mean.
  Scalars shifts;
  VertexMeasure distance;
  VertexMeasure distance_share;  ///< the distance divided by the spoke's length
  VertexMeasure angle;
  VertexMeasure shift;
};

/// control: V'-by-3, control points of `topology`, whose first rows belong to the vertices of `boundary.mesh`.
/// Throws what LimitMatrix and limit_normals throw. Source: key Thall02, 2.4. O(V).
MedialErrors measure_medial_errors(const MedialBoundary& boundary, const Topology& topology, const Scheme& scheme,
                                   ConstValuesRef control);

/// The surface and what it was made from.
struct MedialSurface {
  MedialBoundary boundary;
  InterpolatedMesh surface;  ///< its attributes pass through those of the boundary: "medial", "radius"
  MedialErrors errors;
};

/// How spokes' ends are interpolated if nothing else is said: to 1e-12 of the model's size, which costs little here.
inline InterpolateOptions medial_interpolation() {
  InterpolateOptions options;
  options.tolerance = 1e-12;
  return options;
}

/// The Catmull-Clark surface that passes through every spoke's end, one closed component for each figure or for figures
/// that hinges join.
/// Throws what medial_boundary and interpolate() throw. A model of 500 atoms takes some milliseconds.
MedialSurface medial_surface(const MedialModel& model, const InterpolateOptions& options = medial_interpolation(),
                             const Progress& progress = {});

/// Turns the surface's normals to the directions of the spokes, and measures the errors again. Returns what was turned
/// and how far off normals were. Throws what turn_normals() throws.
TurnReport turn_to_spokes(MedialSurface& made, const TurnOptions& options = {}, const Progress& progress = {});

}  // namespace batten
