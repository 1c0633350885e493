/// \file Rows of the limit matrix around a few vertices, numbered densely.
#pragma once
#include <span>

#include "batten/limit/limit_matrix.h"

namespace batten {

/// Vertices get numbers in the order in which they are met, so that work on a part of the mesh needs memory and time
/// for that part alone. A mark of 4 bytes a vertex of the mesh is kept between uses.
class LocalRows {
 public:
  struct Entry {
    Index place;
    double weight;
  };

  /// The matrix must outlive it. O(V).
  explicit LocalRows(const LimitMatrix& matrix);

  const LimitMatrix& matrix() const { return *matrix_; }
  /// How many vertices have a number.
  Index size() const { return static_cast<Index>(vertices_.size()); }
  Index vertex(Index place) const { return vertices_[place]; }

  /// The vertex's number, a new one where it has none.
  Index place_of(Index vertex);

  /// The row's entries, and with weight 0 the other vertices whose own rows may have this vertex as a column: a crease
  /// shapes the surface beside it, and not the other way round. A place may come several times. Valid until the next
  /// call; built once, in O(ring).
  std::span<const Entry> row(Index place);
  /// Likewise built where it is not yet.
  double diagonal(Index place);
  bool has_row(Index place) const { return extents_[place].end > 0; }

  /// Forgets all vertices. O(size()).
  void clear();

 private:
  struct Extent {
    Index begin = 0;
    Index end = 0;  ///< 0: not built
    double diagonal = 0.0;
  };
  void build(Index place);

  const LimitMatrix* matrix_;
  Buffer<Index> place_of_;  ///< -1: none
  std::vector<Index> vertices_;
  std::vector<Extent> extents_;
  std::vector<Entry> entries_;
};

}  // namespace batten
