/// \file Vertices of high valence, and what a face next to one needs to know of the others.
#pragma once
#include <unordered_map>

#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// A pole is a smooth vertex inside the surface where many faces meet, all of them quads (Catmull-Clark) or triangles.
///
/// Refinement moves a pole by the means of its neighbours: of the far ends e of its edges and, under Catmull-Clark, of
/// the opposite corners f of its quads. The means refine among themselves. So the ring of a face at a pole may leave
/// the faces far around the pole out: it has those within some steps, and the means as points of its own. Each halving
/// towards the pole takes one step off. All points of the halved ring are convex combinations of its points, as those
/// of any other ring.
class Poles {
 public:
  /// Of fewer faces rings have all.
  static constexpr Index kFewestFaces = 192;
  /// Faces to either side in the rings of pieces. So many halvings shrink a ring to less than rounding leaves of it, by
  /// 0.655 (Catmull-Clark) or 0.625 (Loop) each.
  static constexpr int kWidth = 80;

  Poles() = default;
  /// Finds the poles. There are none under Chaikin's rule with creases, which looks beyond rings. O(H).
  Poles(const Topology& topology, const Scheme& scheme);
  /// A topology with a single pole, of which it may have a part of the faces.
  Poles(const Topology& topology, Index vertex, Index faces);

  bool empty() const { return vertices_.empty(); }
  bool is_pole(Index vertex) const { return !empty() && places_.count(vertex) > 0; }
  /// The number of faces at a pole.
  Index faces(Index pole) const { return faces_[places_.at(pole)]; }

  /// 0 where there is no pole.
  Index most_faces() const;

  /// The means of a pole: e, and f where faces are quads.
  Index means() const { return means_; }
  /// The row of its first mean: the means' rows follow those of the topology's vertices.
  Index first_mean(Index pole) const { return first_ + means_ * places_.at(pole); }
  /// Values with the rows of the means appended. values: a row a vertex of the topology with all faces. O(H).
  Values with_means(const Topology& topology, const Values& values) const;

 private:
  void add(Index vertex, Index faces);

  Index means_ = 0;
  Index first_ = 0;
  Buffer<Index> vertices_;
  Buffer<Index> faces_;
  std::unordered_map<Index, Index> places_;  ///< of each pole: where it stands among them
};

/// Every face at a vertex that is no pole has a ring, and a ring type, of its own, with all faces there: beyond so many
/// they take gigabytes and minutes.
inline constexpr Index kMostSharpFaces = 1024;

/// Throws Error(TooLarge) where more faces meet at a vertex that is still no pole after so many steps. O(H).
void require_narrow_sharp_fans(const Topology& topology, const Scheme& scheme, int steps);

}  // namespace batten
