#include "batten/tessellate/moving_surface.h"

#include <gtest/gtest.h>

#include "batten/mesh/primitives.h"
#include "batten/tessellate/surface_mesh.h"
#include "support/errors.h"

namespace batten {
namespace {

/// At each time the mesh plus its weights times the targets is the surface of that shape, normals too.
TEST(MovingSurface, IsTheSurfaceOfEachShapeAtItsTime) {
  Mesh control = cube();
  const Topology topology(control);
  const std::vector<Points> shapes{2.0 * control.points, control.points.rowwise() + Eigen::RowVector3d(1.0, 2.0, 0.0)};
  const MovingSurface moving = surface_through_time(topology, {}, control, shapes, {0.0, 0.5, 2.0}, 2);
  EXPECT_EQ(moving.targets.times, (std::vector<double>{0.0, 0.5, 2.0}));
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (k > 0) control.points = shapes[static_cast<std::size_t>(k - 1)];
    const Mesh surface = surface_mesh(topology, {}, control, 2);
    Points points = moving.mesh.points;
    Values normals = moving.mesh.attributes.at(0).values;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const double weight = moving.targets.weights(k, static_cast<Eigen::Index>(i));
      points += weight * moving.targets.displacements[i];
      normals += weight * moving.targets.normals[i];
    }
    EXPECT_LT((points - surface.points).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((normals - surface.attributes.at(0).values).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(MovingSurface, NeedsATimeForEachShape) {
  const Mesh control = cube();
  const std::vector<Points> shapes{control.points};
  test::expect_error([&] { surface_through_time(Topology(control), {}, control, shapes, {0.0}, 1); },
                     ErrorCode::BadShape, "2 shapes needs as many times, not 1");
}

}  // namespace
}  // namespace batten
