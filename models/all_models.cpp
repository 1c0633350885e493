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

Mesh lifted_grid() {
  constexpr Index kSide = 8;
  Mesh mesh = grid(kSide, kSide);
  mesh.points(kSide / 2 * (kSide + 1) + kSide / 2, 2) = 0.5;
  return mesh;
}

/// Every second section is wide, and the sections stand unevenly, so that values carried in different ways differ.
Mesh ring() {
  constexpr Index kAround = 8;
  constexpr Index kAcross = 5;
  constexpr double kTurn = 2.0 * EIGEN_PI;
  constexpr double kPalette[5][3] = {
      {0.85, 0.2, 0.15}, {0.95, 0.8, 0.2}, {0.15, 0.55, 0.3}, {0.2, 0.4, 0.85}, {0.95, 0.95, 0.9}};
  Mesh mesh = torus(kAround, kAcross);
  Attribute color{"color", Values(mesh.vertex_count(), 3), {}};
  for (Index i = 0; i < kAround; ++i) {
    const double turn = kTurn * (i + (i % 2 == 0 ? 0.25 : 0.0)) / kAround;
    const double radius = i % 2 == 0 ? 0.3 : 0.5;
    for (Index j = 0; j < kAcross; ++j) {
      const double angle = kTurn * j / kAcross;
      const double distance = 1.0 + radius * std::cos(angle);
      const Index v = i * kAcross + j;
      mesh.points.row(v) << distance * std::cos(turn), distance * std::sin(turn), radius * std::sin(angle);
      for (int c = 0; c < 3; ++c) color.values(v, c) = kPalette[(2 * i + 3 * j) % 5][c];
    }
  }
  // Face (i, j) has the rows (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1): one more each way than there are vertices.
  Attribute uv{"uv", Values((kAround + 1) * (kAcross + 1), 2), {}};
  for (Index i = 0; i <= kAround; ++i) {
    const double u = (5.0 * i + 2.0 * (i % 2)) / 10.0;
    for (Index j = 0; j <= kAcross; ++j) {
      const double v = (4.0 * j + (j < kAcross ? j % 2 : 0)) / 10.0;
      uv.values.row(i * (kAcross + 1) + j) << u, v;
    }
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index row = f / kAcross * (kAcross + 1) + f % kAcross;
    for (const Index step : {0, kAcross + 1, kAcross + 2, 1}) uv.corner_rows.push_back(row + step);
  }
  mesh.attributes = {std::move(color), std::move(uv)};
  return mesh;
}

std::vector<Model> all_models() {
  std::vector<Model> models = {{"pipe-joint", pipe_joint()},
                               {"coarse-joint", coarse_joint()},
                               {"pyramid", pyramid()},
                               {"lifted-grid", lifted_grid()},
                               {"tripod", tripod()},
                               {"torus-knot", torus_knot()},
                               {"bracket", bracket()},
                               {"creature", creature()},
                               {"bracket-scan", bracket_scan()},
                               {"tetrahedron", tetrahedron()},
                               {"cube", cube()},
                               {"dented-cube", dented_cube()},
                               {"octahedron", octahedron()},
                               {"dodecahedron", dodecahedron()},
                               {"icosahedron", icosahedron()},
                               {"ring", ring()}};
  for (Model& model : models) round_points(model.mesh.points, model.mesh.vertex_count() <= 20 ? 1e6 : kGrain);
  return models;
}

std::vector<Model> morph_models() {
  Mesh ball = ball_of(creature(), 3.0);
  round_points(ball.points, kGrain);
  Mesh horned = creature();
  round_points(horned.points, kGrain);
  Eigen::Index forehead = 0;
  (horned.points.rowwise() - Eigen::RowVector3d(0.0, -1.7, 5.7)).rowwise().norm().minCoeff(&forehead);
  horned.points.row(forehead) += Eigen::RowVector3d(0.0, -0.5, 0.5);
  round_points(horned.points, kGrain);
  return {{"creature-ball", std::move(ball)}, {"creature-horn", std::move(horned)}};
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
