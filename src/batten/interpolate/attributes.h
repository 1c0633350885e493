/// \file What becomes of the values at a mesh's vertices when its surface is made.
#pragma once
#include <vector>

#include "batten/interpolate/interpolator.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// How values at the vertices become values everywhere.
enum class AttributeRule {
  Midpoint,     ///< linearly: exact at the vertices, within the range of the face's corners, continuous (Thall, 2.6)
  Scheme,       ///< by the scheme's masks: smooth, within the range of its neighbours, not exact
  Interpolated  ///< by the scheme's masks from control values that are solved for: smooth and exact at the vertices
};

/// How to prepare_attributes().
struct AttributeOptions {
  AttributeRule rule = AttributeRule::Scheme;
  /// For AttributeRule::Interpolated. OnSingular::Alpha acts as LeastSquares does, since the mesh is not refined.
  InterpolateOptions solve;
};

/// A mesh whose values at the vertices are ready to be refined, and what was achieved.
struct PreparedAttributes {
  Mesh mesh;
  std::vector<InterpolationReport> reports;  ///< one for each attribute that was solved for, in their order
};

/// Makes refine_mesh(), surface_mesh() and adaptive_surface_mesh() carry all values at the vertices of a control mesh
/// so: sets Attribute::carry, and under AttributeRule::Interpolated replaces the values by control values whose limits
/// they are. Points and values at corners stay as they are, normals too. O(V k), or the cost of Interpolator. Throws
/// what Interpolator does, and names the attribute.
PreparedAttributes prepare_attributes(const Topology& topology, const Scheme& scheme, Mesh mesh,
                                      const AttributeOptions& options, const Progress& progress = {});

}  // namespace batten
