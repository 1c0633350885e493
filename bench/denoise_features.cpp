/// Noise removal with and without sharp edges found in the noise: prints a table of docs/denoise.md.
///
///     denoise_features MESH...
///
/// Each mesh, and a sphere and a torus, gets noise on each coordinate. Errors are distances of the smoothed vertices
/// from the mesh without noise, in its mean edge lengths.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "batten/expand/denoise.h"
#include "batten/io/io.h"
#include "batten/mesh/face_triangles.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"

namespace {

using batten::Index;
using batten::Mesh;
using batten::Points;
using batten::Topology;

struct Shape {
  std::string name;
  Mesh mesh;
};

struct Errors {
  double rms = 0.0;
  double most = 0.0;
};

double segment_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double square = along.squaredNorm();
  const double place = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (a + place * along - p).norm();
}

double triangle_distance(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = normal.squaredNorm() > 0.0;
  double nearest = segment_distance(p, t[2], t[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& from = t[i];
    const Eigen::Vector3d& to = t[(i + 1) % 3];
    inside = inside && (to - from).cross(p - from).dot(normal) >= 0.0;
    nearest = std::min(nearest, segment_distance(p, from, to));
  }
  return inside ? std::abs((p - t[0]).dot(normal)) / normal.norm() : nearest;
}

/// Distances from the triangles within two rings of where each vertex was.
Errors errors_of(const Topology& topology, const Points& clean, const Points& points) {
  const batten::FaceTriangles triangles(topology, clean);
  Errors errors;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    std::vector<Index> faces;
    topology.for_each_outgoing(v, [&](Index h) {
      const Index f = topology.face(h);
      for (Index k = topology.face_begin(f); k < topology.face_end(f); ++k) {
        topology.for_each_outgoing(topology.origin(k), [&](Index out) { faces.push_back(topology.face(out)); });
      }
    });
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    double nearest = faces.empty() ? 0.0 : 1e300;
    for (const Index f : faces) {
      for (Index k = 0; k + 2 < topology.face_size(f); ++k) {
        const std::array<Index, 3> corners = triangles.vertices(f, k);
        nearest = std::min(nearest, triangle_distance(points.row(v).transpose(), {clean.row(corners[0]).transpose(),
                                                                                  clean.row(corners[1]).transpose(),
                                                                                  clean.row(corners[2]).transpose()}));
      }
    }
    errors.rms += nearest * nearest;
    errors.most = std::max(errors.most, nearest);
  }
  errors.rms = std::sqrt(errors.rms / topology.vertex_count());
  return errors;
}

Mesh sphere() {
  const Mesh mesh = batten::icosahedron();
  const batten::RefinedSurface refined = batten::refine(Topology(mesh), {batten::SchemeKind::Loop}, mesh.points, 4);
  Mesh fine = batten::mesh_from_topology(refined.topology);
  fine.points = refined.values;
  fine.points.rowwise().normalize();
  return fine;
}

/// A coarse model stands for its refinement.
Mesh fine_mesh(const std::string& path) {
  constexpr Index kFine = 2000;
  Mesh mesh = batten::read_mesh(path);
  const int levels = mesh.vertex_count() < kFine ? 2 : 0;
  Mesh fine = batten::refine_mesh(Topology(mesh), batten::choose_scheme(mesh), mesh, levels).mesh;
  fine.creases.clear();  // they are to be found
  fine.corners.clear();
  return fine;
}

void print_row(const Shape& shape, double share) {
  const Topology topology(shape.mesh);
  const double edge = batten::edge_lengths(topology, shape.mesh.points).mean;
  Points noisy = shape.mesh.points;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, share * edge);
  for (double& coordinate : noisy.reshaped()) coordinate += normal(random);
  std::printf("| %s, %d vertices | %.2g |", shape.name.c_str(), shape.mesh.vertex_count(), share);
  for (const double degrees : {0.0, 40.0, 30.0}) {
    batten::DenoiseOptions options;
    options.automatic = true;
    options.features = degrees > 0.0;
    if (options.features) options.feature_options.degrees = degrees;
    const batten::DenoiseResult result = batten::denoise(topology, batten::choose_scheme(shape.mesh), noisy, options);
    const Errors errors = errors_of(topology, shape.mesh.points, result.points);
    std::printf(" %.3f, %.2f", errors.rms / edge, errors.most / edge);
    if (options.features) std::printf(" (%zu edges)", result.features.size());
    std::printf(" |");
    std::fflush(stdout);
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Shape> shapes;
  for (int i = 1; i < argc; ++i) {
    const std::string path = argv[i];
    const std::string file = path.substr(path.find_last_of('/') + 1);
    shapes.push_back({file.substr(0, file.find('.')), fine_mesh(path)});
  }
  shapes.push_back({"sphere", sphere()});
  shapes.push_back({"torus", batten::torus(80, 40)});
  std::printf("| shape | noise | `--auto` | `--features 40` | `--features 30` |\n| --- | --- | --- | --- | --- |\n");
  for (const Shape& shape : shapes) {
    for (const double share : {0.05, 0.1, 0.2, 0.4}) print_row(shape, share);
  }
  return 0;
}
