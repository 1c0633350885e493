/// \file Faces next to a vertex of high valence: equal surroundings told apart without a walk around it for each of
/// them.
#pragma once
#include <string>
#include <unordered_map>

#include "batten/mesh/topology.h"

namespace batten {

/// A pole is a vertex with many faces, none of its edges on a boundary, and vertices around it that are all different.
/// All of its faces see the same ring from another side, so the surroundings of one follow from the valence, from what
/// is near the face, and from the fact that nothing far around the pole comes near the face again. O(H log n).
class PoleKeys {
 public:
  /// Knows poles where no edge or vertex is tagged.
  explicit PoleKeys(const Topology& topology);

  /// False where the face of a half-edge has no pole among its corners, several, or far vertices nearby. Otherwise
  /// `key` is equal for two faces exactly when refinement does the same to both. O(near vertices).
  bool find(Index half_edge, std::string& key) const;

 private:
  Topology topology_;
  std::unordered_map<Index, Buffer<Index>> rings_;  ///< of each pole: the vertices around it, ascending
};

}  // namespace batten
