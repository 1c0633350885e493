#include "batten/solve/sparse_product.h"

#include "batten/buffer.h"
#include "batten/double4.h"
#include "batten/parallel/parallel.h"

namespace batten {

/// One load and one addition an entry; two alternating sums let an addition start before the previous one has ended.
void multiply(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix, const Values& values, Values& result) {
  constexpr std::ptrdiff_t kRowBlock = 512;
  Buffer<Double4> points(static_cast<std::size_t>(values.rows()));
  parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) points[i] = Double4{values(i, 0), values(i, 1), values(i, 2), 0.0};
  });
  result.resize(matrix.rows(), 3);
  const int* const columns = matrix.innerIndexPtr();
  const double* const weights = matrix.valuePtr();
  parallel_for(
      matrix.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          Double4 even{};
          Double4 odd{};
          int e = matrix.outerIndexPtr()[row];
          const int last = matrix.outerIndexPtr()[row + 1];
          for (; e + 1 < last; e += 2) {
            even += weights[e] * points[columns[e]];
            odd += weights[e + 1] * points[columns[e + 1]];
          }
          if (e < last) even += weights[e] * points[columns[e]];
          even += odd;
          for (int c = 0; c < 3; ++c) result(row, c) = even[c];
        }
      },
      kRowBlock);
}

}  // namespace batten
