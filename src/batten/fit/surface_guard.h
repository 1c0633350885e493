/// \file Where a surface folds over or passes through itself.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/mesh/topology.h"
#include "batten/tessellate/tessellator.h"

namespace batten {

/// What a surface must be.
enum class Soundness {
  Unfolded,  ///< it does not fold over
  Whole      ///< nor does it pass through itself
};

/// How fine SurfaceGuard looks: 2^levels steps a side of a face.
inline constexpr int kGuardLevels = 2;
/// At sharp edges what passes through itself may be small: a surface that is kept for good is looked at like this.
inline constexpr int kFineGuardLevels = 3;

/// Looks at a tessellation. Built for a connectivity; asking is const.
class SurfaceGuard {
 public:
  explicit SurfaceGuard(const SurfacePatches& patches, int levels = kGuardLevels);

  /// One flag a face of the control mesh: between facets side by side in it the normal turns by more than 107
  /// degrees, or, unless only folds are asked for, it passes through another face. control: V-by-3. Where faces fold
  /// that `known` does not flag, those that pass through others are not looked for. O(faces log faces).
  Buffer<std::uint8_t> unsound(ConstValuesRef control, Soundness asked, const Buffer<std::uint8_t>& known = {}) const;

 private:
  Buffer<std::uint8_t> folded(const Points& points) const;

  Tessellator tessellator_;
  Topology facets_;
  Buffer<Index> faces_;  ///< of the control mesh, a facet each
  Index control_faces_;
};

}  // namespace batten
