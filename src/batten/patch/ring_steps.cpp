#include "batten/patch/ring_steps.h"

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

/// Collects rows of a dense matrix, each once and without its zeros.
class RowCollector {
 public:
  explicit RowCollector(const Values& matrix)
      : matrix_(matrix), numbers_(static_cast<std::size_t>(matrix.rows()), RegularPatch::kMissing) {}

  Index number_of(Index row) {
    if (numbers_[row] == RegularPatch::kMissing) numbers_[row] = add(matrix_.row(row));
    return numbers_[row];
  }

  Index add(const Eigen::Ref<const Eigen::RowVectorXd>& weights) {
    for (Index c = 0; c < weights.cols(); ++c) {
      if (weights[c] == 0.0) continue;
      rows_.columns.push_back(c);
      rows_.weights.push_back(weights[c]);
    }
    rows_.starts.push_back(static_cast<Index>(rows_.columns.size()));
    return rows_.count() - 1;
  }

  /// The points of a patch; those that are missing are rows of their own.
  Buffer<Index> patch(const RegularPatch& patch, bool quads) {
    const int count = quads ? kQuadPatchSize : kTrianglePatchSize;
    Values points = Values::Zero(count, matrix_.cols());
    for (int i = 0; i < count; ++i) {
      if (patch.rows[i] != RegularPatch::kMissing) points.row(i) = matrix_.row(patch.rows[i]);
    }
    const auto columns = static_cast<int>(matrix_.cols());
    if (quads) {
      complete_quad_patch(patch.rows.data(), points.data(), columns);
    } else {
      complete_triangle_patch(patch.rows.data(), points.data(), columns);
    }
    Buffer<Index> numbers;
    for (int i = 0; i < count; ++i) {
      const Index row = patch.rows[i];
      numbers.push_back(row == RegularPatch::kMissing ? add(points.row(i)) : number_of(row));
    }
    return numbers;
  }

  SparseRows take() { return std::move(rows_); }

 private:
  const Values& matrix_;
  Buffer<Index> numbers_;
  SparseRows rows_;
};

}  // namespace

RingSteps::RingSteps(const Scheme& scheme) : scheme_(scheme.after_first_step()) {}

Index RingSteps::kind_of(const Topology& topology, const FaceRing& ring) {
  const auto place = numbers_.find(ring.key());
  if (place != numbers_.end()) return place->second;
  const auto kind = static_cast<Index>(kinds_.size());
  numbers_.emplace(ring.key(), kind);
  kinds_.emplace_back();
  steps_.emplace_back();
  // The face is face 0 of the cutting, and its vertices stand in the ring's order.
  const Cutting cutting = cut_out(topology, ring.half_edges());
  const Refinement refinement(cutting.topology, scheme_);
  const Index count = cutting.topology.vertex_count();
  const Values refined = refinement.apply(Values::Identity(count, count));
  const Topology& child = refinement.child();
  const bool quads = scheme_.kind == SchemeKind::CatmullClark;
  // The side of each child that runs along u (a middle triangle's: against it).
  static constexpr Index kQuadSides[4] = {0, 4 + 3, 8 + 2, 12 + 1};
  static constexpr Index kTriangleSides[4] = {0, 3 + 2, 6 + 1, 9 + 1};
  const PatchFinder finder(child, scheme_);
  std::vector<Child> children(4);
  RowCollector collector(refined);
  Step step;
  step.ring_size = count;
  for (int c = 0; c < 4; ++c) {
    Child& result = children[c];
    const Index side = quads ? kQuadSides[c] : kTriangleSides[c];
    if (finder.find(side, result.patch)) {
      result.kind = kPatch;
      step.children[c] = collector.patch(result.patch, quads);
      result.rows = rows_of(refined, result.patch.rows, quads ? kQuadPatchSize : kTrianglePatchSize);
      continue;
    }
    FaceRing own;
    own.gather(child, scheme_, side, FaceRing::kAnyNumber);
    result.rows = rows_of(refined, own.vertices(), own.vertices().size());
    for (const Index v : own.vertices()) step.children[c].push_back(collector.number_of(v));
    result.kind = kind_of(child, own);
  }
  step.rows = collector.take();
  kinds_[kind] = std::move(children);
  steps_[kind] = std::move(step);
  return kind;
}

}  // namespace batten
