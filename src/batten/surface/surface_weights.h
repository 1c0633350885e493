/// \file Places of the limit surface as rows of weights of the control points, for fitting.
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <span>

#include "batten/progress.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// What of a Jet a row gives.
enum class JetPart { Point, Du, Dv, Duu, Duv, Dvv };

/// Built for a connectivity, O(H): under a microsecond a face. A row takes about one microsecond, three where the base
/// is a first refinement.
class SurfaceWeights {
 public:
  /// Throws Error(NotTriangles).
  SurfaceWeights(const Topology& topology, const Scheme& scheme);
  ~SurfaceWeights();
  SurfaceWeights(SurfaceWeights&&) noexcept;

  /// That of LimitSurface: what places refer to.
  const Topology& base() const;

  /// The P-by-V matrix J: row i of J control is that part of LimitSurface's jet at places[i], for any control points.
  /// Rows of Point sum to 1, those of derivatives to 0. At an extraordinary vertex itself Du and Dv span the tangent
  /// plane, as the jet's do, though they may be others, and second derivatives have empty rows. Rounding: as the
  /// jet's; of second derivatives that divided by the distance to the nearest corner. Threaded, the same bits for any
  /// number of threads. Throws Error(IndexOutOfRange, BadArgument) for places that do not exist, Error(TooLarge),
  /// Error(Cancelled).
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(std::span<const SurfacePlace> places, JetPart part = JetPart::Point,
                                                    const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
