/// Bodies for `batten simulate`.
#include <cmath>

#include "batten/mesh/moved_mesh.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "shapes.h"

namespace batten::models {
namespace {

constexpr double kElasticGrain = 1e4;

Mesh rounded(Mesh mesh) {
  mesh.points = (mesh.points * kElasticGrain).array().round() / kElasticGrain + 0.0;
  return mesh;
}

/// The cube refined twice, its vertices moved onto the unit sphere: 98 vertices.
Mesh cube_sphere() {
  const Mesh control = cube();
  Mesh sphere = refine_mesh(Topology(control), {}, control, 2).mesh;
  sphere.points.rowwise().normalize();
  return sphere;
}

/// Upright: x from 0 to 1.5, z from 0 to 1.
Mesh flag() {
  Mesh mesh = grid(18, 12);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::RowVector3d at = mesh.points.row(v);
    mesh.points.row(v) << 0.75 * (at.x() + 1.0), 0.0, 0.5 * (at.y() + 1.0);
  }
  return mesh;
}

/// A shallow shell over a rectangle of 2 by 1.4, flat at its edge but for a crown along its middle.
Mesh panel() {
  Mesh mesh = grid(20, 14);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double x = mesh.points(v, 0);
    const double y = mesh.points(v, 1);
    mesh.points.row(v) << x, 0.7 * y, 0.35 * (1.0 - x * x) * (1.0 - 0.7 * y * y) + 0.08 * (1.0 - y * y);
  }
  return mesh;
}

/// The same with a round dent beside its middle.
Mesh dented_panel() {
  Mesh mesh = panel();
  const Eigen::Vector2d middle(0.3, -0.1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double away = (mesh.points.row(v).head<2>().transpose() - middle).squaredNorm();
    const double x = mesh.points(v, 0);
    const double y = mesh.points(v, 1) / 0.7;
    mesh.points(v, 2) -= 0.4 * std::exp(-away / 0.06) * (1.0 - std::pow(x, 8.0)) * (1.0 - std::pow(y, 8.0));
  }
  return mesh;
}

}  // namespace

std::vector<Model> elastic_models() {
  return {{"sphere", rounded(cube_sphere())},
          {"flag", rounded(flag())},
          {"panel", rounded(panel())},
          {"panel-dented", rounded(dented_panel())}};
}

}  // namespace batten::models
