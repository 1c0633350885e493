/// \file Limit tangents of the Butterflies, as weights on two rings around a vertex.
///
/// Around a vertex whose neighbours are regular one step of refinement takes the two rings to those of the next level,
/// by a fixed matrix S. Limit tangents are its left eigenvectors (docs/mathematics.md, Butterfly): in closed form where Modified Butterfly has
/// one, else by iterating y = S^T y, with the matrix made by the rules themselves.
#pragma once
#include <map>
#include <vector>

#include "batten/refine/butterfly_rules.h"

namespace batten {

/// What lies around a vertex, or between two sharp edges there.
enum class ButterflyFan {
  Closed,  ///< all around a smooth vertex
  Dart,    ///< all around a dart; edge 0 is its sharp edge
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

/// The masks of one scheme, each made when first asked for.
class ButterflyTangents {
 public:
  explicit ButterflyTangents(const Scheme& scheme) : scheme_(scheme) {}

  /// triangles: 3 or more for a closed fan or a dart, else 1 or more. O(triangles) for a closed form, a few hundred
  /// times that otherwise.
  const ButterflyTangentMasks& make(ButterflyFan fan, int triangles);
  /// What make() has made.
  const ButterflyTangentMasks& at(ButterflyFan fan, int triangles) const { return masks_.at({fan, triangles}); }

 private:
  Scheme scheme_;
  std::map<std::pair<ButterflyFan, int>, ButterflyTangentMasks> masks_;
};

}  // namespace batten
