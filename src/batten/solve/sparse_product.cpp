#include "batten/solve/sparse_product.h"

#include <algorithm>
#include <cstring>

#include "batten/double4.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A row of three numbers, and one of the next row, which counts nothing.
Double4 row_and_next(const double* row) {
  Double4 four;
  std::memcpy(&four, row, sizeof(four));
  return four;
}

/// One load and one addition an entry; two alternating sums let an addition start before the previous one has ended.
/// weight(e): of the pattern's entry e. The last row of the values has no next one. Columns ascend, so that only the
/// last entry of a row can have it.
template <typename Weight>
void multiply_rows(const Matrix& pattern, const Weight& weight, const Values& values, Values& result) {
  constexpr std::ptrdiff_t kRowBlock = 512;
  result.resize(pattern.rows(), 3);
  const int* const columns = pattern.innerIndexPtr();
  const double* const numbers = values.data();
  parallel_for(
      pattern.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        const auto of = [&](int e) { return numbers + 3 * static_cast<std::ptrdiff_t>(columns[e]); };
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          Double4 even{};
          Double4 odd{};
          int e = pattern.outerIndexPtr()[row];
          const int last = pattern.outerIndexPtr()[row + 1] - 1;
          for (; e + 1 < last; e += 2) {
            even += weight(e) * row_and_next(of(e));
            odd += weight(e + 1) * row_and_next(of(e + 1));
          }
          if (e < last) even += weight(e) * row_and_next(of(e));
          if (e <= last) {
            const double* const at = of(last);
            (e < last ? odd : even) += weight(last) * Double4{at[0], at[1], at[2], 0.0};
          }
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
