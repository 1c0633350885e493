/// \file Energies of the limit surface as matrices over the control points.
///
/// Every energy of EnergyKind is a quadratic form of the control points P: E(P) = 1/2 sum over columns of p^T K p, with
/// a sparse, symmetric, positive semidefinite V-by-V matrix K, whose gradient is K P. Parameters are those of the faces
/// of SurfacePatches::base(), so that surface_quadrature() and the jets of LimitSurface give the same integrals.
///
/// Regular faces have closed forms; next to irregular vertices the sums over all levels are taken to rounding, once for
/// all faces with the same surroundings (after Qin, Mandal and Vemuri 1998, key QMV98). Their thin-plate integral does
/// not exist at smooth interior vertices of valence 5 and more (Loop: 7 and more), nor at most irregular boundary
/// vertices; there, other than in the paper, the tangent plane's part of the points has no energy, and the finer levels
/// count as in the parameters of the characteristic map (energy/level_sums.h).
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <vector>

#include "batten/buffer.h"
#include "batten/energy/energy_kind.h"
#include "batten/patch/surface_patches.h"
#include "batten/progress.h"

namespace batten {

class FaceElements;

/// Coefficients are finite and not negative: one for all faces, or one a face of the control mesh.
struct EnergyOptions {
  std::vector<double> density{1.0};   ///< of Mass
  std::vector<double> tension{1.0};   ///< of Membrane
  std::vector<double> rigidity{1.0};  ///< of ThinPlate
  /// The paper's thin plate instead: so many levels around irregular vertices count as the integrals that they are, and
  /// finer ones have no energy. Its stiffness grows with the number without end. 1 to 24.
  std::optional<int> cutoff_levels = {};
};

/// Built for a connectivity. Const and safe from several threads; no result depends on their number. Build O(H), and
/// O(n^3) for each kind of surroundings of a vertex of valence n. Memory: some 200 bytes a face, O(n^2) next to a
/// vertex of valence n.
class SurfaceEnergy {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Throws Error(BadArgument) for the Butterflies and options out of range, Error(NotFinite), Error(BadShape),
  /// Error(TooLarge) where a face depends on more than 512 points: beside a vertex of about 250 faces under
  /// Catmull-Clark, 500 under Loop.
  explicit SurfaceEnergy(const SurfacePatches& patches, const EnergyOptions& options = {});
  /// Throws also Error(NotTriangles), Error(TooLarge), Error(Cancelled).
  SurfaceEnergy(const Topology& topology, const Scheme& scheme, const EnergyOptions& options = {},
                const Progress& progress = {});
  ~SurfaceEnergy();
  SurfaceEnergy(SurfaceEnergy&&) noexcept;

  const SurfacePatches& patches() const;

  /// K: both triangles, columns ascending, symmetric to the last bit; rows of vertices without a face are empty. Some
  /// 49 entries a row on quads, 37 on triangles; all kinds have their entries in the same places. About a microsecond a
  /// row, three where the base is a first refinement. Throws Error(TooLarge) for 2^31 entries and more,
  /// Error(Cancelled).
  Matrix matrix(EnergyKind kind, const Progress& progress = {}) const;

  /// result = K values, without the matrix. Both V-by-k; they must not share memory. Throws Error(BadShape, NotFinite).
  void apply(EnergyKind kind, ConstValuesRef values, ValuesRef result) const;

  /// E(P), summed over the columns. control: V-by-k. Throws Error(BadShape, NotFinite).
  double energy(EnergyKind kind, ConstValuesRef control) const;

  /// For use inside the library: the faces as elements over the vertices of the base (energy/face_elements.h).
  const FaceElements& elements() const;
  /// Likewise: K_e P of each element e, three numbers for each of its vertices, element by element. base_points: of the
  /// base, with three columns. Throws Error(BadShape, NotFinite).
  Buffer<double> element_gradients(EnergyKind kind, const Points& base_points) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace batten
