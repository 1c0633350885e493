/// \file Wanted normals as linear conditions on the unknowns of a fair surface.
///
/// Two tangents t_1, t_2 of the surface at a vertex are sums of the control points around it. They are perpendicular to
/// n where n . t_k = 0: two conditions on the heights n . P_j. After two refinements no control point has a say in the
/// tangents at two original vertices, so that each vertex's conditions can be met by itself.
///
/// The normal may then be -n. Where it is, the tangents themselves are wanted: four conditions more.
#pragma once
#include <Eigen/Core>
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

  /// The conditions as rows C of unknowns: C x, two rows a condition, each three numbers in the directions that count.
  /// The rows of a condition are orthonormal; no two conditions share an unknown.
  Values rows(const Values& unknowns) const;
  /// result += C^T multipliers.
  void add_transposed(const Values& multipliers, Values& result) const;
  /// Of each condition, the inverse of its rows' product R H^-1 R^T where all other unknowns stay: how stiff its
  /// tangents are. H: over the unknowns, symmetric and positive definite.
  std::vector<Eigen::Matrix2d> stiffness(const Eigen::SparseMatrix<double, Eigen::RowMajor>& h) const;

  /// Wherever these unknowns have the normal -n, the tangents of `model`, turned so that their normal is n, become
  /// conditions. Returns at how many vertices.
  Index hold_opposed(const Values& unknowns, const Values& model);

 private:
  using Tangents = Eigen::Matrix<double, 2, 3>;
  using Rows = Eigen::Matrix<double, 2, Eigen::Dynamic>;
  struct Condition {
    Eigen::RowVector3d normal;
    std::vector<Index> columns;  ///< of unknowns
    Rows rows;                   ///< orthonormal
    Eigen::Matrix2d to_rows;     ///< tangents = to_rows^-1 (rows * unknowns) + constant
    Tangents constant;
    Tangents values;             ///< what rows * unknowns shall be, in the directions that count:
    Eigen::Matrix3d directions;  ///< the projection onto n, or onto everything
  };
  static bool find_condition(const LimitMatrix& limit, Index vertex,
                             const Eigen::SparseMatrix<double, Eigen::RowMajor>& to_control, const Values& constant,
                             Condition& condition);
  static Tangents product(const Condition& condition, const Values& unknowns);
  static Tangents tangents(const Condition& condition, const Values& unknowns);
  void move(Values& unknowns, double values_factor) const;

  std::vector<Condition> conditions_;
  Buffer<Index> vertices_;
};

}  // namespace batten
