/// \file Polynomials of E - A, applied again and again in tiles that stay in the cache.
///
/// A pass takes x to c_0 x + c_1 G x + .. + c_d G^d x, G = E - A: smoothing, sharpening and the split into bands are
/// such passes (key LC06). As in TiledIteration a tile of a few thousand unknowns takes its surroundings along and runs
/// several applications of A in the core's own cache; here all in double, since the values themselves are carried.
#pragma once
#include <memory>
#include <vector>

#include "batten/solve/remainder_rows.h"
#include "batten/solve/tiled_iteration.h"

namespace batten {

/// Build: O(nonzeros). Safe to share between threads.
class TiledPolynomial {
 public:
  /// All rows must be free. Memory, on regular quads: 77 bytes an unknown while it is built, of which 31 stay. Throws
  /// Error(Cancelled).
  explicit TiledPolynomial(const RowSource& rows, const Progress& progress = {});
  /// G with weights of its own in every row. Build: O(nonzeros). Memory beside the rows, on regular quads: 175 bytes an
  /// unknown while it is built, of which 130 stay; the rows are not needed any more. Throws Error(Cancelled).
  explicit TiledPolynomial(const RemainderRows& rows, const Progress& progress = {});
  ~TiledPolynomial();
  TiledPolynomial(TiledPolynomial&&) noexcept;

  /// False where rows are too wide for tiles; then apply throws.
  bool fits() const;

  /// Unknowns held by all tiles, the surroundings included, over unknowns: what the tiling costs.
  double overlap() const;

  /// result = (sum_i coefficients_i G^i)^passes x, both n-by-k and apart in memory. Does not depend on the number of
  /// threads. Memory: 64 bytes an unknown, 128 for polynomials of a degree above 7; none where seven applications of A
  /// do. It is kept for the next call.
  /// Throws Error: BadShape, BadArgument (no coefficients), NotAvailable (fits() is false), Cancelled.
  void apply(const std::vector<double>& coefficients, int passes, ConstValuesRef x, ValuesRef result,
             const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
