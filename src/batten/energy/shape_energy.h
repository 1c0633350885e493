/// \file How far a surface is from fair: quadratic energies of its control points, in the lengths of a reference
/// surface.
///
/// The energies of SurfaceEnergy measure by the parameters of the faces, so that a small face counts as much as a large
/// one. Those of ShapeEnergyKind measure by lengths along a surface, which makes them nearly those of the shape:
/// exactly where the surface is its own reference. For a fixed reference they are quadratic,
///
///     E(P) = sum over columns of p^T K p
///
/// with a sparse, symmetric, positive semidefinite matrix K, without energy of constants (after Halstead, Kass and
/// DeRose 1993, key HKD93, and Greiner 1994, key G94).
///
/// The integrals are sums over Gauss points. Bending and Variation of most surfaces do not exist next to extraordinary
/// vertices, where curvature has no limit; there faces are halved so often towards the vertex and no farther.
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <span>

#include "batten/buffer.h"
#include "batten/energy/shape_energy_kind.h"
#include "batten/patch/surface_patches.h"
#include "batten/progress.h"
#include "batten/surface/quadrature.h"

namespace batten {

class FaceElements;

/// Three points a side, and one halving: spheres come out no rounder with more (docs/decisions/011-fair-solver.md).
inline constexpr QuadratureOptions kShapeQuadrature{3, 1};

/// Built for a connectivity. Const and safe from several threads; no result depends on their number. Control points are
/// those of patches.base(), N of them, here: with N-by-3 for a reference.
class ShapeEnergy {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// O(faces). Throws Error(BadArgument) for the Butterflies and options out of range, Error(TooLarge) as
  /// SurfaceEnergy.
  ShapeEnergy(const SurfacePatches& patches, ShapeEnergyKind kind, const QuadratureOptions& options = kShapeQuadrature,
              const Progress& progress = {});
  ~ShapeEnergy();
  ShapeEnergy(ShapeEnergy&&) noexcept;

  const SurfacePatches& patches() const;
  ShapeEnergyKind kind() const;

  /// K, N-by-N: both triangles, columns ascending, symmetric to the last bit. Places where the reference has no tangent
  /// plane are left out. Two to three microseconds a regular face; next to irregular vertices some ten times as long.
  /// Throws Error(BadShape, NotFinite, Cancelled).
  Matrix matrix(ConstValuesRef reference, const Progress& progress = {}) const;
  /// The same with a factor for each face of the control mesh, or one for all.
  Matrix matrix(ConstValuesRef reference, std::span<const double> face_factors, const Progress& progress = {}) const;

  /// E of a surface in its own lengths, in (unit of the points)^(2 - 2 order), order 0 to 2 for Stretch to Variation:
  /// p^T matrix(P) p without the matrix. Throws Error(BadShape, NotFinite).
  double energy(ConstValuesRef control) const;

  /// For use inside the library: the faces as elements over the vertices of the base (energy/face_elements.h).
  const FaceElements& elements() const;
  /// Likewise: K_e P of each element e, with the reference P itself: three numbers for each of its vertices, element by
  /// element. Throws as matrix() does.
  Buffer<double> element_gradients(const Points& reference, std::span<const double> face_factors) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace batten
