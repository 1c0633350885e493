#include <gtest/gtest.h>

#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/grid_fields.h"

namespace batten {
namespace {

/// With every edge sharp for ever, corners stay and creases are the straight edges between them.
Mesh all_sharp(Mesh mesh) {
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    mesh.creases.push_back({topology.origin(h), topology.destination(h), kInfiniteSharpness});
  }
  return mesh;
}

TEST(CreaseCurves, RunAlongTheirEdgesInOrder) {
  // Quads; pentagons, whose tessellation starts from the first refinement; triangles under Loop.
  for (const Mesh& mesh : {all_sharp(cube()), all_sharp(dodecahedron()), all_sharp(triangulated(cube()))}) {
    const Topology topology(mesh);
    const Tessellator tessellator(topology, choose_scheme(mesh), 3);
    Points limit(tessellator.vertex_count(), 3);
    tessellator.limit<double>(mesh.points, {limit.data(), static_cast<std::size_t>(limit.size())});
    const std::vector<CreaseCurve> curves = crease_curves(topology, tessellator);
    ASSERT_EQ(curves.size(), static_cast<std::size_t>(topology.edge_count()));
    for (const CreaseCurve& curve : curves) {
      ASSERT_EQ(curve.vertices.size(), 9U);
      EXPECT_EQ(curve.sharpness, double{kInfiniteSharpness});
      const Eigen::RowVector3d first = limit.row(curve.vertices.front());
      const Eigen::RowVector3d last = limit.row(curve.vertices.back());
      EXPECT_LT((first - mesh.points.row(curve.vertices.front())).norm(), 1e-12);
      for (Index i = 0; i < 9; ++i)
        EXPECT_LT((limit.row(curve.vertices[static_cast<std::size_t>(i)]) - (first + i / 8.0 * (last - first))).norm(),
                  1e-12);
    }
  }
}

TEST(CreaseCurves, LeaveBoundariesAndSmoothEdgesOut) {
  Mesh mesh = grid(3, 3);
  mesh.creases = {{5, 6, 1.5}, {0, 1, 3.0}};  // inside, and on the boundary
  const Topology topology(mesh);
  const std::vector<CreaseCurve> curves = crease_curves(topology, Tessellator(topology, choose_scheme(mesh), 1));
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(curves[0].sharpness, 1.5);
}

TEST(RefinementOrder, FindsTheSamePointsAfterRefinement) {
  // Quads; pentagons; triangles; a boundary; a scheme that interpolates.
  for (const Mesh& mesh :
       {cube(), dodecahedron(), triangulated(dodecahedron()), grid(3, 2), triangulated(grid(3, 2))}) {
    const Topology topology(mesh);
    for (const SchemeKind kind : {choose_scheme(mesh).kind, SchemeKind::ModifiedButterfly}) {
      if (kind == SchemeKind::ModifiedButterfly && !all_triangles(mesh)) continue;
      Scheme scheme = choose_scheme(mesh);
      scheme.kind = kind;
      for (const int count : {1, 3}) {
        const Tessellator tessellator(topology, scheme, count);
        std::vector<Topology> levels;
        const bool refined = tessellator.base().half_edge_count() != topology.half_edge_count();
        for (int level = refined ? 1 : 0; level <= count; ++level)
          levels.push_back(refine(topology, scheme, mesh.points, level).topology);
        Points points(tessellator.vertex_count(), 3);
        tessellator.refined<double>(mesh.points, {points.data(), static_cast<std::size_t>(points.size())});
        const Values expected = refine(topology, scheme, mesh.points, count).values;
        const Buffer<Index> order = refinement_order(tessellator, levels);
        ASSERT_EQ(static_cast<Eigen::Index>(order.size()), expected.rows());
        EXPECT_LT((points - expected(order, Eigen::all)).cwiseAbs().maxCoeff(), 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace batten
