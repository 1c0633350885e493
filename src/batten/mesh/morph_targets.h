/// \file A mesh that changes its shape, as animation formats store it.
#pragma once
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// At each time the points are those of the mesh plus the sum of weight times displacement over the targets. Normals
/// change in the same way and are then normalised. Weights are linear between the times.
struct MorphTargets {
  std::vector<Points> displacements;  ///< V-by-3 each
  /// Empty, or one for each target: changes of the mesh's normals, one row of three for each vertex or for each corner
  /// (an entry of face_vertices).
  std::vector<Values> normals;
  std::vector<double> times;  ///< seconds, increasing, 0 or more
  Values weights;             ///< one row for each time, one column for each target
};

}  // namespace batten
