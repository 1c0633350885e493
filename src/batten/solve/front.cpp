#include "batten/solve/front.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr int kPanel = 32;        ///< columns that are factored before the others take them in
constexpr int kStripe = 32;       ///< columns that a task takes
constexpr int kMostSerial = 128;  ///< rows of a front that is not worth the threads

/// Numbers that fill a register.
template <typename Number>
struct Lanes {
  static constexpr int kCount = static_cast<int>(32 / sizeof(Number));
  using Vector __attribute__((vector_size(32))) = Number;
  struct Unaligned {
    Vector value;
  } __attribute__((packed, aligned(sizeof(Number))));

  static Vector load(const Number* from) { return reinterpret_cast<const Unaligned*>(from)->value; }
  static void store(Number* to, Vector value) { reinterpret_cast<Unaligned*>(to)->value = value; }
};

/// to[0 .. two registers) of four columns -= sum over k of a_k[0 .. two registers) * b_k[column], where a_k and b_k are
/// rows of one column of the front each, the first of them `stride` before the next.
template <typename Number>
void subtract_block(const Number* a, const Number* b, std::ptrdiff_t stride, int depth, Number* const to[4]) {
  using Register = Lanes<Number>;
  typename Register::Vector sums[4][2] = {};
  for (int k = 0; k < depth; ++k, a += stride, b += stride, --stride) {
    const typename Register::Vector low = Register::load(a);
    const typename Register::Vector high = Register::load(a + Register::kCount);
    for (int c = 0; c < 4; ++c) {
      sums[c][0] += b[c] * low;
      sums[c][1] += b[c] * high;
    }
  }
  for (int c = 0; c < 4; ++c) {
    Register::store(to[c], Register::load(to[c]) - sums[c][0]);
    Register::store(to[c] + Register::kCount, Register::load(to[c] + Register::kCount) - sums[c][1]);
  }
}

/// Entry by entry, in the same order of k.
template <typename Number>
void subtract_entries(const Number* a, const Number* b, std::ptrdiff_t stride, int depth, int rows, Number* to) {
  for (int i = 0; i < rows; ++i) {
    Number sum = 0;
    std::ptrdiff_t at = 0;
    for (int k = 0; k < depth; ++k) {
      sum += b[at] * a[at + i];
      at += stride - k;
    }
    to[i] -= sum;
  }
}

/// Columns [first, last) lose what the panel's columns [begin, end) take, from their diagonal down. Of a block on the
/// diagonal the entries above it are not there: its first rows go by themselves.
template <typename Number>
void subtract_panel(Front<Number>& front, int begin, int end, int first, int last) {
  constexpr int kRows = 2 * Lanes<Number>::kCount;
  const std::ptrdiff_t stride = front.size - begin - 1;
  const int depth = end - begin;
  const Number* const panel = front.column(begin);
  int j = first;
  for (; j + 4 <= last; j += 4) {
    Number* const to[4] = {front.column(j), front.column(j + 1), front.column(j + 2), front.column(j + 3)};
    for (int c = 0; c < 3; ++c) {
      const int row = j + c;
      subtract_entries(panel + row, panel + row, stride, depth, 3 - c, to[c] + row);
    }
    int i = j + 3;
    for (; i + kRows <= front.size; i += kRows) {
      Number* const at[4] = {to[0] + i, to[1] + i, to[2] + i, to[3] + i};
      subtract_block(panel + i, panel + j, stride, depth, at);
    }
    for (int c = 0; c < 4; ++c) {
      subtract_entries(panel + i, panel + j + c, stride, depth, front.size - i, to[c] + i);
    }
  }
  for (; j < last; ++j) subtract_entries(panel + j, panel + j, stride, depth, front.size - j, front.column(j) + j);
}

/// Factors the columns [begin, end), which have lost what those before take.
template <typename Number>
double factor_panel(Front<Number>& front, int begin, int end, const Number* diagonal) {
  double least = std::numeric_limits<double>::infinity();
  for (int j = begin; j < end; ++j) {
    Number* const column = front.column(j);
    for (int k = begin; k < j; ++k) {
      const Number* const before = front.column(k);
      const Number factor = before[j];
      for (int i = j; i < front.size; ++i) column[i] -= factor * before[i];
    }
    const Number pivot = column[j];
    if (!(pivot > 0)) return -1.0;
    least = std::min(least, static_cast<double>(pivot / diagonal[j]));
    const Number root = std::sqrt(pivot);
    column[j] = root;
    const Number inverse = 1 / root;
    for (int i = j + 1; i < front.size; ++i) column[i] *= inverse;
  }
  return least;
}

}  // namespace

template <typename Number>
void Front<Number>::reset(int new_size) {
  size = new_size;
  entries.assign(entry_count(size, size), 0);
}

template <typename Number>
double factor_front(Front<Number>& front, int width, const Number* diagonal) {
  double least = std::numeric_limits<double>::infinity();
  for (int begin = 0; begin < width; begin += kPanel) {
    const int end = std::min(width, begin + kPanel);
    const double pivot = factor_panel(front, begin, end, diagonal);
    if (pivot < 0.0) return pivot;
    least = std::min(least, pivot);
    const int left = front.size - end;
    const auto stripe = [&](std::ptrdiff_t s) {
      const int first = end + static_cast<int>(s) * kStripe;
      subtract_panel(front, begin, end, first, std::min(front.size, first + kStripe));
    };
    const std::ptrdiff_t stripes = (left + kStripe - 1) / kStripe;
    if (left <= kMostSerial) {
      for (std::ptrdiff_t s = 0; s < stripes; ++s) stripe(s);
    } else {
      parallel_for_each(stripes, stripe);
    }
  }
  return least;
}

template struct Front<double>;
template struct Front<float>;
template double factor_front(Front<double>& front, int width, const double* diagonal);
template double factor_front(Front<float>& front, int width, const float* diagonal);

}  // namespace batten
