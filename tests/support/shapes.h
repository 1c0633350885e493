/// \file Meshes that several rooms' tests need beside mesh/primitives.h.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten::test {

using Faces = std::vector<std::vector<Index>>;

/// Faces over `vertices` points on a helix: distinct, and no four in a plane.
inline Mesh mesh_of_faces(Index vertices, const Faces& faces) {
  Mesh mesh;
  mesh.points.resize(vertices, 3);
  for (Index v = 0; v < vertices; ++v) mesh.points.row(v) << std::cos(v), std::sin(v), 0.25 * v;
  for (const std::vector<Index>& face : faces) {
    mesh.face_vertices.insert(mesh.face_vertices.end(), face.begin(), face.end());
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  return mesh;
}

inline Faces faces_of(const Mesh& mesh) {
  Faces faces;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    faces.emplace_back(mesh.face_vertices.begin() + mesh.face_offsets[f],
                       mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
  }
  return faces;
}

/// The same points with other faces; tags are dropped.
inline Mesh with_faces(const Mesh& mesh, const Faces& faces) {
  Mesh changed = mesh_of_faces(mesh.vertex_count(), faces);
  changed.points = mesh.points;
  return changed;
}

/// Two n-gons back to back: every vertex has valence 2.
inline Mesh dihedron(Index n) {
  Faces faces(2);
  for (Index v = 0; v < n; ++v) {
    faces[0].push_back(v);
    faces[1].push_back(n - 1 - v);
  }
  return mesh_of_faces(n, faces);
}

/// An n-gon with a triangle on each side to either pole: the poles, vertices n and n + 1, have valence n.
inline Mesh bipyramid(Index n) {
  Faces faces;
  for (Index v = 0; v < n; ++v) {
    faces.push_back({v, (v + 1) % n, n});
    faces.push_back({(v + 1) % n, v, n + 1});
  }
  Mesh mesh = mesh_of_faces(n + 2, faces);
  for (Index v = 0; v < n; ++v) {
    const double angle = 2.0 * std::numbers::pi * v / n;
    mesh.points.row(v) << std::cos(angle), std::sin(angle), 0.0;
  }
  mesh.points.row(n) << 0.0, 0.0, 1.0;
  mesh.points.row(n + 1) << 0.0, 0.0, -1.0;
  return mesh;
}

/// A strip of quads around an annulus, open at both rims.
inline Mesh annulus(Index n) {
  Faces faces;
  for (Index v = 0; v < n; ++v) faces.push_back({2 * v, 2 * v + 1, 2 * ((v + 1) % n) + 1, 2 * ((v + 1) % n)});
  return mesh_of_faces(2 * n, faces);
}

inline Mesh without_face(const Mesh& mesh, Index face) {
  Faces faces = faces_of(mesh);
  faces.erase(faces.begin() + face);
  return with_faces(mesh, faces);
}

/// Each point moved by up to `amount` in each coordinate.
inline Mesh jittered(Mesh mesh, double amount, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-amount, amount);
  for (double& coordinate : mesh.points.reshaped()) coordinate += shift(random);
  return mesh;
}

/// The regular triangulation of a torus: vertex i * across + j, diagonals from (i, j) to (i + 1, j + 1).
inline Mesh triangle_torus(Index around, Index across) {
  const Mesh quads = torus(around, across);
  Faces faces;
  const auto vertex = [&](Index i, Index j) { return (i % around) * across + j % across; };
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < across; ++j) {
      faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return with_faces(quads, faces);
}

/// The convex hull of random points on the unit sphere, point by point: triangles, valences from 3 up.
inline Mesh random_hull(Index vertices, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Points points(vertices, 3);
  for (double& coordinate : points.reshaped()) coordinate = normal(random);
  points.rowwise().normalize();
  const auto volume = [&](const std::vector<Index>& f, Index v) {
    const Eigen::Vector3d a = points.row(f[1]) - points.row(f[0]);
    const Eigen::Vector3d b = points.row(f[2]) - points.row(f[0]);
    const Eigen::Vector3d c = points.row(v) - points.row(f[0]);
    return a.cross(b).dot(c);
  };
  Faces hull{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  if (volume(hull[0], 3) > 0.0) hull = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  for (Index v = 4; v < vertices; ++v) {
    Faces kept;
    std::set<std::pair<Index, Index>> rim;  // directed edges of the faces that v sees, less those with both faces seen
    for (const std::vector<Index>& face : hull) {
      if (volume(face, v) <= 0.0) {
        kept.push_back(face);
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        if (rim.erase({face[(i + 1) % 3], face[i]}) == 0) rim.insert({face[i], face[(i + 1) % 3]});
      }
    }
    for (const auto& edge : rim) kept.push_back({edge.first, edge.second, v});
    hull = std::move(kept);
  }
  Mesh mesh = mesh_of_faces(vertices, hull);
  mesh.points = points;
  return mesh;
}

/// Sharpness of every size on about half of the edges and a sixth of the vertices: whole, fractional, infinite.
inline Mesh with_random_tags(Mesh mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> sharpness(-3.0, 4.0);  // what falls below 0 is no tag
  const auto draw = [&] {
    const double value = sharpness(random);
    if (random() % 8 == 0) return std::round(value);
    return random() % 16 == 0 ? 10.0 : value;
  };
  const Topology topology(mesh);
  mesh.creases.clear();
  mesh.corners.clear();
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    const double value = draw();
    if (value > 0.0) mesh.creases.push_back({topology.origin(h), topology.destination(h), value});
  }
  for (Index v = 0; v < topology.vertex_count(); v += 3) {
    const double value = draw();
    if (value > 0.0) mesh.corners.push_back({v, value});
  }
  return mesh;
}

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// Closed and open, quads, triangles and larger polygons, valences 2 to 24, one and several components.
inline std::vector<NamedMesh> sample_meshes() {
  std::vector<NamedMesh> samples{{"tetrahedron", tetrahedron()},
                                 {"cube", cube()},
                                 {"octahedron", octahedron()},
                                 {"icosahedron", icosahedron()},
                                 {"dodecahedron", dodecahedron()},
                                 {"torus", torus(7, 5)},
                                 {"triangle torus", triangle_torus(7, 5)},
                                 {"grid", grid(4, 3)},
                                 {"single quad", grid(1, 1)},
                                 {"open cube", without_face(cube(), 0)},
                                 {"open dodecahedron", without_face(dodecahedron(), 3)},
                                 {"annulus", annulus(6)},
                                 {"dihedron", dihedron(5)},
                                 {"bipyramid", bipyramid(24)},
                                 {"random hull", random_hull(40, 1)}};
  Mesh mixed = mesh_of_faces(12, {{0, 1, 2}, {0, 2, 3, 4}, {2, 1, 5, 6, 7}, {8, 9, 10}});  // vertex 11 has no face
  samples.push_back({"mixed faces, two components, an isolated vertex", mixed});
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].mesh = jittered(samples[i].mesh, 0.05, 7);
  return samples;
}

/// Every sample under each scheme that takes it.
template <typename Visit>
void for_each_sample(const Visit& visit) {
  for (const NamedMesh& sample : sample_meshes()) {
    Scheme scheme;
    visit(sample.mesh, scheme, sample.name + " under Catmull-Clark");
    scheme.kind = SchemeKind::Loop;
    if (all_triangles(sample.mesh)) visit(sample.mesh, scheme, sample.name + " under Loop");
  }
}

}  // namespace batten::test
