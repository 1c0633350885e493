#include <cmath>
#include <random>
#include <utility>

#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "shapes.h"

namespace batten::models {

/// Sums of whole random numbers are equal on every machine. The noise is approximately normal, with a deviation of a
/// twentieth of a unit cell.
Mesh bracket_scan() {
  constexpr double kDeviation = 0.012;
  const Mesh control = bracket();
  const Topology topology(control);
  Mesh scan = refine_mesh(topology, choose_scheme(control), control, 2).mesh;
  scan.creases.clear();
  std::mt19937 random(1);
  for (Index v = 0; v < scan.vertex_count(); ++v) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 8) / (1 << 24);
      scan.points(v, c) += kDeviation * (sum - 6.0);
    }
  }
  return scan;
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
  std::vector<Model> models = {{"pipe-joint", pipe_joint()},   {"coarse-joint", coarse_joint()},
                               {"pyramid", pyramid()},         {"tripod", tripod()},
                               {"torus-knot", torus_knot()},   {"bracket", bracket()},
                               {"creature", creature()},       {"bracket-scan", bracket_scan()},
                               {"tetrahedron", tetrahedron()}, {"cube", cube()},
                               {"octahedron", octahedron()},   {"dodecahedron", dodecahedron()},
                               {"icosahedron", icosahedron()}};
  // Rounding keeps far more digits than a picture shows and makes the text independent of the last bits of sine and
  // cosine.
  constexpr double kGrain = 1e4;
  for (Model& model : models) {
    const double grain = model.mesh.vertex_count() <= 20 ? 1e6 : kGrain;
    // Adding zero turns -0 into 0.
    model.mesh.points = (model.mesh.points * grain).array().round() / grain + 0.0;
  }
  return models;
}

std::vector<Model> morph_models() {
  Mesh ball = ball_of(creature(), 3.0);
  ball.points = (ball.points * 1e4).array().round() / 1e4 + 0.0;
  return {{"creature-ball", std::move(ball)}};
}

std::vector<Model> broken_models() {
  for (const Model& model : all_models()) {
    if (model.name == "tripod") return {{"broken-tripod", broken_tripod(model.mesh)}};
  }
  return {};
}

}  // namespace batten::models
