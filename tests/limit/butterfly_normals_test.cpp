#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/limit/butterfly_tangents.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"
#include "batten/surface/limit_surface.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::scheme_of;

Mesh only_infinite(Mesh mesh) {
  for (Crease& crease : mesh.creases) crease.sharpness = kInfiniteSharpness;
  for (Corner& corner : mesh.corners) corner.sharpness = kInfiniteSharpness;
  return mesh;
}

/// Between two sharp edges of one triangle there is no limit, unless they end there.
bool is_single_triangle(const Topology& topology, Index h) {
  return topology.edge_sharpness(topology.edge(h)) > 0 &&
         topology.edge_sharpness(topology.edge(topology.previous(h))) > 0;
}

/// Masks are left eigenvectors: a side of a vertex has the same normal seen from every level.
double worst_change(const Mesh& mesh, const Scheme& scheme, int levels) {
  RefinedSurface surface{Topology(mesh), mesh.points};
  double worst = 0.0;
  for (int level = 0; level < levels; ++level) {
    const Values before = limit_normals(surface.topology, scheme, surface.values).corners;
    const RefinedSurface fine = refine(surface.topology, scheme, surface.values, 1);
    const Values after = limit_normals(fine.topology, scheme, fine.values).corners;
    for (Index h = 0; h < surface.topology.half_edge_count(); ++h) {
      if (is_single_triangle(surface.topology, h)) continue;
      EXPECT_NEAR(before.row(h).norm(), 1.0, 1e-12);
      double change = 2.0;
      fine.topology.for_each_outgoing(surface.topology.origin(h), [&](Index g) {
        change = std::min(change, (after.row(g) - before.row(h)).cwiseAbs().maxCoeff());
      });
      worst = std::max(worst, change);
    }
    surface = fine;
  }
  return worst;
}

TEST(ButterflyNormals, AreTheSameFromEveryLevel) {
  for (const auto boundary : {ButterflyBoundary::CreaseRules, ButterflyBoundary::Reflect}) {
    for (const test::NamedMesh& sample : test::sample_meshes()) {
      if (sample.name == "dihedron") continue;  // flat
      const Mesh mesh = triangulated(sample.mesh);
      // Differences of points shrink by half a level; 1e-16 of them grows likewise.
      EXPECT_LT(worst_change(mesh, scheme_of(SchemeKind::ModifiedButterfly, boundary), 3), 1e-11) << sample.name;
    }
  }
}

TEST(ButterflyNormals, AreTheSameFromEveryLevelWithCreases) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Mesh mesh = only_infinite(test::with_random_tags(test::random_hull(40, seed), seed));
    EXPECT_LT(worst_change(mesh, scheme_of(SchemeKind::ModifiedButterfly), 3), 1e-10) << seed;
  }
}

TEST(ButterflyNormals, HoldForOtherTensions) {
  for (const double tension : {1.0 / 64, -1.0 / 64, 1.0 / 32}) {
    Scheme scheme = scheme_of(SchemeKind::ModifiedButterfly);
    scheme.tension = tension;
    EXPECT_LT(worst_change(test::jittered(test::triangle_torus(7, 5), 0.05, 2), scheme, 3), 1e-11) << tension;
    EXPECT_LT(worst_change(test::random_hull(40, 1), scheme, 3), 1e-11) << tension;
  }
}

/// Plain Butterfly has tangent planes at the valences 4 to 7.
TEST(ButterflyNormals, HoldForPlainButterfly) {
  EXPECT_LT(worst_change(test::jittered(octahedron(), 0.1, 1), scheme_of(SchemeKind::Butterfly), 3), 1e-11);
  EXPECT_LT(worst_change(test::jittered(icosahedron(), 0.1, 1), scheme_of(SchemeKind::Butterfly), 3), 1e-11);
  EXPECT_LT(worst_change(test::jittered(test::triangle_torus(7, 5), 0.05, 2), scheme_of(SchemeKind::Butterfly), 3),
            1e-11);
}

/// docs/mathematics.md, Butterfly: at w = 0 weights of e, m, d as 16 cos, -8/sqrt(3) cos(. + pi/6), cos; other w as the
/// note lists them.
TEST(ButterflyNormals, RegularMasksAreThoseOfTheNote) {
  struct Case {
    double tension;
    double across;  // value at (1, 1) of the first tangent over that at (1, 0)
    double beyond;
  };
  for (const Case& expected : {Case{0.0, -0.25, 1.0 / 16}, Case{1.0 / 64, -0.35714285714285715, 1.0 / 7},
                               Case{-1.0 / 64, -1.0 / 6, 0.0}, Case{1.0 / 32, -0.5, 0.25}}) {
    Scheme scheme = scheme_of(SchemeKind::ModifiedButterfly);
    scheme.tension = expected.tension;
    ButterflyTangents tangents(scheme);
    const TwoRingMask& first = tangents.make(ButterflyFan::Closed, 6).first;
    EXPECT_NEAR(first.across[0] / first.edges[0], expected.across, 1e-12) << expected.tension;
    EXPECT_NEAR(first.beyond[0] / first.edges[0], expected.beyond, 1e-12) << expected.tension;
  }
}

/// The faces around a vertex turn into the tangent plane by half an edge's length a level or faster.
TEST(ButterflyNormals, AreTheLimitOfTheFacesNormals) {
  Mesh mesh = test::random_hull(30, 4);
  const Scheme scheme = scheme_of(SchemeKind::ModifiedButterfly);
  const Values expected = limit_normals(Topology(mesh), scheme, mesh.points).vertices;
  const RefinedSurface fine = refine(Topology(mesh), scheme, mesh.points, 6);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    fine.topology.for_each_outgoing(v, [&](Index h) {
      const Eigen::Vector3d to = fine.values.row(fine.topology.destination(h)) - fine.values.row(v);
      EXPECT_LT(std::abs(to.normalized().dot(expected.row(v))), 0.1);
      const Eigen::Vector3d other =
          fine.values.row(fine.topology.origin(fine.topology.previous(h))) - fine.values.row(v);
      EXPECT_GT(to.cross(other).normalized().dot(expected.row(v)), 0.98) << v;
    });
  }
}

/// At a flat boundary every kind of boundary vertex has the plane's normal, single triangles too.
TEST(ButterflyNormals, AreThoseOfAPlane) {
  Mesh mesh = triangulated(test::jittered(grid(5, 4), 0.1, 6));
  mesh.points.col(2).setZero();
  for (const auto boundary : {ButterflyBoundary::CreaseRules, ButterflyBoundary::Reflect}) {
    const LimitNormals normals =
        limit_normals(Topology(mesh), scheme_of(SchemeKind::ModifiedButterfly, boundary), mesh.points);
    const double sign = normals.vertices(0, 2);
    EXPECT_LT((normals.vertices.col(2).array() - sign).abs().maxCoeff(), 1e-12);
    EXPECT_NEAR(std::abs(sign), 1.0, 1e-12);
    EXPECT_LT((normals.corners.col(2).array() - sign).abs().maxCoeff(), 1e-12);
  }
}

TEST(ButterflyNormals, LimitPositionsAreTheVertices) {
  const Mesh mesh = test::random_hull(30, 4);
  const Topology topology(mesh);
  EXPECT_EQ(LimitMatrix(topology, scheme_of(SchemeKind::Butterfly)).apply(mesh.points), mesh.points);
}

TEST(ButterflyNormals, ThereIsNoClosedFormBetweenVertices) {
  const Mesh mesh = icosahedron();
  const Topology topology(mesh);
  try {
    const LimitSurface surface(topology, scheme_of(SchemeKind::ModifiedButterfly), mesh.points);
    FAIL() << "made a spline of Modified Butterfly";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no closed form"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace batten
