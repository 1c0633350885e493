/// \file How far vertices moved.
#pragma once
#include "batten/types.h"

namespace batten {

/// Distances in the mesh's unit.
struct Movement {
  double rms = 0.0;
  double most = 0.0;
  Index vertex = -1;  ///< the first of those that moved farthest
};

/// before, after: V-by-3. O(V), threaded.
Movement measure_movement(ConstValuesRef before, ConstValuesRef after);
/// The root mean square of the movement along the unit normals, V-by-3.
double measure_movement_along(ConstValuesRef normals, ConstValuesRef before, ConstValuesRef after);

}  // namespace batten
