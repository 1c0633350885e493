#include "batten/mesh/up_axis.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace batten {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The hull counter-clockwise, by Andrew's monotone chain.
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t floor = hull.size() + 1;
    for (const Vector2d& point : points) {
      while (hull.size() > floor && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
      hull.push_back(point);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += turn(Vector2d::Zero(), polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

bool contains(const std::vector<Vector2d>& hull, const Vector2d& point) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (turn(hull[i], hull[(i + 1) % hull.size()], point) < 0.0) return false;
  }
  return hull.size() > 2;
}

/// At most about `limit` finite points of the mesh, around the middle of their box and in units of its size, so that
/// no sum overflows.
Points sample(const Mesh& mesh, Index limit) {
  const bool has_faces = mesh.face_count() > 0;
  const auto count = has_faces ? static_cast<Index>(mesh.face_vertices.size()) : mesh.vertex_count();
  const Index stride = count / limit + 1;
  std::vector<Eigen::RowVector3d> found;
  for (Index i = 0; i < count; i += stride) {
    const Index vertex = has_faces ? mesh.face_vertices[i] : i;
    if (vertex >= 0 && vertex < mesh.vertex_count() && mesh.points.row(vertex).allFinite())
      found.emplace_back(mesh.points.row(vertex));
  }
  Points points(static_cast<Index>(found.size()), 3);
  for (std::size_t i = 0; i < found.size(); ++i) points.row(static_cast<Index>(i)) = found[i];
  if (found.empty()) return points;
  const Eigen::RowVector3d lowest = points.colwise().minCoeff();
  const Eigen::RowVector3d highest = points.colwise().maxCoeff();
  const Eigen::RowVector3d middle = 0.5 * lowest + 0.5 * highest;
  points.rowwise() -= middle;
  const double size = points.cwiseAbs().maxCoeff();
  return size > 0.0 ? Points(points / size) : points;
}

}  // namespace

UpFrame up_frame(UpAxis up) {
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  const Vector3d z = Vector3d::UnitZ();
  switch (up) {
    case UpAxis::X:
      return {y, z, x};
    case UpAxis::MinusX:
      return {y, -z, -x};
    case UpAxis::Y:
      return {x, -z, y};
    case UpAxis::MinusY:
      return {x, z, -y};
    case UpAxis::MinusZ:
      return {x, -y, -z};
    case UpAxis::Auto:
    case UpAxis::Z:
      break;
  }
  return {x, y, z};
}

Eigen::Matrix3d to_y_up(UpAxis up) {
  const UpFrame frame = up_frame(up);
  Eigen::Matrix3d turned;
  turned.row(0) = frame.right.transpose();
  turned.row(1) = frame.up.transpose();
  turned.row(2) = -frame.back.transpose();
  return turned.array() + 0.0;  // without negative zeros
}

double steadiness(const Points& points, UpAxis up) {
  constexpr double kFoot = 0.03;  // of the height
  if (points.rows() == 0) return 0.0;
  const UpFrame frame = up_frame(up);
  const Eigen::VectorXd heights = points * frame.up;
  const double lowest = heights.minCoeff();
  const double highest = heights.maxCoeff();
  Vector2d centre = Vector2d::Zero();
  std::vector<Vector2d> plan;
  std::vector<Vector2d> foot;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    plan.emplace_back(points.row(i).dot(frame.right), points.row(i).dot(frame.back));
    centre += plan.back() / static_cast<double>(points.rows());
    if (heights[i] <= lowest + kFoot * (highest - lowest)) foot.push_back(plan.back());
  }
  const std::vector<Vector2d> base = convex_hull(std::move(foot));
  const double whole = area(convex_hull(std::move(plan)));
  return whole > 0.0 && contains(base, centre) ? area(base) / whole : 0.0;
}

UpAxis guess_up_axis(const Mesh& mesh, UpAxis usual) {
  constexpr double kStands = 0.2;
  constexpr double kMore = 1.5;
  const UpAxis other = usual == UpAxis::Y ? UpAxis::Z : UpAxis::Y;
  const Points points = sample(mesh, 50000);
  const double on_other = steadiness(points, other);
  return on_other > kStands && on_other > kMore * steadiness(points, usual) ? other : usual;
}

}  // namespace batten
