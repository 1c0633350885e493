/// \file The sides of polygons grouped by edge, and a common orientation of all faces, for faces that are not a
/// Topology yet (mesh/check.h, mesh/repair.h).
///
/// A side is named by its corner: side c runs from corner c's vertex to the next corner's, with its face on the left.
#pragma once
#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Disjoint sets of indices. Each set is named by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count);
  Index root(Index i);
  void join(Index a, Index b);

 private:
  Buffer<Index> parents_;
};

/// Refers to offsets and vertices, which must outlive it. O(H log H); 20 bytes for each corner.
class SideTable {
 public:
  struct Side {
    std::uint64_t edge;  ///< the lower vertex and the higher one
    Index corner;
    bool operator<(const Side& other) const { return edge != other.edge ? edge < other.edge : corner < other.corner; }
  };

  /// Faces with a mark in `skipped` have no sides here; an empty `skipped` marks none.
  SideTable(const Buffer<Index>& offsets, const Buffer<Index>& vertices, const Buffer<std::uint8_t>& skipped = {});

  Index face_count() const { return static_cast<Index>(offsets_.size()) - 1; }
  Index corner_count() const { return static_cast<Index>(vertices_.size()); }
  Index face(Index corner) const { return faces_[corner]; }
  Index next(Index corner) const {
    return corner + 1 == offsets_[faces_[corner] + 1] ? offsets_[faces_[corner]] : corner + 1;
  }
  Index from(Index corner) const { return vertices_[corner]; }
  Index to(Index corner) const { return vertices_[next(corner)]; }
  const Buffer<Index>& offsets() const { return offsets_; }

  static std::uint64_t edge_key(Index a, Index b) {
    const auto low = static_cast<std::uint64_t>(static_cast<std::uint32_t>(a < b ? a : b));
    return low << 32 | static_cast<std::uint32_t>(a < b ? b : a);
  }
  const Buffer<Side>& sorted() const { return sides_; }

  /// Calls visit(first, last) for the range of sides of each edge, ordered by the edge's lower vertex, then the higher
  /// one. Sides of an edge are ordered by corner.
  template <typename Visit>
  void for_each_edge(const Visit& visit) const {
    const Side* end = sides_.data() + sides_.size();
    for (const Side* first = sides_.data(); first != end;) {
      const Side* last = first + 1;
      while (last != end && last->edge == first->edge) ++last;
      visit(first, last);
      first = last;
    }
  }

 private:
  const Buffer<Index>& offsets_;
  const Buffer<Index>& vertices_;
  Buffer<Index> faces_;
  Buffer<Side> sides_;
};

/// For each side, the side on the other side of its edge or -1, and whether both run in the same direction, so that one
/// of the two faces has to be reversed.
struct SidePairs {
  explicit SidePairs(Index corner_count);
  void join(Index a, Index b, bool same_way);
  void part(Index side);

  Buffer<Index> partner;
  Buffer<std::uint8_t> same_way;
};

/// Pairs the two sides of each edge.
SidePairs pair_sides(const SideTable& sides);

struct Orientation {
  Buffer<std::uint8_t> reversed;  ///< F: marks the smaller part of each component's faces, so that all agree
  Buffer<Index> component;        ///< F: components numbered by their lowest face
  Index component_count = 0;
  Buffer<Index> conflicts;  ///< sides, one of each pair, that no choice makes agree; cutting there lets the rest agree
};

/// Makes paired sides agree. Faces that already agree stay together, so that a Moebius strip is cut where its
/// orientation jumps. O(H).
Orientation orient(const SideTable& sides, const SidePairs& pairs);

}  // namespace batten
