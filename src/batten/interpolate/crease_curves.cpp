#include "batten/interpolate/crease_curves.h"

#include <algorithm>

namespace batten {

namespace {

/// Follows the curve from `from` through `to` and on, appending Curve rows; returns the first other row met, or -1 when
/// the walk came back to `start`.
Index follow(const LimitMatrix& matrix, Index start, Index from, Index to, Buffer<std::uint8_t>& seen,
             Buffer<Index>& vertices) {
  while (matrix.row_kind(to) == LimitRow::Curve) {
    if (to == start) return -1;
    seen[to] = 1;
    vertices.push_back(to);
    const std::pair<Index, Index> ends = matrix.curve_neighbours(to);
    const Index next = ends.first == from ? ends.second : ends.first;
    from = to;
    to = next;
  }
  return to;
}

/// Elimination for the tridiagonal (1, 4, 1): returns the pivots' inverses.
Buffer<double> eliminate(std::size_t count) {
  Buffer<double> inverse(count);
  inverse[0] = 0.25;
  for (std::size_t i = 1; i < count; ++i) inverse[i] = 1.0 / (4.0 - inverse[i - 1]);
  return inverse;
}

/// Solves tridiagonal (1, 4, 1) y = y in place.
void solve_tridiagonal(const Buffer<double>& inverse, Values& y) {
  const std::ptrdiff_t count = y.rows();
  y.row(0) *= inverse[0];
  for (std::ptrdiff_t i = 1; i < count; ++i) y.row(i) = (y.row(i) - y.row(i - 1)) * inverse[i];
  for (std::ptrdiff_t i = count - 2; i >= 0; --i) y.row(i) -= inverse[i] * y.row(i + 1);
}

}  // namespace

CurveSystems find_crease_curves(const LimitMatrix& matrix) {
  CurveSystems result;
  const Index count = matrix.topology().vertex_count();
  Buffer<std::uint8_t> seen(static_cast<std::size_t>(count), 0);
  for (Index v = 0; v < count; ++v) {
    if (matrix.row_kind(v) != LimitRow::Curve || seen[v] != 0) continue;
    seen[v] = 1;
    CurveSystem curve;
    const std::pair<Index, Index> ends = matrix.curve_neighbours(v);
    Buffer<Index> backward;
    curve.before = follow(matrix, v, v, ends.first, seen, backward);
    curve.closed = curve.before < 0;
    std::reverse(backward.begin(), backward.end());
    curve.vertices = std::move(backward);
    curve.vertices.push_back(v);
    if (!curve.closed) curve.after = follow(matrix, v, v, ends.second, seen, curve.vertices);
    const bool free = curve.closed || (matrix.row_kind(curve.before) == LimitRow::Fixed &&
                                       matrix.row_kind(curve.after) == LimitRow::Fixed);
    if (free) {
      result.curves.push_back(std::move(curve));
    } else {
      result.coupled.insert(result.coupled.end(), curve.vertices.begin(), curve.vertices.end());
    }
  }
  return result;
}

void solve_curve(const CurveSystem& curve, ValuesRef x) {
  const auto count = static_cast<std::ptrdiff_t>(curve.vertices.size());
  Values y(count, x.cols());
  for (std::ptrdiff_t i = 0; i < count; ++i) y.row(i) = 6.0 * x.row(curve.vertices[i]);
  if (!curve.closed) {
    y.row(0) -= x.row(curve.before);
    y.row(count - 1) -= x.row(curve.after);
    solve_tridiagonal(eliminate(y.rows()), y);
  } else {
    // Cyclic: the last unknown joins the first, so solve for it last (bordering): the others depend on it linearly.
    const Buffer<double> inverse = eliminate(count - 1);
    Values inner = y.topRows(count - 1);
    Values coupling = Values::Zero(count - 1, 1);
    coupling(0, 0) += 1.0;
    coupling(count - 2, 0) += 1.0;
    solve_tridiagonal(inverse, inner);
    solve_tridiagonal(inverse, coupling);
    const double pivot = 4.0 - coupling(0, 0) - coupling(count - 2, 0);
    y.row(count - 1) = (y.row(count - 1) - inner.row(0) - inner.row(count - 2)) / pivot;
    y.topRows(count - 1) = inner - coupling * y.row(count - 1);
  }
  for (std::ptrdiff_t i = 0; i < count; ++i) x.row(curve.vertices[i]) = y.row(i);
}

}  // namespace batten
