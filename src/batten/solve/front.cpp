#include "batten/solve/front.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/double4.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr int kPanel = 32;        ///< columns that are factored before the others take them in
constexpr int kStripe = 32;       ///< columns that a task takes
constexpr int kMostSerial = 128;  ///< rows of a front that is not worth the threads

struct Unaligned {
  Double4 value;
} __attribute__((packed, aligned(8)));

Double4 load(const double* from) { return reinterpret_cast<const Unaligned*>(from)->value; }
void store(double* to, Double4 value) { reinterpret_cast<Unaligned*>(to)->value = value; }

/// to[0 .. 8) of four columns -= sum over k of a[k stride + 0 .. 8) * b[k stride + column].
void subtract_block(const double* a, const double* b, std::size_t stride, int depth, double* const to[4]) {
  Double4 sums[4][2] = {};
  for (int k = 0; k < depth; ++k, a += stride, b += stride) {
    const Double4 low = load(a);
    const Double4 high = load(a + 4);
    for (int c = 0; c < 4; ++c) {
      sums[c][0] += b[c] * low;
      sums[c][1] += b[c] * high;
    }
  }
  for (int c = 0; c < 4; ++c) {
    store(to[c], load(to[c]) - sums[c][0]);
    store(to[c] + 4, load(to[c] + 4) - sums[c][1]);
  }
}

/// Entry by entry, in the same order of k.
void subtract_entries(const double* a, const double* b, std::size_t stride, int depth, int rows, double* to) {
  for (int i = 0; i < rows; ++i) {
    double sum = 0.0;
    for (int k = 0; k < depth; ++k)
      sum += b[static_cast<std::size_t>(k) * stride] * a[static_cast<std::size_t>(k) * stride + i];
    to[i] -= sum;
  }
}

/// Columns [first, last) lose what the panel's columns [begin, end) take, from their diagonal down.
void subtract_panel(Front& front, int begin, int end, int first, int last) {
  const auto stride = static_cast<std::size_t>(front.size);
  const double* const panel = front.column(begin);
  int j = first;
  for (; j + 4 <= last; j += 4) {
    double* const to[4] = {front.column(j), front.column(j + 1), front.column(j + 2), front.column(j + 3)};
    int i = j;
    for (; i + 8 <= front.size; i += 8) {
      double* const at[4] = {to[0] + i, to[1] + i, to[2] + i, to[3] + i};
      subtract_block(panel + i, panel + j, stride, end - begin, at);
    }
    for (int c = 0; c < 4; ++c)
      subtract_entries(panel + i, panel + j + c, stride, end - begin, front.size - i, to[c] + i);
  }
  for (; j < last; ++j)
    subtract_entries(panel + j, panel + j, stride, end - begin, front.size - j, front.column(j) + j);
}

/// Factors the columns [begin, end), which have lost what those before take.
double factor_panel(Front& front, int begin, int end, const double* diagonal) {
  double least = std::numeric_limits<double>::infinity();
  for (int j = begin; j < end; ++j) {
    double* const column = front.column(j);
    for (int k = begin; k < j; ++k) {
      const double* const before = front.column(k);
      const double factor = before[j];
      for (int i = j; i < front.size; ++i) column[i] -= factor * before[i];
    }
    const double pivot = column[j];
    if (!(pivot > 0.0)) return -1.0;
    least = std::min(least, pivot / diagonal[j]);
    const double root = std::sqrt(pivot);
    column[j] = root;
    const double inverse = 1.0 / root;
    for (int i = j + 1; i < front.size; ++i) column[i] *= inverse;
  }
  return least;
}

}  // namespace

void Front::reset(int new_size) {
  size = new_size;
  entries.assign(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0);
}

double factor_front(Front& front, int width, const double* diagonal) {
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

}  // namespace batten
