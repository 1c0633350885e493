#include "batten/surface/ring_descents.h"

#include <algorithm>

namespace batten {

namespace {

/// Points shrink 2^n-fold and their second differences 4^n-fold, so that n halvings at once may cost the second
/// derivatives 2 n binary digits.
constexpr std::size_t kMostToCorner = 4;

Values product(const SparseRows& rows, const Values& right) {
  Values result = Values::Zero(rows.count(), right.cols());
  for (Index r = 0; r < rows.count(); ++r) {
    double* to = &result(r, 0);
    for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) {
      const double* from = &right(rows.columns[e], 0);
      const double weight = rows.weights[e];
      for (std::ptrdiff_t c = 0; c < right.cols(); ++c) to[c] += weight * from[c];
    }
  }
  return result;
}

Values some_rows(const Values& matrix, const Buffer<Index>& rows) {
  Values result(static_cast<std::ptrdiff_t>(rows.size()), matrix.cols());
  for (std::ptrdiff_t r = 0; r < result.rows(); ++r) result.row(r) = matrix.row(rows[r]);
  return result;
}

}  // namespace

RowsByFour::RowsByFour(const Values& matrix, const Buffer<Index>& rows) {
  for (std::size_t first = 0; first < rows.size(); first += 4) {
    const std::size_t count = std::min<std::size_t>(4, rows.size() - first);
    for (Index c = 0; c < matrix.cols(); ++c) {
      double four[4] = {};
      for (std::size_t r = 0; r < count; ++r) four[r] = matrix(rows[first + r], c);
      if (std::all_of(four, four + 4, [](double weight) { return weight == 0.0; })) continue;
      columns.push_back(c);
      weights.insert(weights.end(), four, four + 4);
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

RingDescents::RingDescents(const RingSteps& steps)
    : steps_(steps), children_(steps.kind_count()), deeper_(children_.size()) {
  for (Index kind = 0; kind < steps.kind_count(); ++kind) {
    const RingSteps::Step& step = steps.step(kind);
    const auto fill = [&](const Values& points, Children& children) {
      std::size_t most = 0;
      for (int c = 0; c < 4; ++c) {
        children[c] = RowsByFour(points, step.children[c]);
        most = std::max(most, children[c].weights.size());
      }
      return most;
    };
    const Values once = product(step.rows, Values::Identity(step.ring_size, step.ring_size));
    const std::size_t weights = fill(once, children_[kind]);
    for (int corner = 0; corner < 4; ++corner) {
      if (steps.child(kind, corner).kind != kind) continue;
      Values power = some_rows(once, step.children[corner]);
      for (std::size_t n = 1; n <= kMostToCorner; ++n) {
        // The matrices are full: those of large rings would have more weights than halvings one by one.
        if (static_cast<std::size_t>(power.size()) > (n + 1) * weights) break;
        const Values points = product(step.rows, power);
        fill(points, deeper_[kind][corner].emplace_back());
        power = some_rows(points, step.children[corner]);
      }
    }
  }
}

/// Points are seen from the corner that they shrink to, so that small rings keep their digits.
void RingDescents::descend(int corner, int halvings, int child, DescentScratch& scratch, Descent& at) const {
  const RowsByFour& rows =
      (halvings == 0 ? children_[at.kind] : deeper_[at.kind][corner][static_cast<std::size_t>(halvings) - 1])[child];
  const auto count = static_cast<std::size_t>(steps_.step(at.kind).ring_size);
  const Double4 centre = at.points[at.rows[corner]];
  scratch.centred.resize(count);
  for (std::size_t i = 0; i < count; ++i) scratch.centred[i] = at.points[at.rows[i]] - centre;
  rows.apply(scratch.centred.data(), scratch.ring);
  for (std::size_t i = scratch.order.size(); i < scratch.ring.size(); ++i) {
    scratch.order.push_back(static_cast<Index>(i));
  }
  at = {steps_.child(at.kind, child).kind, scratch.ring.data(), scratch.order.data(), at.origin + centre};
}

}  // namespace batten
