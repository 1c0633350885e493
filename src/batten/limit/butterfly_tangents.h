/// \file Limit tangents of the Butterflies, as weights on two rings around a vertex.
///
/// Around a vertex whose neighbours are regular, one step of refinement takes the two rings to those of the next level
/// by a fixed matrix S. The limit tangents are left eigenvectors of S (docs/mathematics.md, Butterfly). Modified
/// Butterfly has closed forms for most vertices; the others are found by iterating y = S^T y, where the refinement
/// rules give S.
#pragma once
#include <map>
#include <vector>

#include "batten/refine/butterfly_rules.h"

namespace batten {

/// The part of a vertex's surroundings that a mask covers.
enum class ButterflyFan {
  Closed,  ///< all triangles around a smooth vertex
  Dart,    ///< all triangles around a dart; edge 0 is its sharp edge
  Curve    ///< one side of a boundary or crease
};

/// Weights of the vertex, its edge neighbours e_j, the vertices d_j beyond them in line, and the vertices m_j across
/// the edges e_j e_{j+1}. A kind of neighbour without weights is empty.
struct TwoRingMask {
  double vertex = 0.0;
  std::vector<double> edges;
  std::vector<double> beyond;
  std::vector<double> across;
};

/// first x second points outward for counter-clockwise faces.
struct ButterflyTangentMasks {
  TwoRingMask first;
  TwoRingMask second;
};

/// The masks of one scheme. Each is computed when it is first requested.
class ButterflyTangents {
 public:
  explicit ButterflyTangents(const Scheme& scheme) : scheme_(scheme) {}

  /// triangles: at least 3 for a closed fan or a dart, at least 1 otherwise. O(triangles) for a closed form, a few
  /// hundred times that otherwise.
  const ButterflyTangentMasks& make(ButterflyFan fan, int triangles);
  /// A mask that make() has computed.
  const ButterflyTangentMasks& at(ButterflyFan fan, int triangles) const { return masks_.at({fan, triangles}); }

 private:
  Scheme scheme_;
  std::map<std::pair<ButterflyFan, int>, ButterflyTangentMasks> masks_;
};

}  // namespace batten
