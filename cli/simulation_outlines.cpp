#include "cli/simulation_outlines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "batten/mesh/primitives.h"

namespace batten::cli {
namespace {

using Eigen::RowVector3d;

void add_mesh(const Mesh& added, Mesh& lines) {
  const Index first = lines.vertex_count();
  Points both(first + added.vertex_count(), 3);
  both << lines.points, added.points;
  lines.points = std::move(both);
  for (Index f = 0; f < added.face_count(); ++f) {
    for (Index c = added.face_offsets[f]; c < added.face_offsets[f + 1]; ++c)
      lines.face_vertices.push_back(first + added.face_vertices[c]);
    lines.face_offsets.push_back(static_cast<Index>(lines.face_vertices.size()));
  }
}

/// A grid on the plane, some wider than what lies over it.
Mesh plane_lines(const SceneObstacle& plane, const RowVector3d& low, const RowVector3d& high) {
  constexpr Index kCells = 6;
  constexpr double kWider = 0.6;
  const Eigen::Vector3d normal = plane.normal.normalized();
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = normal.cross(Eigen::Vector3d::Unit(least)).normalized();
  const Eigen::Vector3d v = normal.cross(u);
  const Eigen::Vector3d middle = 0.5 * (low + high).transpose();
  const Eigen::Vector3d center = middle - normal.dot(middle - plane.point) * normal;
  const auto reach = [&](const Eigen::Vector3d& axis) {
    return kWider * axis.cwiseAbs().dot((high - low).transpose());
  };
  const double size = std::max(reach(u), reach(v));
  Mesh lines = grid(kCells, kCells);
  for (Index i = 0; i < lines.vertex_count(); ++i) {
    const RowVector3d at = lines.points.row(i);
    lines.points.row(i) = (center + size * (at.x() * u + at.y() * v)).transpose();
  }
  return lines;
}

Mesh box_lines(const SceneObstacle& box) {
  Mesh lines = cube();
  const Eigen::Array3d half = 0.5 * (box.corner - box.point);
  const Eigen::Array3d middle = 0.5 * (box.corner + box.point);
  for (Index i = 0; i < lines.vertex_count(); ++i)
    lines.points.row(i) = (middle + half * lines.points.row(i).transpose().array()).matrix().transpose();
  return lines;
}

/// Circles of longitude and latitude.
Mesh sphere_lines(const SceneObstacle& sphere) {
  constexpr Index kAround = 24;
  constexpr Index kRings = 12;
  Mesh lines;
  lines.points.resize(kAround * (kRings + 1), 3);
  for (Index j = 0; j <= kRings; ++j) {
    const double tilt = EIGEN_PI * j / kRings;
    for (Index i = 0; i < kAround; ++i) {
      const double turn = 2.0 * EIGEN_PI * i / kAround;
      lines.points.row(j * kAround + i) =
          sphere.point.transpose() +
          sphere.radius * RowVector3d(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
      const Index next = j * kAround + (i + 1) % kAround;
      if (j % 2 == 0) lines.add_face({j * kAround + i, next});
      if (j < kRings && i % 2 == 0) lines.add_face({j * kAround + i, (j + 1) * kAround + i});
    }
  }
  return lines;
}

}  // namespace

Mesh outlines_of(const ElasticRun& run, const Points& positions, double time, const RowVector3d& low,
                 const RowVector3d& high) {
  Mesh lines;
  lines.points.resize(0, 3);
  for (const SceneForce& force : run.scene().forces) {
    const auto* obstacle = std::get_if<SceneObstacle>(&force);
    if (obstacle == nullptr) continue;
    if (obstacle->kind == SceneObstacle::Kind::Plane) add_mesh(plane_lines(*obstacle, low, high), lines);
    if (obstacle->kind == SceneObstacle::Kind::Sphere) add_mesh(sphere_lines(*obstacle), lines);
    if (obstacle->kind == SceneObstacle::Kind::Box) add_mesh(box_lines(*obstacle), lines);
  }
  Mesh springs;
  springs.points = run.spring_lines(positions, time);
  for (Index i = 0; i + 1 < springs.vertex_count(); i += 2) springs.add_face({i, i + 1});
  add_mesh(springs, lines);
  return lines;
}

}  // namespace batten::cli
