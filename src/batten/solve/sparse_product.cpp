#include "batten/solve/sparse_product.h"

#include <algorithm>

#include "batten/buffer.h"
#include "batten/double4.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// One load and one addition an entry; two alternating sums let an addition start before the previous one has ended.
/// weight(e): of the pattern's entry e.
template <typename Weight>
void multiply_rows(const Matrix& pattern, const Weight& weight, const Values& values, Values& result) {
  constexpr std::ptrdiff_t kRowBlock = 512;
  Buffer<Double4> points(static_cast<std::size_t>(values.rows()));
  parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) points[i] = Double4{values(i, 0), values(i, 1), values(i, 2), 0.0};
  });
  result.resize(pattern.rows(), 3);
  const int* const columns = pattern.innerIndexPtr();
  parallel_for(
      pattern.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          Double4 even{};
          Double4 odd{};
          int e = pattern.outerIndexPtr()[row];
          const int last = pattern.outerIndexPtr()[row + 1];
          for (; e + 1 < last; e += 2) {
            even += weight(e) * points[columns[e]];
            odd += weight(e + 1) * points[columns[e + 1]];
          }
          if (e < last) even += weight(e) * points[columns[e]];
          even += odd;
          for (int c = 0; c < 3; ++c) result(row, c) = even[c];
        }
      },
      kRowBlock);
}

}  // namespace

void multiply(const Matrix& matrix, const Values& values, Values& result) {
  const double* const weights = matrix.valuePtr();
  multiply_rows(
      matrix, [weights](int e) { return weights[e]; }, values, result);
}

bool same_pattern(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.rows() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

void multiply_sum(const Matrix& a, double factor, const Matrix& b, const Values& values, Values& result) {
  const double* const first = a.valuePtr();
  const double* const second = b.valuePtr();
  multiply_rows(
      a, [=](int e) { return first[e] + factor * second[e]; }, values, result);
}

}  // namespace batten
