#include "batten/fit/start_sphere.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "batten/refine/refined_values.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

/// Of the longest half axis.
constexpr double kLeastAxis = 0.01;
/// Points that are not farther from a line or a plane than this, of half their length, are on it.
constexpr double kOnIt = 1e-9;

/// The principal axes of points around their mean, in columns, right-handed.
Eigen::Matrix3d principal_axes(ConstValuesRef points) {
  const Eigen::RowVector3d mean = points.colwise().mean();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::RowVector3d offset = points.row(i) - mean;
    spread += offset.transpose() * offset;
  }
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  return axes;
}

}  // namespace

Mesh unit_sphere(SchemeKind kind, Index vertices) {
  Scheme scheme;
  scheme.kind = kind;
  const Mesh solid = kind == SchemeKind::CatmullClark ? cube() : octahedron();
  RefinedSurface refined = refine(Topology(solid), scheme, solid.points, 2);
  while (refined_vertex_count(refined.topology, kind) <= vertices)
    refined = refine(refined.topology, scheme, refined.values, 1);
  Mesh mesh = mesh_from_topology(refined.topology);
  mesh.points = refined.values;
  mesh.points.rowwise().normalize();
  return mesh;
}

PointEllipsoid ellipsoid_around(ConstValuesRef points) {
  const Eigen::Matrix3d axes = principal_axes(points);
  const Points along = points * axes;
  const Eigen::RowVector3d low = along.colwise().minCoeff();
  const Eigen::RowVector3d high = along.colwise().maxCoeff();
  Eigen::RowVector3d half = 0.5 * (high - low);
  // Ascending, as the axes are.
  if (!(half[1] > kOnIt * half[2]))
    throw Error(ErrorCode::BadArgument, "the points are on one line: a sphere around them has no surface to move");
  if (!(half[0] > kOnIt * half[2]))
    throw Error(ErrorCode::BadArgument,
                "the points are in one plane: a sphere around them would be pressed flat and fold; start without one, "
                "from a mesh that is found");
  half = half.cwiseMax(kLeastAxis * half.maxCoeff());
  return {axes, 0.5 * (low + high), half};
}

Mesh start_sphere(ConstValuesRef points, SchemeKind kind) {
  const PointEllipsoid around = ellipsoid_around(points);
  Mesh mesh = unit_sphere(kind);
  const Points placed = mesh.points * around.half.asDiagonal();
  mesh.points = (placed.rowwise() + around.middle) * around.axes.transpose();
  return mesh;
}

}  // namespace batten
