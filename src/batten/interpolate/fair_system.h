/// \file The unknowns of a fair surface: what is left of the control points once the targets' equations hold.
///
/// On the refined mesh A_i P = z_i has one original vertex, i itself: P_i = (z_i - sum over others of a_ij P_j) / a_ii.
/// So P = T y + C q, where y are the unknowns: the control points of new vertices and, where the surface need not pass
/// through the targets, the positions z_i themselves; else z = q.
#pragma once
#include <Eigen/SparseCore>

#include "batten/energy/shape_energy.h"
#include "batten/interpolate/fair_normals.h"
#include "batten/limit/limit_matrix.h"
#include "batten/solve/solver.h"

namespace batten {

/// Built for a connectivity and the kind of unknowns.
class FairSystem {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// limit: of the mesh refined once or more. Vertices below original_count are those of the mesh given.
  /// position_weights: empty where the surface passes through the targets; else one for each of them, what a squared
  /// distance counts.
  FairSystem(const LimitMatrix& limit, Index original_count, Scalars position_weights);

  const Matrix& to_control() const { return to_control_; }  ///< T

  /// y of control points; the surface through the targets forgets where they have the original vertices.
  Values unknowns(ConstValuesRef control) const;
  /// T y + C q.
  Values control(const Values& unknowns, ConstValuesRef targets) const;

  /// What minimise() came to: p^T K p plus the weighted squares of distances to the targets.
  struct Least {
    double start;
    double end;
    SolveReport solve;
  };
  /// Makes that sum least over the unknowns that keep the normals. energy: K, which is given up early to save memory.
  /// unknowns: the start and the result.
  Least minimise(Matrix energy, ConstValuesRef targets, const FairNormals& normals, const StopRule& stop,
                 Values& unknowns) const;

 private:
  Matrix to_control_;
  Matrix transposed_;
  Buffer<double> target_factors_;  ///< C: 1/a_ii of each original vertex whose position is given, else empty
  Buffer<Index> unknown_of_;       ///< of each vertex, or -1
  Scalars position_weights_;
};

}  // namespace batten
