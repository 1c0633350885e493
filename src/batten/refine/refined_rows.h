/// \file The matrix of one refinement step under Catmull-Clark and Loop: what each refined vertex is made of.
#pragma once
#include <memory>

#include "batten/mesh/topology.h"
#include "batten/refine/sparse_rows.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The matrix that refine_values() applies: a row for each refined vertex, in its order. Columns of a row ascend, each
/// stands once. O(H log n), n the vertices around one. Not for the Butterflies.
SparseRows refined_rows(const Topology& topology, const Scheme& scheme);

/// The transposed matrix, for rows of refined vertices that are wanted as rows of control vertices.
class RefinementPullback {
 public:
  /// Not for the Butterflies.
  RefinementPullback(const Topology& topology, const Scheme& scheme);
  ~RefinementPullback();
  RefinementPullback(RefinementPullback&&) noexcept;

  /// row: weights of refined vertices. The same linear form as weights of control vertices: columns ascend, each stands
  /// once. O(n log n), n the control vertices around, however large the faces. Safe from several threads.
  VertexWeights operator()(const VertexWeights& row) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
