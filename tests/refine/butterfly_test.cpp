/// One step of Butterfly and Modified Butterfly on meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr double kPi = std::numbers::pi;
/// A dozen roundings of numbers up to some hundred.
constexpr double kTolerance = 1e-12;

using test::scheme_of;
const Scheme kPlain = scheme_of(SchemeKind::Butterfly);
const Scheme kModified = scheme_of(SchemeKind::ModifiedButterfly);
const Scheme kReflect = scheme_of(SchemeKind::ModifiedButterfly, ButterflyBoundary::Reflect);

/// n by m cells of the regular lattice, each of two triangles; points are lattice coordinates.
Mesh lattice(Index n, Index m) {
  test::Faces faces;
  const auto at = [&](Index x, Index y) { return y * (n + 1) + x; };
  for (Index y = 0; y < m; ++y) {
    for (Index x = 0; x < n; ++x) {
      faces.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
      faces.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  Mesh mesh = test::mesh_of_faces((n + 1) * (m + 1), faces);
  for (Index y = 0; y <= m; ++y) {
    for (Index x = 0; x <= n; ++x) mesh.points.row(at(x, y)) << x, y, 0.0;
  }
  return mesh;
}

using Function = std::function<double(double, double)>;
double cubic(double x, double y) {
  return 1 + x - 2 * y + 0.5 * x * x - x * y + y * y / 3 + x * x * x - 2 * x * y * y + x * x * y - y * y * y;
}
double quadratic(double x, double y) { return 2 - x + 3 * y + x * x - 0.5 * x * y + 2 * y * y; }

/// The largest error of f at the new points of edges that `chosen` says by their ends.
template <typename Chosen>
double worst_error(const Mesh& mesh, const Scheme& scheme, const Function& f, const Chosen& chosen) {
  const Topology topology(mesh);
  Values values(mesh.vertex_count(), 1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) values(v, 0) = f(mesh.points(v, 0), mesh.points(v, 1));
  const Values refined = Refinement(topology, scheme).apply(values);
  double worst = 0.0;
  int count = 0;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    const Eigen::RowVector3d a = mesh.points.row(topology.origin(h));
    const Eigen::RowVector3d b = mesh.points.row(topology.destination(h));
    if (!chosen(a, b)) continue;
    ++count;
    const Eigen::RowVector3d middle = 0.5 * (a + b);
    worst = std::max(worst, std::abs(refined(topology.vertex_count() + e, 0) - f(middle.x(), middle.y())));
  }
  EXPECT_GT(count, 0);
  return worst;
}

TEST(Butterfly, ReproducesCubicsOnTheRegularGrid) {
  const auto inside = [](const auto& a, const auto& b) {
    return std::min({a.x(), a.y(), b.x(), b.y()}) >= 2 && std::max({a.x(), a.y(), b.x(), b.y()}) <= 6;
  };
  for (const double tension : {0.0, 1.0 / 64, -1.0 / 64, 1.0 / 32}) {
    Scheme scheme = kModified;
    scheme.tension = tension;
    EXPECT_LT(worst_error(lattice(8, 8), scheme, cubic, inside), kTolerance) << tension;
  }
  EXPECT_LT(worst_error(lattice(8, 8), kPlain, cubic, inside), kTolerance);
  const auto quartic = [](double x, double) { return x * x * x * x; };
  EXPECT_GT(worst_error(lattice(8, 8), kModified, quartic, inside), 0.1);  // measured: 0.56
}

TEST(Butterfly, CreaseRulesReproduceQuadraticsBesideAStraightBoundary) {
  const auto beside = [](const auto& a, const auto& b) {
    const bool away_from_corners = std::min(a.x(), b.x()) >= 3 && std::max(a.x(), b.x()) <= 5;
    return away_from_corners && std::min(a.y(), b.y()) <= 1;
  };
  EXPECT_LT(worst_error(lattice(8, 8), kModified, quadratic, beside), kTolerance);
  EXPECT_LT(worst_error(lattice(8, 8), kPlain, quadratic, beside), kTolerance);
  EXPECT_GT(worst_error(lattice(8, 8), kReflect, quadratic, beside),
            0.1);  // the paper's rule is exact for linear ones only
  const auto linear = [](double x, double y) { return 1 - x + 2 * y; };
  EXPECT_LT(worst_error(lattice(8, 8), kReflect, linear, beside), kTolerance);
}

/// The same points with the crease x = 4 in the middle: each side takes the rules of a boundary.
TEST(Butterfly, TwoSidesOfACreaseDoNotKnowOfEachOther) {
  Mesh whole = test::jittered(lattice(8, 6), 0.1, 3);
  for (Index y = 0; y < 6; ++y) whole.creases.push_back({y * 9 + 4, y * 9 + 13, kInfiniteSharpness});
  test::Faces left;
  for (const auto& face : test::faces_of(whole)) {
    if (std::all_of(face.begin(), face.end(), [](Index v) { return v % 9 <= 4; })) left.push_back(face);
  }
  Mesh half = test::with_faces(whole, left);
  half.creases.clear();
  for (const Scheme& scheme : {kModified, kReflect, kPlain}) {
    Scheme with_corners = scheme;  // where the crease meets the boundary three sharp edges make a corner
    for (const Index end : {4, 58}) {
      whole.corners.push_back({end, kInfiniteSharpness});
      half.corners.push_back({end, kInfiniteSharpness});
    }
    const RefinedSurface a = refine(Topology(whole), with_corners, whole.points, 3);
    const RefinedSurface b = refine(Topology(half), with_corners, half.points, 3);
    int found = 0;
    for (Index v = 0; v < b.values.rows(); ++v) {
      if (b.topology.is_isolated(v)) continue;
      double nearest = 1e9;
      for (Index u = 0; u < a.values.rows(); ++u) {
        nearest = std::min(nearest, (a.values.row(u) - b.values.row(v)).cwiseAbs().maxCoeff());
      }
      EXPECT_LT(nearest, kTolerance);
      ++found;
    }
    EXPECT_GT(found, 500);
  }
}

TEST(Butterfly, BoundariesAreTheFourPointScheme) {
  const Mesh mesh = test::jittered(triangulated(test::annulus(9)), 0.2, 4);
  const Topology topology(mesh);
  const Values refined = Refinement(topology, kModified).apply(mesh.points);
  int count = 0;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    if (topology.twin(h) >= 0) continue;
    const Index a = topology.origin(h);
    const Index b = topology.destination(h);
    const Index after = topology.destination(topology.vertex_half_edge(b));
    Index before = -1;
    for (Index g = 0; g < topology.half_edge_count(); ++g) {
      if (topology.twin(g) < 0 && topology.destination(g) == a) before = topology.origin(g);
    }
    const Eigen::RowVector3d expected =
        (9.0 * (mesh.points.row(a) + mesh.points.row(b)) - mesh.points.row(before) - mesh.points.row(after)) / 16.0;
    EXPECT_LT((refined.row(topology.vertex_count() + e) - expected).norm(), kTolerance);
    ++count;
  }
  EXPECT_EQ(count, 18);
}

TEST(Butterfly, KeepsTheVerticesAndSumsToOne) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    for (unsigned seed = 0; seed < 3; ++seed) {
      const Mesh flat = triangulated(sample.mesh);
      const Mesh mesh = seed == 0 ? flat : test::with_random_tags(flat, seed);
      const Topology topology(mesh);
      Values values(mesh.vertex_count(), 4);
      values << mesh.points, Eigen::VectorXd::Ones(mesh.vertex_count());
      for (const Scheme& scheme : {kPlain, kModified, kReflect}) {
        const RefinedSurface fine = refine(topology, scheme, values, 3);
        EXPECT_EQ(fine.values.topRows(values.rows()), values) << sample.name;
        EXPECT_LT((fine.values.col(3).array() - 1.0).abs().maxCoeff(), 1e-13) << sample.name;
        EXPECT_TRUE(fine.values.allFinite());
      }
    }
  }
}

/// A crease of sharpness 2 is sharp in two steps, and so is one of 1.5.
TEST(Butterfly, SemiSharpCreasesLastForSoManyLevels) {
  const auto refined = [](double sharpness, int levels) {
    Mesh mesh = test::jittered(lattice(6, 6), 0.2, 8);
    for (Index y = 1; y < 5; ++y) mesh.creases.push_back({y * 7 + 3, y * 7 + 10, sharpness});
    return refine(Topology(mesh), kModified, mesh.points, levels).values;
  };
  EXPECT_EQ(refined(2.0, 2), refined(kInfiniteSharpness, 2));
  EXPECT_EQ(refined(1.5, 2), refined(kInfiniteSharpness, 2));
  EXPECT_NE(refined(2.0, 3), refined(kInfiniteSharpness, 3));
}

/// At its poles the weights of 360 neighbours stay small: no vertex is thrown far out.
TEST(Butterfly, TakesAPoleOf360) {
  const Mesh mesh = test::bipyramid(360);
  const RefinedSurface fine = refine(Topology(mesh), kModified, mesh.points, 3);
  EXPECT_TRUE(fine.values.allFinite());
  EXPECT_LT(fine.values.rowwise().norm().maxCoeff(), 1.5 * mesh.points.rowwise().norm().maxCoeff());
}

TEST(Butterfly, RefusesOtherFacesAndTellsWhatToDo) {
  const Topology topology(cube());
  try {
    const Refinement step(topology, kModified);
    FAIL() << "took quads";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::NotTriangles);
    EXPECT_NE(std::string(error.what()).find("Modified Butterfly"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("triangulate it"), std::string::npos);
  }
  Scheme endless = kModified;
  endless.tension = std::nan("");
  EXPECT_THROW(Refinement(Topology(icosahedron()), endless), Error);
}

}  // namespace
}  // namespace batten
