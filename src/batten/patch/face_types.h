/// \file Base faces as wholes: regular, or of a ring type.
#pragma once
#include <span>

#include "batten/patch/face_ring.h"
#include "batten/patch/regular_patch.h"
#include "batten/patch/ring_types.h"

namespace batten {

/// Const and safe from several threads.
class FaceTypes {
 public:
  /// All faces are quads (Catmull-Clark) or triangles. O(H), under a microsecond a face; next to a vertex of valence n
  /// O(n). Throws Error(BadArgument) for the Butterflies.
  FaceTypes(const Topology& base, const Scheme& base_scheme);

  /// The ring type of a face, or RingTypes::kPatch.
  Index type(Index face) const { return types_[face]; }
  const RingTypes& ring_types() const { return ring_types_; }

  /// The vertices around a face that is not regular, in its type's order. Those of large rings are gathered into
  /// `scratch`, so that memory does not grow with the square of a valence.
  std::span<const Index> ring(Index face, FaceRing& scratch) const;
  /// The patch of a face that is.
  RegularPatch patch(Index face) const;

 private:
  Topology base_;
  Scheme scheme_;
  PatchFinder finder_;
  RingTypes ring_types_;
  Buffer<Index> types_;
  Buffer<std::size_t> ring_starts_;  ///< F + 1
  Buffer<Index> rings_;              ///< empty for regular faces and large rings
};

}  // namespace batten
