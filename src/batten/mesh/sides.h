/// \file The sides of polygons gathered edge by edge, and one orientation for all faces: for faces that are not a
/// Topology yet (mesh/check.h, mesh/repair.h).
///
/// A side is named by its corner: side c runs from corner c's vertex to the next corner's, its face on the left.
#pragma once
#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Which of a number of things are one: each set is named by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count);
  Index root(Index i);
  void join(Index a, Index b);

 private:
  Buffer<Index> parents_;
};

/// Keeps references: offsets and vertices must outlive it. O(H log H); 20 bytes a corner.
class SideTable {
 public:
  struct Side {
    std::uint64_t edge;  ///< the lower vertex and the higher one
    Index corner;
    bool operator<(const Side& other) const { return edge != other.edge ? edge < other.edge : corner < other.corner; }
  };

  /// Faces with a mark in `skipped` (empty: none) have no sides here.
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

  /// Calls visit(first, last) for the sides of each edge, by lower vertex, then higher one; sides by corner.
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

/// For each side the one on the other side of its edge, or -1; and whether both run the same way, so that one of the
/// two faces has to be reversed.
struct SidePairs {
  explicit SidePairs(Index corner_count);
  void join(Index a, Index b, bool same_way);
  void part(Index side);

  Buffer<Index> partner;
  Buffer<std::uint8_t> same_way;
};

/// The edges of two sides as pairs.
SidePairs pair_sides(const SideTable& sides);

struct Orientation {
  Buffer<std::uint8_t> reversed;  ///< F: of each component's faces the smaller part, so that all agree
  Buffer<Index> component;        ///< F: numbered by lowest face
  Index component_count = 0;
  Buffer<Index> conflicts;  ///< sides, one of a pair, that no choice brings to agree: cut there and the rest agrees
};

/// Agreement between paired sides. Faces that agree already stay together, so that a Moebius strip is cut where its
/// orientation jumps. O(H).
Orientation orient(const SideTable& sides, const SidePairs& pairs);

}  // namespace batten
