#include "batten/refine/ring_steps.h"

#include "batten/refine/refinement.h"

namespace batten {

namespace {

/// The given rows of a matrix, without its zeros.
template <typename Rows>
SparseRows rows_of(const Values& matrix, const Rows& rows, std::size_t count) {
  SparseRows sparse;
  for (std::size_t r = 0; r < count; ++r) {
    for (Index c = 0; rows[r] >= 0 && c < matrix.cols(); ++c) {
      if (matrix(rows[r], c) == 0.0) continue;
      sparse.columns.push_back(c);
      sparse.weights.push_back(matrix(rows[r], c));
    }
    sparse.starts.push_back(static_cast<Index>(sparse.columns.size()));
  }
  return sparse;
}

}  // namespace

RingSteps::RingSteps(const Scheme& scheme) : scheme_(scheme.after_first_step()) {}

Index RingSteps::kind_of(const Topology& topology, const FaceRing& ring) {
  const auto place = numbers_.find(ring.key());
  if (place != numbers_.end()) return place->second;
  const auto kind = static_cast<Index>(kinds_.size());
  numbers_.emplace(ring.key(), kind);
  kinds_.emplace_back();
  // The face is face 0 of the cutting, and its vertices stand in the ring's order.
  const Cutting cutting = cut_out(topology, ring.half_edges());
  const Refinement step(cutting.topology, scheme_);
  const Index count = cutting.topology.vertex_count();
  const Values refined = step.apply(Values::Identity(count, count));
  const Topology& child = step.child();
  const bool quads = scheme_.kind == SchemeKind::CatmullClark;
  // The side of each child that runs along u (a middle triangle's: against it).
  static constexpr Index kQuadSides[4] = {0, 4 + 3, 8 + 2, 12 + 1};
  static constexpr Index kTriangleSides[4] = {0, 3 + 2, 6 + 1, 9 + 1};
  const PatchFinder finder(child, scheme_);
  std::vector<Child> children(4);
  for (int c = 0; c < 4; ++c) {
    Child& result = children[c];
    const Index side = quads ? kQuadSides[c] : kTriangleSides[c];
    if (finder.find(side, result.patch)) {
      result.kind = kPatch;
      result.rows = rows_of(refined, result.patch.rows, quads ? kQuadPatchSize : kTrianglePatchSize);
      continue;
    }
    FaceRing own;
    own.gather(child, scheme_, side, FaceRing::kAnyNumber);
    result.rows = rows_of(refined, own.vertices(), own.vertices().size());
    result.kind = kind_of(child, own);
  }
  kinds_[kind] = std::move(children);
  return kind;
}

}  // namespace batten
