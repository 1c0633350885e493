#include "batten/parallel/parallel.h"
#include "batten/scheme/sharpness.h"
#include "batten/tessellate/butterfly_grids.h"
#include "batten/tessellate/grid_faces.h"
#include "batten/tessellate/lattice_walk.h"

namespace batten {

LimitNormals butterfly_grid_normals(const Topology& base, const Scheme& scheme, ConstValuesRef points, int levels) {
  const TessellationLayout layout(base, false, levels);
  const GridNumbering numbering{base, layout};
  const auto face_count = layout.faces_per_face * base.face_count();
  Mesh mesh;
  mesh.points = points;
  mesh.face_offsets.resize(static_cast<std::size_t>(face_count) + 1);
  for (std::size_t f = 0; f < mesh.face_offsets.size(); ++f) mesh.face_offsets[f] = static_cast<Index>(3 * f);
  mesh.face_vertices.resize(static_cast<std::size_t>(3 * face_count));
  parallel_for(base.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    GridFaces grids(layout, numbering);
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      grids.write(f, mesh.face_vertices.data() + 3 * layout.faces_per_face * f);
    }
  });
  // What is sharp after so many levels, segment by segment.
  const LatticeTags tags = lattice_tags(base, scheme, levels);
  for (Index e = 0; e < base.edge_count(); ++e) {
    if (tags.sharp_edges[e] == 0) continue;
    const LatticeWalk walk(base, layout, tags);
    for (Index s = 0; s < layout.steps; ++s) {
      const auto h = walk.on_base(base.edge_half_edge(e), s);
      const auto to = walk.origin(walk.next(h));
      mesh.creases.push_back(
          {static_cast<Index>(walk.origin(h).number), static_cast<Index>(to.number), kInfiniteSharpness});
    }
  }
  for (Index v = 0; v < base.vertex_count(); ++v) {
    if (tags.kinds[v] == ButterflyVertex::Corner) mesh.corners.push_back({v, kInfiniteSharpness});
  }
  return limit_normals(Topology(mesh), scheme, points);
}

}  // namespace batten
