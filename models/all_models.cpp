#include <cmath>
#include <random>
#include <utility>

#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "shapes.h"

namespace batten::models {

namespace {

/// Rounding keeps far more digits than a picture shows and makes the text independent of the last bits of sine and
/// cosine.
constexpr double kGrain = 1e4;

/// Adding zero turns -0 into 0.
void round_points(Points& points, double grain) { points = (points * grain).array().round() / grain + 0.0; }

}  // namespace

/// Sums of whole random numbers are equal on every machine.
void add_noise(Points& points, double deviation) {
  std::mt19937 random(1);
  for (Index v = 0; v < points.rows(); ++v) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 8) / (1 << 24);
      points(v, c) += deviation * (sum - 6.0);
    }
  }
}

/// The noise has a deviation of a twentieth of a unit cell.
Mesh bracket_scan() {
  const Mesh control = bracket();
  const Topology topology(control);
  Mesh scan = refine_mesh(topology, choose_scheme(control), control, 2).mesh;
  scan.creases.clear();
  add_noise(scan.points, 0.012);
  return scan;
}

Mesh dented_cube() {
  constexpr Index kCorner = 6;
  Mesh mesh = cube();
  mesh.points.row(kCorner) *= 0.2;
  return mesh;
}

Mesh pyramid() {
  Mesh mesh;
  mesh.points.resize(5, 3);
  mesh.points << -1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 2.5;
  for (Index i = 0; i < 4; ++i) mesh.add_face({i, (i + 1) % 4, 4});
  mesh.add_face({0, 2, 1});
  mesh.add_face({0, 3, 2});
  return mesh;
}

std::vector<Model> all_models() {
  std::vector<Model> models = {{"pipe-joint", pipe_joint()},     {"coarse-joint", coarse_joint()},
                               {"pyramid", pyramid()},           {"tripod", tripod()},
                               {"torus-knot", torus_knot()},     {"bracket", bracket()},
                               {"creature", creature()},         {"bracket-scan", bracket_scan()},
                               {"tetrahedron", tetrahedron()},   {"cube", cube()},
                               {"dented-cube", dented_cube()},   {"octahedron", octahedron()},
                               {"dodecahedron", dodecahedron()}, {"icosahedron", icosahedron()}};
  for (Model& model : models) round_points(model.mesh.points, model.mesh.vertex_count() <= 20 ? 1e6 : kGrain);
  return models;
}

std::vector<Model> morph_models() {
  Mesh ball = ball_of(creature(), 3.0);
  round_points(ball.points, kGrain);
  return {{"creature-ball", std::move(ball)}};
}

std::vector<Model> broken_models() {
  for (const Model& model : all_models()) {
    if (model.name != "tripod") continue;
    Mesh scan = tripod_scan(model.mesh);
    round_points(scan.points, kGrain);
    return {{"broken-tripod", broken_tripod(model.mesh)}, {"tripod-scan", std::move(scan)}};
  }
  return {};
}

}  // namespace batten::models
