#include "batten/tessellate/lattice_walk.h"

#include <algorithm>
#include <utility>

#include "batten/scheme/sharpness.h"

namespace batten {

bool tags_fade(const Topology& base) {
  const auto is_fading = [](float sharpness) { return is_semi_sharp(sharpness); };
  const TopologyTables& tables = base.tables();
  return std::any_of(tables.edge_sharpness.begin(), tables.edge_sharpness.end(), is_fading) ||
         std::any_of(tables.vertex_sharpness.begin(), tables.vertex_sharpness.end(), is_fading);
}

LatticeTags lattice_tags(const Topology& base, const Scheme& scheme, int levels) {
  if (levels > 0 && tags_fade(base)) {
    TopologyTables tables = base.tables();
    for (int level = 0; level < levels; ++level) {
      for (float& sharpness : tables.edge_sharpness) sharpness = subdivided_sharpness(sharpness);
      for (float& sharpness : tables.vertex_sharpness) sharpness = subdivided_sharpness(sharpness);
    }
    return lattice_tags(Topology::from_tables(std::move(tables)), scheme, 0);
  }
  LatticeTags tags;
  tags.kinds = butterfly_vertices(base, scheme);
  tags.sharp_edges.resize(static_cast<std::size_t>(base.edge_count()));
  for (Index e = 0; e < base.edge_count(); ++e) tags.sharp_edges[e] = is_sharp(base.edge_sharpness(e)) ? 1 : 0;
  return tags;
}

}  // namespace batten
