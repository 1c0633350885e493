/// \file How far vertices were moved.
#pragma once
#include "batten/types.h"

namespace batten {

/// In the mesh's unit.
struct Movement {
  double rms = 0.0;
  double most = 0.0;
  Index vertex = -1;  ///< the first one that was moved farthest
};

/// before, after: V-by-3. O(V), threaded.
Movement measure_movement(ConstValuesRef before, ConstValuesRef after);
/// The root mean square of what was moved along the unit normals, V-by-3.
double measure_movement_along(ConstValuesRef normals, ConstValuesRef before, ConstValuesRef after);

}  // namespace batten
