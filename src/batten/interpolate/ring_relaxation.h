/// \file Control points moved so that a surface's displacement bends least, while the limits at some vertices stay. For
/// local_normals.cpp.
#pragma once
#include "batten/buffer.h"
#include "batten/energy/surface_energy.h"
#include "batten/limit/vertex_frames.h"

namespace batten {

/// What must not change: the limit positions and tangents of the first `count` vertices, whose one-rings are disjoint.
/// Where a vertex has not one tangent plane, its whole ring stays.
class HeldLimits {
 public:
  /// Some 300 bytes a vertex. O(count).
  HeldLimits(const VertexFrames& frames, Index count);

  /// Takes from a displacement what would change them: in each ring, the orthogonal projection onto the vectors on
  /// which its masks vanish. O(count).
  void project(Values& displacement) const;

 private:
  struct Ring {
    std::vector<Index> vertices;
    Points masks = Points(0, 3);  ///< orthonormal columns; no rows where the whole ring stays
  };
  std::vector<Ring> rings_;
};

/// Changes a displacement, V-by-3, to the one of least thin-plate energy among those that differ from it by what `held`
/// leaves: P K (d + P z) = 0 for the projection P, by conjugate gradients until the largest row of the left-hand side
/// has shrunk by 1e4. Returns the iterations, about ten. thin_plate: K. O(entries) each. Throws Error(Cancelled).
int relax_displacement(const SurfaceEnergy::Matrix& thin_plate, const HeldLimits& held, Values& displacement,
                       const Progress& progress);

/// 1/2 of the sum over the columns of p^T K p. values: V-by-3. O(entries).
double quadratic_form(const SurfaceEnergy::Matrix& matrix, const Values& values);

}  // namespace batten
