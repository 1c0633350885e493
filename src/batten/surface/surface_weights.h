/// \file Places of the limit surface as rows of weights of the control points, for fitting and energies.
#pragma once
#include <Eigen/SparseCore>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "batten/progress.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// What of a Jet a row gives.
enum class JetPart { Point, Du, Dv, Duu, Duv, Dvv };
/// All of them, in that order.
inline constexpr std::array<JetPart, 6> kAllJetParts{JetPart::Point, JetPart::Du,  JetPart::Dv,
                                                     JetPart::Duu,   JetPart::Duv, JetPart::Dvv};

/// Built for a connectivity, O(H): under a microsecond a face. A row takes about one microsecond, three where the base
/// is a first refinement; all six of a place some three times as long. Next to a vertex of valence n a row has O(n)
/// weights.
class SurfaceWeights {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Throws Error(BadArgument) for the Butterflies, Error(TooLarge) as SurfacePatches::pieces() does.
  explicit SurfaceWeights(const SurfacePatches& patches);
  /// Throws also Error(NotTriangles).
  SurfaceWeights(const Topology& topology, const Scheme& scheme, const Progress& progress = {});
  ~SurfaceWeights();
  SurfaceWeights(SurfaceWeights&&) noexcept;

  const SurfacePatches& patches() const;
  /// That of LimitSurface: what places refer to.
  const Topology& base() const { return patches().base(); }

  /// The P-by-V matrix J: row i of J control is that part of LimitSurface's jet at places[i], for any control points.
  /// Rows of Point sum to 1, those of derivatives to 0. At an extraordinary vertex itself Du and Dv span the tangent
  /// plane, as the jet's do, though they may be others, and second derivatives have empty rows. Rounding: as the
  /// jet's; of second derivatives that divided by the distance to the nearest corner. Threaded, the same bits for any
  /// number of threads. Throws Error(IndexOutOfRange, BadArgument) for places that do not exist, Error(TooLarge),
  /// Error(Cancelled).
  Matrix rows(std::span<const SurfacePlace> places, JetPart part = JetPart::Point, const Progress& progress = {}) const;

  /// Several parts at once, a matrix each, the same as one by one in less time.
  std::vector<Matrix> rows(std::span<const SurfacePlace> places, std::span<const JetPart> parts,
                           const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
