/// \file The matrix of a quadratic form in other unknowns.
#pragma once
#include <Eigen/SparseCore>

namespace batten {

/// form: K, symmetric. map: T, from the new unknowns to those of K. Returns T^T K T: both triangles, columns ascending,
/// the whole diagonal among its entries. Threaded; the result does not depend on the number of threads. O(products),
/// about 2 nanoseconds each. Throws Error(TooLarge) for 2^31 entries and more.
Eigen::SparseMatrix<double, Eigen::RowMajor> congruence(const Eigen::SparseMatrix<double, Eigen::RowMajor>& form,
                                                        const Eigen::SparseMatrix<double, Eigen::RowMajor>& map);

}  // namespace batten
