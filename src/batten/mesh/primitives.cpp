#include "batten/mesh/primitives.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "batten/error.h"

namespace batten {
namespace {

constexpr double kPhi = std::numbers::phi;

void set_points(Mesh& mesh, std::initializer_list<std::array<double, 3>> points) {
  mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::Index row = 0;
  for (const auto& point : points) mesh.points.row(row++) << point[0], point[1], point[2];
}

/// Throws Error(TooLarge) if a by b quads have more corners than a 32-bit index can count.
void check_size(Index a, Index b) {
  const double corners = 4.0 * static_cast<double>(a) * static_cast<double>(b);
  if (corners > static_cast<double>(std::numeric_limits<Index>::max()))
    throw Error(ErrorCode::TooLarge, "a grid of " + std::to_string(a) + " by " + std::to_string(b) +
                                         " quads has more corners than a 32-bit index can count; ask for fewer");
}

/// The dual has a vertex for each face of the solid and a face for each vertex. Its corners are sorted by angle around
/// the vertex, which points outwards, so its faces run counter-clockwise. Only for solids centred on the origin.
Mesh dual_of_solid(const Mesh& solid) {
  const Index size = solid.face_size(0);
  Points centres = Points::Zero(solid.face_count(), 3);
  for (Index f = 0; f < solid.face_count(); ++f) {
    for (Index c = 0; c < size; ++c) centres.row(f) += solid.points.row(solid.face_vertices[f * size + c]) / size;
  }
  Mesh dual;
  dual.points = centres;
  for (Index v = 0; v < solid.vertex_count(); ++v) {
    const Eigen::Vector3d axis = solid.points.row(v).normalized();
    const Eigen::Vector3d first = axis.unitOrthogonal();
    const Eigen::Vector3d second = axis.cross(first);
    std::vector<std::pair<double, Index>> ring;
    for (Index corner = 0; corner < static_cast<Index>(solid.face_vertices.size()); ++corner) {
      if (solid.face_vertices[corner] != v) continue;
      const Eigen::Vector3d centre = centres.row(corner / size);
      ring.emplace_back(std::atan2(centre.dot(second), centre.dot(first)), corner / size);
    }
    std::sort(ring.begin(), ring.end());
    for (const auto& [angle, face] : ring) dual.face_vertices.push_back(face);
    dual.face_offsets.push_back(static_cast<Index>(dual.face_vertices.size()));
  }
  return dual;
}

}  // namespace

Mesh tetrahedron() {
  Mesh mesh;
  set_points(mesh, {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}});
  mesh.add_face({0, 1, 3});
  mesh.add_face({0, 2, 1});
  mesh.add_face({0, 3, 2});
  mesh.add_face({1, 2, 3});
  return mesh;
}

Mesh cube() {
  Mesh mesh;
  set_points(mesh,
             {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  mesh.add_face({0, 3, 2, 1});
  mesh.add_face({4, 5, 6, 7});
  mesh.add_face({0, 1, 5, 4});
  mesh.add_face({1, 2, 6, 5});
  mesh.add_face({2, 3, 7, 6});
  mesh.add_face({3, 0, 4, 7});
  return mesh;
}

Mesh octahedron() {
  Mesh mesh;
  set_points(mesh, {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  const Index ring[4] = {0, 2, 1, 3};
  for (int i = 0; i < 4; ++i) {
    mesh.add_face({ring[i], ring[(i + 1) % 4], 4});
    mesh.add_face({ring[(i + 1) % 4], ring[i], 5});
  }
  return mesh;
}

Mesh icosahedron() {
  Mesh mesh;
  set_points(mesh, {{0, 1, kPhi},
                    {0, -1, kPhi},
                    {0, 1, -kPhi},
                    {0, -1, -kPhi},
                    {kPhi, 0, 1},
                    {kPhi, 0, -1},
                    {-kPhi, 0, 1},
                    {-kPhi, 0, -1},
                    {1, kPhi, 0},
                    {-1, kPhi, 0},
                    {1, -kPhi, 0},
                    {-1, -kPhi, 0}});
  // Three vertices at distance 2 from each other bound a face.
  const auto is_edge = [&](Index a, Index b) { return (mesh.points.row(a) - mesh.points.row(b)).norm() < 2.5; };
  for (Index a = 0; a < 12; ++a) {
    for (Index b = a + 1; b < 12; ++b) {
      for (Index c = b + 1; c < 12; ++c) {
        if (!is_edge(a, b) || !is_edge(b, c) || !is_edge(c, a)) continue;
        const Eigen::Vector3d p = mesh.points.row(a);
        const Eigen::Vector3d q = mesh.points.row(b);
        const Eigen::Vector3d r = mesh.points.row(c);
        if (p.dot(q.cross(r)) > 0.0) {
          mesh.add_face({a, b, c});
        } else {
          mesh.add_face({a, c, b});
        }
      }
    }
  }
  return mesh;
}

Mesh dodecahedron() {
  Mesh mesh = dual_of_solid(icosahedron());
  // The centres of the icosahedron's faces are phi^2 / 3 times the usual coordinates, which are 0, +-1/phi, +-1 or
  // +-phi. Taking the nearest of these removes the rounding error.
  const double classic[4] = {0.0, 1.0 / kPhi, 1.0, kPhi};
  for (Eigen::Index i = 0; i < mesh.points.size(); ++i) {
    double& x = mesh.points.data()[i];
    const double scaled = std::abs(x) * 3.0 / (kPhi * kPhi);
    double nearest = classic[0];
    for (const double value : classic) {
      if (std::abs(value - scaled) < std::abs(nearest - scaled)) nearest = value;
    }
    x = std::copysign(nearest, nearest == 0.0 ? 1.0 : x);
  }
  return mesh;
}

Mesh torus(Index around, Index across, double radius, double tube_radius) {
  if (around < 3 || across < 3)
    throw Error(ErrorCode::BadArgument, "a torus needs at least 3 quads around and 3 across");
  if (!(tube_radius > 0.0 && tube_radius < radius && std::isfinite(radius)))
    throw Error(ErrorCode::BadArgument, "a torus needs 0 < tube_radius < radius");
  check_size(around, across);
  Mesh mesh;
  mesh.points.resize(static_cast<Eigen::Index>(around) * across, 3);
  for (Index i = 0; i < around; ++i) {
    const double u = 2.0 * std::numbers::pi * i / around;
    for (Index j = 0; j < across; ++j) {
      const double v = 2.0 * std::numbers::pi * j / across;
      const double distance = radius + tube_radius * std::cos(v);
      mesh.points.row(i * across + j) << distance * std::cos(u), distance * std::sin(u), tube_radius * std::sin(v);
      const Index next = (i + 1) % around * across;
      mesh.add_face({i * across + j, next + j, next + (j + 1) % across, i * across + (j + 1) % across});
    }
  }
  return mesh;
}

Mesh grid(Index nx, Index ny) {
  if (nx < 1 || ny < 1) throw Error(ErrorCode::BadArgument, "a grid needs at least 1 by 1 quads");
  check_size(nx, ny);
  Mesh mesh;
  const Index stride = nx + 1;
  mesh.points.resize(static_cast<Eigen::Index>(stride) * (ny + 1), 3);
  for (Index j = 0; j <= ny; ++j) {
    for (Index i = 0; i <= nx; ++i) mesh.points.row(j * stride + i) << -1.0 + 2.0 * i / nx, -1.0 + 2.0 * j / ny, 0.0;
  }
  for (Index j = 0; j < ny; ++j) {
    for (Index i = 0; i < nx; ++i) {
      const Index corner = j * stride + i;
      mesh.add_face({corner, corner + 1, corner + stride + 1, corner + stride});
    }
  }
  return mesh;
}

}  // namespace batten
