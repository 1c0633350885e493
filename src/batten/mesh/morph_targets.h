/// \file A mesh that changes its shape, as animation formats hold it.
#pragma once
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// At a time, the points are those of the mesh and the sum of weight times displacement over the targets; normals
/// likewise, to be brought to unit length. Weights run linearly between the times.
struct MorphTargets {
  std::vector<Points> displacements;  ///< V-by-3 each
  /// As many, or none: changes of the mesh's normals, one row of three a vertex or one a corner (an entry of
  /// face_vertices).
  std::vector<Values> normals;
  std::vector<double> times;  ///< seconds, rising from 0 or more
  Values weights;             ///< a row a time, a column a target
};

}  // namespace batten
