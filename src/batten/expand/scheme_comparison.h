/// \file Butterfly, Modified Butterfly, the interpolated Loop and Catmull-Clark surfaces and the fairest Loop surface
/// of one triangle mesh, measured by one rule.
#pragma once
#include <string>
#include <vector>

#include "batten/mesh/discrete_curvature.h"
#include "batten/mesh/mesh.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// One surface through the vertices, as a fine mesh on it.
struct ComparedSurface {
  /// "Butterfly", "Modified Butterfly", "interpolated Loop", "fair Loop", "interpolated Catmull-Clark"
  std::string name;
  Scheme scheme;
  std::string failure;  ///< why there is no surface, or empty
  std::string method;   ///< how it was interpolated; empty where there was nothing to solve
  int iterations = 0;
  double max_error = 0.0;  ///< in the mesh's unit
  Mesh mesh;               ///< refined `levels` times, at the limit, with the tags
  Scalars mean;            ///< discrete_curvature() at its vertices, 1/unit
  Fairness fairness;       ///< its area is infinite where doubles cannot hold it
};

/// All five, refined `levels` times. points: V-by-3, finite, the vertices of a mesh of triangles; scheme: the rules to
/// follow, its kind does not matter. What a surface's operators throw is its `failure`, but Error(Cancelled). Measured
/// at a scale where squares of coordinates are ordinary numbers (mesh/unit_scale.h).
/// Throws Error(NotTriangles, BadShape, Cancelled).
std::vector<ComparedSurface> compare_schemes(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                                             int levels, const Progress& progress = {});

}  // namespace batten
