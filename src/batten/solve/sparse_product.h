/// \file A sparse matrix times points.
#pragma once
#include <Eigen/SparseCore>

#include "batten/types.h"

namespace batten {

/// result = matrix * values, of three columns; resized, and another object than the values. The columns of each row of
/// the matrix ascend, as Eigen keeps them. Rows in parallel; the result does not depend on the number of threads.
void multiply(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix, const Values& values, Values& result);

/// Whether the matrices, compressed, have their entries in the same places.
bool same_pattern(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a,
                  const Eigen::SparseMatrix<double, Eigen::RowMajor>& b);

/// result = (a + factor b) values, without the sum; as multiply(). The matrices have the same pattern.
void multiply_sum(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a, double factor,
                  const Eigen::SparseMatrix<double, Eigen::RowMajor>& b, const Values& values, Values& result);

}  // namespace batten
