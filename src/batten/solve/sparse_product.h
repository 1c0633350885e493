/// \file A sparse matrix times points.
#pragma once
#include <Eigen/SparseCore>

#include "batten/types.h"

namespace batten {

/// result = matrix * values, of three columns; resized. Rows in parallel; the result does not depend on the number of
/// threads.
void multiply(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix, const Values& values, Values& result);

}  // namespace batten
