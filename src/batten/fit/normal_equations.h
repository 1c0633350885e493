/// \file The linear system of a fit: how the control points move so that weighted models of squared distances and an
/// energy are least.
#pragma once
#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

#include "batten/fit/squared_distance_model.h"
#include "batten/solve/solver.h"

namespace batten {

/// What the energy and the damping count.
struct Fairness {
  double all = 0.0;      ///< c
  double tangent = 0.0;  ///< t
  Scalars stiffness;     ///< of each control point: its row of T is times its root
  double damping = 0.0;  ///< m
};

/// Control points whose moves are given.
struct GivenMoves {
  Buffer<std::uint8_t> flags;  ///< one a control point; none where all are free
  Values moves;                ///< V-by-3, of those flagged
};

/// For rows J of weights (surface/surface_weights.h), forms M_i and offsets o_i of N places, an energy matrix K, and
/// control points P:
///
///     (sum_i J_i^T M_i J_i + c K + t S T K T S + m D) x = sum_i J_i^T M_i o_i - c K P - t S^2 T K P
///
/// T projects each control point's move onto the tangent plane of its vertex: there the energy counts more, so that the
/// parameters stay even while the shape follows the points. S has the roots of the control points' stiffness.
/// J_i takes control points to place i, the same for x, y and z, so that the matrix is of 3-by-3 blocks, each of them
/// symmetric. D is the mean diagonal of the sum: m holds points still that nothing pulls. Built for a connectivity.
class NormalEquations {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// energy: V-by-V. It has an entry for each pair of control points that share a face's surface, as SurfaceEnergy's
  /// matrices have.
  explicit NormalEquations(const Matrix& energy);

  const Matrix& energy() const { return energy_; }
  /// Another energy with its entries in the same places.
  void set_energy(const Matrix& energy) { energy_ = energy; }

  /// rows: N-by-V; forms: N, weights included. O(N n^2) for n weights a row. Threaded.
  void assemble(const Matrix& rows, std::span<const Form> forms, const Points& offsets);

  /// x, V-by-3, by conjugate gradients until their residual is `tolerance` of the first. control: P; normals: V-by-3,
  /// of unit length or zero. Where moves are given, the others are found that suit them.
  Values solve(const Values& control, const Values& normals, const Fairness& fairness, const StopRule& stop,
               SolveReport& report, const GivenMoves& given = {}) const;

 private:
  void multiply_blocks(const Values& x, double fairness, double own, Values& y) const;

  std::vector<Eigen::Matrix3d> invert_diagonal(const Values& normals, const Fairness& fairness, double own) const;

  Matrix energy_;
  Buffer<Form> blocks_;  ///< of the sum, an entry of K each
  Values right_;
  double mean_diagonal_ = 0.0;
};

}  // namespace batten
