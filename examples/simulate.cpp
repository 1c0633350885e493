#include <cstdio>

#include "batten/batten.h"

/// Runs a scene and writes its motion as an animation.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::ElasticRun run(batten::read_scene(argv[1]));
  const batten::Mesh first = run.mesh();
  std::vector<batten::Points> shapes;
  std::vector<double> times{run.state().time};
  batten::ElasticRow row;
  while (!run.done()) {
    row = run.step();
    if (run.frame() <= static_cast<batten::Index>(shapes.size())) continue;
    shapes.push_back(run.state().positions);
    times.push_back(run.state().time);
  }
  std::printf("%zu frames in %.2f s, elastic energy %.4g\n", times.size(), row.time, row.measure.elastic_energy);
  const batten::Topology& topology = run.motion().surface().topology();
  const batten::MovingSurface moving = batten::surface_through_time(topology, run.scheme(), first, shapes, times, 2);
  batten::write_animation(argv[2], moving.mesh, moving.targets);
}
