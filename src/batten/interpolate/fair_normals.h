/// \file Wanted normals as linear conditions on the unknowns of a fair surface.
///
/// Two tangents t_1, t_2 of the surface at a vertex are sums of the control points around it. They are perpendicular to
/// n where n . t_k = 0: two conditions on the heights n . P_j. After two refinements no control point has a say in the
/// tangents at two original vertices, so that each vertex's conditions can be met by itself.
#pragma once
#include <Eigen/SparseCore>
#include <vector>

#include "batten/buffer.h"
#include "batten/limit/limit_matrix.h"
#include "batten/types.h"

namespace batten {

/// The conditions of all vertices. Default: none.
class FairNormals {
 public:
  FairNormals() = default;
  /// limit: of the mesh refined twice. normals: V-by-3, zero rows for none; vertices without exactly one normal are
  /// left out. to_control, constant: control points by unknowns, as FairSystem has them.
  FairNormals(const LimitMatrix& limit, ConstValuesRef normals,
              const Eigen::SparseMatrix<double, Eigen::RowMajor>& to_control, const Values& constant);

  bool empty() const { return conditions_.empty(); }
  Index count() const { return static_cast<Index>(conditions_.size()); }
  /// Vertices whose condition holds.
  const Buffer<Index>& vertices() const { return vertices_; }

  /// Moves the unknowns to the nearest that meet the conditions.
  void meet(Values& unknowns) const;
  /// Takes from a step of the unknowns what would break them: an orthogonal projection.
  void project(Values& step) const;

 private:
  struct Condition {
    Eigen::RowVector3d normal;
    std::vector<Index> columns;  ///< of unknowns
    Eigen::MatrixXd rows;        ///< two, orthonormal
    Eigen::VectorXd values;      ///< what rows * heights shall be
  };
  void move(Values& unknowns, double values_factor) const;

  std::vector<Condition> conditions_;
  Buffer<Index> vertices_;
};

}  // namespace batten
