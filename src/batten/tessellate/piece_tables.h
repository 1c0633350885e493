/// \file The weights of a piece's points: for regular patches of every size, and for every shared ring.
#pragma once
#include <memory>
#include <vector>

#include "batten/patch/pieces.h"
#include "batten/tessellate/tile_weights.h"

namespace batten {

/// Of the vectors that loops are compiled for.
#if defined(__AVX512F__)
inline constexpr std::ptrdiff_t kVectorBytes = 64;
#elif defined(__AVX__)
inline constexpr std::ptrdiff_t kVectorBytes = 32;
#else
inline constexpr std::ptrdiff_t kVectorBytes = 16;
#endif

/// Three columns of points are summed at a time, in so many vectors each. Processors with short vectors have sixteen
/// registers, in which three such sums, a row of weights and a control point find room; with more, WebAssembly's code
/// keeps them in memory.
inline constexpr std::ptrdiff_t kSumVectors = kVectorBytes > 16 ? 4 : 3;
/// Rows of weights and planes are padded to multiples: one or more sums.
inline constexpr std::ptrdiff_t kGridLanes = kVectorBytes > 16 ? 32 : 12;
constexpr std::ptrdiff_t padded(std::ptrdiff_t points) { return (points + kGridLanes - 1) / kGridLanes * kGridLanes; }

/// How one kind of value follows from control points, for patches of every size and for every shared ring.
template <typename Scalar>
class PieceTables {
 public:
  PieceTables(const Pieces& pieces, TileValue value);

  TileValue value() const { return value_; }

  /// Dense: weight k of point p at k * stride + p in u, points row by row. Otherwise a tensor product: weight j of
  /// point i of a curve at j * stride + i, along u and along v.
  struct Patch {
    bool dense;
    std::ptrdiff_t stride;
    Buffer<Scalar> u;
    Buffer<Scalar> v;
  };
  const Patch& patch(Index size) const;

  /// Weight k of point p at k * stride + p; points row by row, of triangles the rows that fit.
  struct Ring {
    std::ptrdiff_t stride;
    Index vertices;
    Buffer<Scalar> weights;
  };
  const Ring& ring(std::int32_t shared_ring) const { return rings_[shared_ring]; }

 private:
  template <typename Other>
  friend class PieceTables;
  using Patches = std::shared_ptr<const std::vector<Patch>>;

  /// Of pieces without rings.
  PieceTables(TileValue value, Patches patches) : value_(value), patches_(std::move(patches)) {}
  static Patches patches_of(SchemeKind kind, int levels, TileValue value);
  static Ring ring_of(const Pieces::SharedRing& shared, const Scheme& scheme, const PieceTables<double>& tables);

  TileValue value_;
  Patches patches_;  ///< of 2^0, 2^1, ... steps a side
  std::vector<Ring> rings_;
};

}  // namespace batten
