/// \file Energies of a face whose child at one corner has the face's own surroundings again: sums over all levels.
#pragma once
#include <Eigen/Core>

#include "batten/energy/energy_kind.h"

namespace batten {

/// The matrix K of such a face, K = s (L + C^T K C): `rest` is the sum L over the other children, by the face's points;
/// `step` is C, the points of the child at the corner; s is child_scale(). Both N-by-N; rows of C sum to 1.
///
/// K = s sum_k s^k (C^k)^T L C^k, which doubling sums to rounding. Mass and membrane always converge. The thin plate's
/// energy of an eigenvector of C grows with 4 lambda^2 a level: where the largest lambda below 1 is less than 1/2 the
/// sum is the integral, too; otherwise the integral does not exist. Then the eigenvectors of the tangent plane, those
/// whose eigenvalue is at least t, are given no energy, and the levels count with t^-2 instead of 4, as they do in the
/// parameters of the characteristic map: t is the second largest eigenvalue below 1 (at a smooth interior vertex the
/// largest two are equal), and at least 1/2. At a regular vertex t is 1/2 and nothing changes.
///
/// Symmetric, positive semidefinite where L is; membrane and thin plate have no energy of constants.
/// O(N^3 log levels). Throws Error(NotConverged), which no step of a subdivision scheme should cause.
Eigen::MatrixXd level_sum(EnergyKind kind, const Eigen::MatrixXd& rest, const Eigen::MatrixXd& step);

/// Makes the rows and columns of a symmetric matrix sum to zero by changing the first of each; of a matrix whose sums
/// should be zero that takes away rounding alone. Then the energy sees differences of points only, and rounding does
/// not grow with the levels.
void remove_constants(Eigen::MatrixXd& matrix);

}  // namespace batten
