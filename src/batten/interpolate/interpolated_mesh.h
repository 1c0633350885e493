/// \file A mesh whose surface passes through a given mesh's vertices, with all that hangs on them.
#pragma once
#include <vector>

#include "batten/interpolate/attributes.h"
#include "batten/interpolate/interpolator.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// The control mesh and what was achieved.
struct InterpolatedMesh {
  Mesh mesh;                                 ///< the scheme of its surface is stated in it
  Topology topology;                         ///< of `mesh`
  Scheme scheme;                             ///< of its surface, without alpha
  std::vector<InterpolationReport> reports;  ///< of the points, then of each attribute at vertices, in their order
  /// Some components or all, once, because alpha acts in the first step only; vertices given keep their numbers.
  bool is_refined = false;

  bool converged() const;
};

/// The control mesh whose surface passes through the mesh's points and has its colours and other attributes there. What
/// else the mesh holds is kept, and where a component is refined, refined with it: creases, corners, holes, attributes
/// at corners (texture coordinates), groups, materials. Normals are dropped: control points have none.
/// mesh: of the interpolator's topology. Throws what Interpolator::solve does, and names the attribute.
InterpolatedMesh interpolate(const Interpolator& interpolator, Mesh mesh, const Progress& progress = {});

/// The same, but the attributes at the vertices follow `rule`. Only under AttributeRule::Interpolated are they solved
/// for and have reports. Otherwise they keep their values, as control values or, under Midpoint, as values of the
/// surface, and where a component is refined they are refined so.
InterpolatedMesh interpolate(const Interpolator& interpolator, Mesh mesh, AttributeRule rule,
                             const Progress& progress = {});

/// Once, by the scheme that the mesh asks for (choose_scheme()). Throws what Topology and Interpolator do.
InterpolatedMesh interpolate(const Mesh& mesh, const InterpolateOptions& options = {}, const Progress& progress = {});

}  // namespace batten
