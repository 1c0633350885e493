#include "batten/nearest/surface_side.h"

#include <gtest/gtest.h>

#include <random>

#include "support/shapes.h"

namespace batten {
namespace {

/// Sharp edges all over: the surface is the cube, and most nearest points outside lie on its edges and corners.
TEST(SurfaceSide, OfASharpCubeIsThatOfTheCube) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    Mesh mesh = cube();
    if (kind == SchemeKind::Loop) {
      test::Faces faces;
      for (const auto& f : test::faces_of(mesh)) faces.insert(faces.end(), {{f[0], f[1], f[2]}, {f[0], f[2], f[3]}});
      mesh = test::with_faces(mesh, faces);
    }
    const Topology plain(mesh);
    for (Index e = 0; e < plain.edge_count(); ++e) {
      const Index h = plain.edge_half_edge(e);
      mesh.creases.push_back({plain.origin(h), plain.destination(h), kInfiniteSharpness});
    }
    const Topology topology(mesh);
    ASSERT_TRUE(encloses_space(topology));
    Scheme scheme;
    scheme.kind = kind;
    const LimitSurface surface(topology, scheme, mesh.points);
    const NearestPoints nearest(topology, scheme, mesh.points);
    const Eigen::Array3d low = mesh.points.colwise().minCoeff().transpose();
    const Eigen::Array3d high = mesh.points.colwise().maxCoeff().transpose();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-0.5, 1.5);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Array3d query = low + (high - low) * Eigen::Array3d(unit(random), unit(random), unit(random));
      const bool inside = (query > low).all() && (query < high).all();
      EXPECT_EQ(side_of(surface, query, nearest.nearest(query)) == SurfaceSide::Inside, inside);
    }
  }
}

/// Two faces at less than a right angle: the normal of either may look away from what is outside.
TEST(SurfaceSide, OfAThinWedgeIsThatOfItsFaces) {
  Mesh mesh = test::mesh_of_faces(6, {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}});
  mesh.points << 0, 0, 0, 10, -1, 0, 10, 1, 0, 0, 0, 5, 10, -1, 5, 10, 1, 5;
  for (Index v = 0; v < 6; ++v) mesh.corners.push_back({v, kInfiniteSharpness});
  const Topology plain(mesh);
  for (Index e = 0; e < plain.edge_count(); ++e) {
    const Index h = plain.edge_half_edge(e);
    mesh.creases.push_back({plain.origin(h), plain.destination(h), kInfiniteSharpness});
  }
  // The faces' order decides which side is out.
  const Topology topology(mesh);
  const LimitSurface surface(topology, Scheme(), mesh.points);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  const auto side = [&](double x, double y) { return side_of(surface, {x, y, 2.5}, nearest.nearest({x, y, 2.5})); };
  const SurfaceSide within = side(8.0, 0.0);
  for (const double y : {-0.5, -0.01, 0.0, 0.01, 0.5}) EXPECT_NE(side(-0.5, y), within);
  for (const double y : {-0.9, 0.0, 0.9}) EXPECT_NE(side(10.5, y), within);
  EXPECT_EQ(side(2.0, 0.05), within);
}

TEST(SurfaceSide, OnlyWhatIsClosedEnclosesSpace) {
  EXPECT_TRUE(encloses_space(Topology(torus(5, 4))));
  EXPECT_FALSE(encloses_space(Topology(grid(2, 2))));
  Mesh mesh = cube();
  mesh.holes = {3};
  EXPECT_FALSE(encloses_space(Topology(mesh)));
}

TEST(SurfaceSide, OfASmoothTorus) {
  const Mesh mesh = torus(12, 8);
  const Topology topology(mesh);
  const LimitSurface surface(topology, Scheme(), mesh.points);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  const Eigen::RowVector3d centre = mesh.points.colwise().mean();
  EXPECT_EQ(side_of(surface, centre, nearest.nearest(centre)), SurfaceSide::Outside);
  for (Index i = 0; i < 12; ++i) {
    const Eigen::Vector3d core = mesh.points.middleRows(8 * i, 8).colwise().mean().transpose();
    EXPECT_EQ(side_of(surface, core, nearest.nearest(core)), SurfaceSide::Inside);
  }
}

}  // namespace
}  // namespace batten
