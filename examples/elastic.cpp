#include <cstdio>

#include "batten/batten.h"

/// Pulls a surface at a place of its first face for two seconds, then lets it come to rest.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::ElasticSurface body(batten::Topology(mesh), batten::choose_scheme(mesh), mesh.points);
  const batten::PointPath target = batten::stay_at({0.0, 0.0, 8.0});
  batten::ElasticMotion motion(body,
                               {std::make_shared<batten::PointSprings>(
                                   body, std::vector<batten::PointSprings::Spring>{{{0, 0.5, 0.5}, target, 50.0}})});
  batten::ElasticState state = batten::state_at_rest(body);
  for (int i = 0; i < 120; ++i) motion.step(state);
  std::printf("after %.2f s: kinetic energy %.4g J\n", state.time, motion.measure(state).kinetic_energy);
  const batten::EquilibriumReport rest = motion.find_equilibrium(state);
  std::printf("at rest: forces balance to %.2g N after %d rounds\n", rest.residual_force, rest.rounds);
  mesh.points = state.positions;
  batten::write_mesh(argv[2], mesh);
}
