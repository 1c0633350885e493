#include <cstdio>
#include <utility>

#include "batten/batten.h"

/// Three ways from colours at the vertices to colours on the surface, and how far each is from the colours given.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Values colors = 0.5 + 0.5 * (3.0 * mesh.points.array()).sin();
  mesh.attributes.push_back({"color", colors, {}});
  const batten::Topology topology(mesh);
  const batten::Scheme scheme = batten::choose_scheme(mesh);
  const std::pair<batten::AttributeRule, const char*> rules[] = {{batten::AttributeRule::Scheme, "scheme"},
                                                                 {batten::AttributeRule::Interpolated, "interpolated"},
                                                                 {batten::AttributeRule::Midpoint, "midpoint"}};
  for (const auto& [rule, name] : rules) {
    const batten::Mesh ready = batten::prepare_attributes(topology, scheme, mesh, {rule, {}}).mesh;
    const batten::Mesh surface = batten::surface_mesh(topology, scheme, ready, 3);
    const batten::Values& shown = surface.attributes.front().values;
    std::printf("%s: off by %.1e\n", name, (shown.topRows(colors.rows()) - colors).cwiseAbs().maxCoeff());
    batten::write_mesh(argv[2], surface);
  }
}
