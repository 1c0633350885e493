#include <cmath>
#include <cstdio>
#include <memory>

#include "batten/batten.h"

/// Inflates a small sphere in the image of a ball of 9 mm, until the ball's edge holds it.
int main() {
  batten::Volume image;
  image.grid.size = {33, 33, 33};
  image.grid.origin.setConstant(-16.0);
  for (std::ptrdiff_t i = 0; i < image.grid.count(); ++i) {
    const Eigen::Vector3d place = image.grid.to_world(Eigen::Vector3d(i % 33, i / 33 % 33, i / 1089));
    image.values.push_back(static_cast<float>(100.0 / (1.0 + std::exp(2.0 * (place.norm() - 9.0)))));
  }
  const batten::Mesh sphere = batten::start_sphere(4.0 * batten::octahedron().points, batten::SchemeKind::CatmullClark);
  const batten::ElasticSurface body(batten::Topology(sphere), {}, sphere.points,
                                    {.material = {{0}, {1}, {0.5}, {0.5}}});
  const auto edges = std::make_shared<batten::EdgeSearch>(image, 1.0);
  batten::ElasticMotion motion(
      body,
      {std::make_shared<batten::Pressure>(body, 2.0),
       std::make_shared<batten::EdgeSprings>(body, edges, batten::EdgeSpringOptions{100.0, 2.0})},
      {}, {.scheme = batten::TimeScheme::MassFree, .step = 0.1});
  batten::ElasticState state = batten::state_at_rest(body);
  do motion.step(state);
  while (state.time < 30.0 && motion.measure(state).residual_force > 1e-4);
  const double volume = batten::Pressure(body, 2.0).volume(state.positions);
  std::printf("at rest after %.1f s: %.0f mm^3, a radius of %.2f mm\n", state.time, volume,
              std::cbrt(volume / (4.0 / 3.0 * 3.14159265)));
}
