/// \file Sparse matrices as arrays.
#pragma once
#include <Eigen/SparseCore>

#include "native/arrays.h"

namespace batten::python {

/// Data, columns, row starts and shape, as scipy.sparse.csr_array takes them.
inline py::tuple sparse_of(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix) {
  const auto entries = matrix.nonZeros();
  return py::make_tuple(array_of(Buffer<double>(matrix.valuePtr(), matrix.valuePtr() + entries)),
                        array_of(Buffer<Index>(matrix.innerIndexPtr(), matrix.innerIndexPtr() + entries)),
                        array_of(Buffer<Index>(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows() + 1)),
                        py::make_tuple(matrix.rows(), matrix.cols()));
}

}  // namespace batten::python
