#include "batten/solve/sparse_product.h"

#include "batten/parallel/parallel.h"

namespace batten {

void multiply(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix, const Values& values, Values& result) {
  constexpr std::ptrdiff_t kRowBlock = 512;
  result.resize(matrix.rows(), 3);
  parallel_for(
      matrix.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
          for (int i = matrix.outerIndexPtr()[row]; i < matrix.outerIndexPtr()[row + 1]; ++i) {
            sum += matrix.valuePtr()[i] * values.row(matrix.innerIndexPtr()[i]).head<3>();
          }
          result.row(row) = sum;
        }
      },
      kRowBlock);
}

}  // namespace batten
