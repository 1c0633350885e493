#include "batten/surface/ring_descents.h"

#include <algorithm>
#include <limits>

namespace batten {

namespace {

/// Points shrink 2^n-fold and their second differences 4^n-fold, so that n halvings at once may cost the second
/// derivatives 2 n binary digits.
constexpr std::size_t kMostToCorner = 4;

SparseRows some_rows(const SparseRows& matrix, const Buffer<Index>& rows) {
  SparseRows some;
  for (const Index r : rows) {
    for (Index e = matrix.starts[r]; e < matrix.starts[r + 1]; ++e) some.add(matrix.columns[e], matrix.weights[e]);
    some.end_row();
  }
  return some;
}

}  // namespace

RowsByFour::RowsByFour(const SparseRows& matrix, const Buffer<Index>& rows) {
  for (std::size_t first = 0; first < rows.size(); first += 4) {
    const std::size_t count = std::min<std::size_t>(4, rows.size() - first);
    std::array<Index, 4> at{};
    std::array<Index, 4> end{};
    for (std::size_t r = 0; r < count; ++r) {
      at[r] = matrix.starts[rows[first + r]];
      end[r] = matrix.starts[rows[first + r] + 1];
    }
    while (true) {
      Index column = std::numeric_limits<Index>::max();
      for (std::size_t r = 0; r < count; ++r) {
        if (at[r] < end[r]) column = std::min(column, matrix.columns[at[r]]);
      }
      if (column == std::numeric_limits<Index>::max()) break;
      columns.push_back(column);
      for (std::size_t r = 0; r < 4; ++r) {
        const bool here = r < count && at[r] < end[r] && matrix.columns[at[r]] == column;
        weights.push_back(here ? matrix.weights[at[r]++] : 0.0);
      }
    }
    starts.push_back(static_cast<Index>(columns.size()));
  }
}

void RowsByFour::apply(const Double4* from, Buffer<Double4>& to) const {
  to.resize(4 * (starts.size() - 1));
  Double4* result = to.data();
  for (std::size_t block = 0; block + 1 < starts.size(); ++block) {
    Double4 sums[4] = {};
    for (Index e = starts[block]; e < starts[block + 1]; ++e) {
      const Double4 point = from[columns[e]];
      const double* weight = &weights[4 * static_cast<std::size_t>(e)];
      for (int r = 0; r < 4; ++r) sums[r] += weight[r] * point;
    }
    for (const Double4& sum : sums) *result++ = sum;
  }
}

RingDescents::RingDescents(const RingTypes& types)
    : types_(types), children_(types.type_count()), deeper_(children_.size()) {
  for (Index type = 0; type < types.type_count(); ++type) {
    const RingTypes::Step& step = types.step(type);
    const auto fill = [&](const SparseRows& points, Children& children) {
      std::size_t most = 0;
      for (int c = 0; c < 4; ++c) {
        children[c] = RowsByFour(points, step.children[c]);
        most = std::max(most, children[c].weights.size());
      }
      return most;
    };
    const std::size_t weights = fill(step.rows, children_[type]);
    for (int corner = 0; corner < 4; ++corner) {
      if (types.child(type, corner).type != type) continue;
      SparseRows power = some_rows(step.rows, step.children[corner]);
      const std::size_t full = static_cast<std::size_t>(power.count()) * static_cast<std::size_t>(step.ring_size);
      for (std::size_t n = 1; n <= kMostToCorner; ++n) {
        // The matrices are full: those of large rings would have more weights than halvings one by one.
        if (full > (n + 1) * weights) break;
        const SparseRows points = product(step.rows, power, step.ring_size);
        fill(points, deeper_[type][corner].emplace_back());
        power = some_rows(points, step.children[corner]);
      }
    }
  }
}

/// Points are seen from the corner that they shrink to, so that small rings keep their digits.
void RingDescents::descend(int corner, int halvings, int child, DescentScratch& scratch, Descent& at) const {
  const RowsByFour& rows =
      (halvings == 0 ? children_[at.type] : deeper_[at.type][corner][static_cast<std::size_t>(halvings) - 1])[child];
  const auto count = static_cast<std::size_t>(types_.step(at.type).ring_size);
  const Double4 centre = at.points[at.rows[corner]];
  scratch.centred.resize(count);
  for (std::size_t i = 0; i < count; ++i) scratch.centred[i] = at.points[at.rows[i]] - centre;
  rows.apply(scratch.centred.data(), scratch.ring);
  for (std::size_t i = scratch.order.size(); i < scratch.ring.size(); ++i) {
    scratch.order.push_back(static_cast<Index>(i));
  }
  at = {types_.child(at.type, child).type, scratch.ring.data(), scratch.order.data(), at.origin + centre};
}

}  // namespace batten
