#include "batten/patch/surface_place.h"

#include <gtest/gtest.h>

#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"
#include "batten/surface/limit_surface.h"
#include "support/shapes.h"

namespace batten {
namespace {

TEST(SurfacePlace, MapsBetweenLevelsWithoutMovingThePoint) {
  for (const auto& [mesh, scheme] : {std::pair{test::jittered(cube(), 0.1, 2), Scheme{}},
                                     std::pair{test::jittered(icosahedron(), 0.1, 2), Scheme{SchemeKind::Loop}}}) {
    const Topology topology(mesh);
    const RefinedSurface refined = refine(topology, scheme, mesh.points, 1);
    const LimitSurface coarse(topology, scheme, mesh.points);
    const LimitSurface fine(refined.topology, scheme, refined.values);
    const bool quads = scheme.kind == SchemeKind::CatmullClark;
    for (Index f = 0; f < topology.face_count(); ++f) {
      for (double u = 0.03; u < 1.0; u += 0.11) {
        for (double v = 0.02; v < (quads ? 1.0 : 1.0 - u); v += 0.13) {
          const SurfacePlace place{f, u, v};
          const SurfacePlace there = refined_place(topology, place);
          EXPECT_LT((fine.jet(there).point - coarse.jet(place).point).norm(), 1e-13);
          const SurfacePlace back = coarser_place(topology, there);
          EXPECT_EQ(back.face, f);
          EXPECT_NEAR(back.u, u, 1e-15);
          EXPECT_NEAR(back.v, v, 1e-15);
          const Eigen::Matrix2d change = refined_parameters(topology, place);
          const Jet jet = fine.jet(there);
          const Jet expected = coarse.jet(place);
          EXPECT_LT((jet.du * change(0, 0) + jet.dv * change(1, 0) - expected.du).norm(), 1e-12);
          EXPECT_LT((jet.du * change(0, 1) + jet.dv * change(1, 1) - expected.dv).norm(), 1e-12);
        }
      }
    }
  }
}

TEST(SurfacePlace, OfAVertexIsWhereItsLimitPositionIs) {
  for (const auto& [mesh, scheme] : {std::pair{test::jittered(torus(7, 5), 0.1, 2), Scheme{}},
                                     std::pair{test::jittered(icosahedron(), 0.1, 2), Scheme{SchemeKind::Loop}}}) {
    const Topology topology(mesh);
    const Values limits = LimitMatrix(topology, scheme).apply(mesh.points);
    const LimitSurface surface(topology, scheme, mesh.points);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      EXPECT_LT((surface.jet(place_of_vertex(topology, v)).point.transpose() - limits.row(v)).norm(), 1e-13) << v;
    }
  }
}

}  // namespace
}  // namespace batten
