#include <algorithm>
#include <cstdint>
#include <vector>

#include "batten/fit/sharp_edges.h"

namespace batten {

namespace {

/// The creases at each vertex.
std::vector<std::vector<Index>> creases_at(const Mesh& mesh) {
  std::vector<std::vector<Index>> at(static_cast<std::size_t>(mesh.vertex_count()));
  for (Index c = 0; c < static_cast<Index>(mesh.creases.size()); ++c) {
    at[mesh.creases[c].a].push_back(c);
    at[mesh.creases[c].b].push_back(c);
  }
  return at;
}

/// Single edges that end beside a line.
void drop_spurs(Mesh& mesh) {
  const std::vector<std::vector<Index>> at = creases_at(mesh);
  std::erase_if(mesh.creases, [&](const Crease& crease) {
    const std::size_t one = at[crease.a].size();
    const std::size_t other = at[crease.b].size();
    return std::min(one, other) == 1 && std::max(one, other) >= 3;
  });
}

void drop_short_lines(Mesh& mesh, double least_length) {
  constexpr std::size_t kLeastEdges = 4;
  const std::vector<std::vector<Index>> at = creases_at(mesh);
  std::vector<std::uint8_t> seen(mesh.creases.size(), 0);
  std::vector<Crease> kept;
  for (Index first = 0; first < static_cast<Index>(mesh.creases.size()); ++first) {
    if (seen[first] != 0) continue;
    std::vector<Index> line{first};
    seen[first] = 1;
    double length = 0.0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Crease& crease = mesh.creases[line[i]];
      length += (mesh.points.row(crease.a) - mesh.points.row(crease.b)).norm();
      for (const Index v : {crease.a, crease.b}) {
        for (const Index other : at[v]) {
          if (seen[other] != 0) continue;
          seen[other] = 1;
          line.push_back(other);
        }
      }
    }
    if (line.size() < kLeastEdges || length < least_length) continue;
    for (const Index c : line) kept.push_back(mesh.creases[c]);
  }
  mesh.creases = std::move(kept);
}

}  // namespace

void keep_lines(Mesh& mesh, double spacing) {
  constexpr double kLeastSpacings = 8.0;
  drop_spurs(mesh);
  drop_short_lines(mesh, kLeastSpacings * spacing);
}

}  // namespace batten
