#include "batten/patch/ring_types.h"

#include <algorithm>

#include "batten/refine/child_topology.h"
#include "batten/refine/refined_rows.h"

namespace batten {

namespace {

void append_row(const SparseRows& matrix, Index row, SparseRows& rows) {
  for (Index e = matrix.starts[row]; e < matrix.starts[row + 1]; ++e) rows.add(matrix.columns[e], matrix.weights[e]);
  rows.end_row();
}

/// The given rows of a matrix; missing ones are empty.
template <typename Rows>
SparseRows rows_of(const SparseRows& matrix, const Rows& rows, std::size_t count) {
  SparseRows chosen;
  for (std::size_t r = 0; r < count; ++r) {
    if (rows[r] < 0) {
      chosen.end_row();
    } else {
      append_row(matrix, rows[r], chosen);
    }
  }
  return chosen;
}

/// Collects rows of a matrix, each once.
class RowCollector {
 public:
  explicit RowCollector(const SparseRows& matrix)
      : matrix_(matrix), numbers_(static_cast<std::size_t>(matrix.count()), RegularPatch::kMissing) {}

  Index number_of(Index row) {
    if (numbers_[row] == RegularPatch::kMissing) {
      append_row(matrix_, row, rows_);
      numbers_[row] = rows_.count() - 1;
    }
    return numbers_[row];
  }

  /// The points of a patch; those that are missing are rows of their own.
  Buffer<Index> patch(const RegularPatch& patch, bool quads) {
    const auto count = static_cast<std::size_t>(patch_size(quads));
    Buffer<Index> columns;
    for (std::size_t i = 0; i < count; ++i) {
      const Index row = patch.rows[i];
      if (row == RegularPatch::kMissing) continue;
      columns.insert(columns.end(), &matrix_.columns[matrix_.starts[row]], &matrix_.columns[matrix_.starts[row + 1]]);
    }
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    const Values points = completed(patch, columns, quads);
    Buffer<Index> numbers;
    for (std::size_t i = 0; i < count; ++i) {
      const bool missing = patch.rows[i] == RegularPatch::kMissing;
      numbers.push_back(missing ? add(points.row(static_cast<Eigen::Index>(i)), columns) : number_of(patch.rows[i]));
    }
    return numbers;
  }

  SparseRows take() { return std::move(rows_); }

 private:
  /// All points of a patch, on these columns.
  Values completed(const RegularPatch& patch, const Buffer<Index>& columns, bool quads) const {
    const auto width = static_cast<int>(columns.size());
    const int count = patch_size(quads);
    Values points = Values::Zero(count, width);
    for (int i = 0; i < count; ++i) {
      const Index row = patch.rows[i];
      if (row == RegularPatch::kMissing) continue;
      for (Index e = matrix_.starts[row]; e < matrix_.starts[row + 1]; ++e) {
        const auto place = std::lower_bound(columns.begin(), columns.end(), matrix_.columns[e]) - columns.begin();
        points(i, place) = matrix_.weights[e];
      }
    }
    complete_patch(quads, patch.rows.data(), points.data(), width);
    return points;
  }

  Index add(const Eigen::Ref<const Eigen::RowVectorXd>& weights, const Buffer<Index>& columns) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double weight = weights[static_cast<Eigen::Index>(c)];
      if (weight != 0.0) rows_.add(columns[c], weight);
    }
    rows_.end_row();
    return rows_.count() - 1;
  }

  const SparseRows& matrix_;
  Buffer<Index> numbers_;
  SparseRows rows_;
};

}  // namespace

RingTypes::RingTypes(const Scheme& scheme) : scheme_(scheme.after_first_step()) {}

Index RingTypes::type_of(const Topology& topology, const FaceRing& ring) {
  const auto place = numbers_.find(ring.key());
  if (place != numbers_.end()) return place->second;
  const auto type = static_cast<Index>(types_.size());
  numbers_.emplace(ring.key(), type);
  types_.emplace_back();
  steps_.emplace_back();
  // The face is face 0 of the cutting, and its vertices stand in the ring's order.
  const Cutting cutting = cut_out(topology, ring.half_edges());
  const SparseRows refined = refined_rows(cutting.topology, scheme_);
  const Topology child = child_topology(cutting.topology, scheme_);
  const bool quads = scheme_.kind == SchemeKind::CatmullClark;
  // The side of each child that runs along u (a middle triangle's: against it).
  static constexpr Index kQuadSides[4] = {0, 4 + 3, 8 + 2, 12 + 1};
  static constexpr Index kTriangleSides[4] = {0, 3 + 2, 6 + 1, 9 + 1};
  const PatchFinder finder(child, scheme_);
  std::vector<Child> children(4);
  RowCollector collector(refined);
  Step step;
  step.ring_size = cutting.topology.vertex_count();
  for (int c = 0; c < 4; ++c) {
    Child& result = children[c];
    const Index side = quads ? kQuadSides[c] : kTriangleSides[c];
    if (finder.find(side, result.patch)) {
      result.type = kPatch;
      step.children[c] = collector.patch(result.patch, quads);
      result.rows = rows_of(refined, result.patch.rows, patch_size(quads));
      continue;
    }
    FaceRing own;
    own.gather(child, scheme_, side);
    result.rows = rows_of(refined, own.vertices(), own.vertices().size());
    for (const Index v : own.vertices()) step.children[c].push_back(collector.number_of(v));
    result.type = type_of(child, own);
  }
  step.rows = collector.take();
  types_[type] = std::move(children);
  steps_[type] = std::move(step);
  return type;
}

}  // namespace batten
