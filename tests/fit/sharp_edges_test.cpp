#include "batten/fit/sharp_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "batten/fit/crease_counts.h"
#include "batten/fit/first_mesh.h"
#include "batten/fit/fit_surface.h"
#include "batten/fit/outliers.h"
#include "batten/fit/paired_quads.h"
#include "batten/fit/sharp_normals.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "fit/clouds.h"

namespace batten {
namespace {

using test::CloudMaker;

Points box_points(Index count, unsigned seed = 3) {
  CloudMaker maker(seed);
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    for (Index c = 0; c < 3; ++c) points(i, c) = maker.uniform(-1.0, 1.0);
    points(i, i % 3) = i % 2 == 0 ? 1.0 : -1.0;
  }
  return points;
}

/// A cylinder of radius 1 and height 2 with its two lids.
Points cylinder_points(Index count) {
  CloudMaker maker(5);
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    const double angle = maker.uniform(0.0, 2.0 * std::numbers::pi);
    const double r = i % 3 == 0 ? std::sqrt(maker.uniform()) : 1.0;
    const double z = i % 3 != 0 ? maker.uniform(-1.0, 1.0) : i % 2 == 0 ? 1.0 : -1.0;
    points.row(i) << r * std::cos(angle), r * std::sin(angle), z;
  }
  return points;
}

FitResult fit_of(const Points& points, SchemeKind kind, FitCreases creases) {
  FitOptions options;
  options.scheme.kind = kind;
  options.vertices = 100;
  options.creases = creases;
  return fit_surface({points, Points(0, 3)}, options);
}

/// The true normal of a box's side is an axis.
TEST(SharpNormals, DoNotMixTheSidesOfABox) {
  const Points points = box_points(3000);
  const NeighbourTable neighbours = find_neighbours(PointTree(points), kCloudNeighbours);
  const Points mixed = estimate_normals(points);
  const Points sharp = sharp_normals(points, mixed, neighbours);
  const auto wrong = [](const Points& normals) {
    return (normals.cwiseAbs().rowwise().maxCoeff().array() < 0.99).count();
  };
  EXPECT_GT(wrong(mixed), 300);
  EXPECT_LT(wrong(sharp), wrong(mixed) / 6);
  const auto of_another_side = [&](const Points& normals) {
    Index count = 0;
    for (Index i = 0; i < points.rows(); ++i) count += std::abs(normals(i, i % 3)) < 0.5 ? 1 : 0;
    return count;
  };
  EXPECT_LT(of_another_side(sharp), of_another_side(mixed)) << "points whose plane is that of the next side";
}

/// Each corner of the box is one of the mesh, where three sharp edges meet, and lines end nowhere else.
TEST(FirstMesh, HasTheCornersAndEdgesOfBoxes) {
  constexpr int kBoxes = 4;
  int corners = 0;
  int ends = 0;
  for (unsigned seed = 1; seed <= kBoxes; ++seed) {
    FirstMeshOptions options;
    options.vertices = 100;
    options.creases = CreaseSearch::Auto;
    const Mesh mesh = first_mesh({box_points(3000, seed), Points(0, 3)}, options).mesh;
    std::vector<int> creases(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const Crease& crease : mesh.creases) {
      ++creases[static_cast<std::size_t>(crease.a)];
      ++creases[static_cast<std::size_t>(crease.b)];
    }
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Eigen::RowVector3d off = mesh.points.row(v).cwiseAbs() - Eigen::RowVector3d::Ones();
      corners += creases[static_cast<std::size_t>(v)] == 3 && off.norm() < 0.03 ? 1 : 0;
      ends += creases[static_cast<std::size_t>(v)] == 1 ? 1 : 0;
    }
  }
  // Points scatter: where none lies beside a corner it may be missed.
  EXPECT_GE(corners, kBoxes * 8 - 2);
  EXPECT_LE(ends, 2);
}

TEST(SharpNormals, StayOnASphere) {
  const Points points = CloudMaker().sphere(2000);
  const NeighbourTable neighbours = find_neighbours(PointTree(points), kCloudNeighbours);
  const Points normals = estimate_normals(points);
  EXPECT_LT((sharp_normals(points, normals, neighbours) - normals).rowwise().norm().maxCoeff(), 0.2);
}

/// Creases lie on the two circles, and most of both is covered.
TEST(FitCreases, LieOnTheCirclesOfACylinder) {
  const FitResult fit = fit_of(cylinder_points(4000), SchemeKind::Loop, FitCreases::Auto);
  ASSERT_FALSE(fit.mesh.creases.empty());
  double length = 0.0;
  double on_circles = 0.0;
  for (const Crease& crease : fit.mesh.creases) {
    const Eigen::RowVector3d middle = 0.5 * (fit.mesh.points.row(crease.a) + fit.mesh.points.row(crease.b));
    const double part = (fit.mesh.points.row(crease.a) - fit.mesh.points.row(crease.b)).norm();
    length += part;
    if (std::abs(std::abs(middle(2)) - 1.0) < 0.05) on_circles += part;
  }
  EXPECT_GT(on_circles, 0.9 * length);
  EXPECT_GT(on_circles, 0.75 * 4.0 * std::numbers::pi);
}

TEST(FitCreases, MakeABoxFarMoreExact) {
  const Points points = box_points(3000);
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const FitResult sharp = fit_of(points, kind, FitCreases::Auto);
    const FitResult smooth = fit_of(points, kind, FitCreases::None);
    // Loop's moves crowd control points at edges that stay smooth.
    const double share = kind == SchemeKind::Loop ? 0.4 : 0.1;
    EXPECT_LT(sharp.report.to_surface.rms, share * smooth.report.to_surface.rms);
    EXPECT_EQ(sharp.report.unsound, 0);
    EXPECT_GE(count_creases(sharp.topology).corners, 7);
    EXPECT_EQ(count_creases(smooth.topology).edges, 0);
  }
}

TEST(FitCreases, AreNotFoundOnSmoothSurfaces) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    EXPECT_TRUE(fit_of(CloudMaker().torus(2500), kind, FitCreases::Auto).mesh.creases.empty());
    EXPECT_TRUE(fit_of(CloudMaker().sphere(2500), kind, FitCreases::Auto).mesh.creases.empty());
  }
}

/// The upper half of a torus's faces is cut off by two rings of creases. No quad lies across one.
TEST(PairedQuads, DoNotLieAcrossCreases) {
  Mesh mesh = triangulated(torus(9, 6));
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index a = topology.origin(topology.edge_half_edge(e));
    const Index b = topology.destination(topology.edge_half_edge(e));
    if (std::abs(mesh.points(a, 2)) < 1e-9 && std::abs(mesh.points(b, 2)) < 1e-9)
      mesh.creases.push_back({a, b, kInfiniteSharpness});
  }
  const std::size_t before = mesh.creases.size();
  ASSERT_GT(before, 0U);
  const Mesh quads = paired_quads(mesh);
  EXPECT_GE(quads.creases.size(), before);
  EXPECT_NO_THROW(Topology{quads}) << "a crease must be an edge of the quads";
}

TEST(CreaseCounts, CountEdgesCornersAndDarts) {
  Mesh mesh = cube();
  mesh.creases = {{mesh.face_vertices[0], mesh.face_vertices[1], kInfiniteSharpness}};
  const CreaseCounts one = count_creases(Topology(mesh));
  EXPECT_EQ(one.edges, 1);
  EXPECT_EQ(one.darts, 2);
  EXPECT_EQ(one.corners, 0);
}

}  // namespace
}  // namespace batten
