#include "batten/surface/limit_surface.h"

#include <gtest/gtest.h>

#include <random>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "batten/scheme/masks.h"
#include "batten/tessellate/tessellator.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::scheme_of;

/// Points and normals at the grids' points, which the tessellator knows by other means.
void expect_the_tessellators_limits(const Mesh& mesh, const Scheme& scheme, const std::string& name) {
  SCOPED_TRACE(name);
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  const Tessellator tessellator(topology, scheme, 4);
  Buffer<double> points(3 * static_cast<std::size_t>(tessellator.vertex_count()));
  Buffer<double> normals(points.size());
  tessellator.limit<double>(mesh.points, points, normals);
  const Topology& base = surface.base();
  ASSERT_EQ(base.face_count(), tessellator.base().face_count());
  const Index n = tessellator.steps();
  const bool quads = tessellator.face_size() == 4;
  double worst = 0.0;
  double worst_normal = 0.0;
  for (Index f = 0; f < base.face_count(); ++f) {
    for (Index j = 0; j <= n; ++j) {
      for (Index i = 0; i <= n - (quads ? 0 : j); ++i) {
        const Index v = tessellator.vertex(f, i, j);
        const Jet jet = surface.jet({f, static_cast<double>(i) / n, static_cast<double>(j) / n});
        worst =
            std::max(worst, (jet.point - Eigen::Vector3d(points[3 * v], points[3 * v + 1], points[3 * v + 2])).norm());
        const bool inside = i > 0 && j > 0 && (quads ? i < n && j < n : i + j < n);
        if (!inside) continue;  // at creases the tessellator has the normal of one side
        const Eigen::Vector3d normal(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
        worst_normal = std::max(worst_normal, (jet.du.cross(jet.dv).normalized() - normal).norm());
      }
    }
  }
  EXPECT_LE(worst, 1e-13 * bounding_diagonal(mesh.points));
  EXPECT_LE(worst_normal, 1e-9);
}

TEST(LimitSurface, PassesThroughWhatTheTessellatorMakes) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name == "dihedron") continue;  // no normals at valence 2
    for (const unsigned seed : {0U, 1U}) {
      const Mesh mesh = seed > 0 ? test::with_random_tags(sample.mesh, seed) : sample.mesh;
      const std::string name = sample.name + (seed > 0 ? ", tagged" : "");
      expect_the_tessellators_limits(mesh, scheme_of(SchemeKind::CatmullClark), name);
      if (all_triangles(mesh)) expect_the_tessellators_limits(mesh, scheme_of(SchemeKind::Loop), name + ", Loop");
    }
  }
}

/// Sharp and half sharp edges in turn: the midpoint of an edge that leaves a face depends on what is beyond its end.
/// All faces have one of two surroundings, so that they share their tables.
TEST(LimitSurface, SeesBothEndsOfAnEdgeUnderChaikinsRule) {
  const Index across = 8;
  Mesh mesh = test::jittered(torus(12, across), 0.05, 7);
  const Topology plain(mesh);
  for (Index e = 0; e < plain.edge_count(); ++e) {
    const Index h = plain.edge_half_edge(e);
    const Index a = std::min(plain.origin(h), plain.destination(h));
    const Index b = std::max(plain.origin(h), plain.destination(h));
    if (a % across != b % across) continue;
    const Index row = b - a == across ? a / across : b / across;  // the last row's edges lead back to the first
    mesh.creases.push_back({a, b, row % 2 == 0 ? 6.0 : 0.9});
  }
  Scheme scheme;
  scheme.crease_method = CreaseMethod::Chaikin;
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  // The face points of the second step are the middles of the quarters.
  const RefinedSurface twice = refine(topology, scheme, mesh.points, 2);
  const Values limit = LimitMatrix(twice.topology, scheme).apply(twice.values);
  const Index first = twice.topology.vertex_count() - 4 * topology.face_count();
  double worst = 0.0;
  for (Index f = 0; f < topology.face_count(); ++f) {
    for (Index c = 0; c < 4; ++c) {
      const Jet jet = surface.jet({f, c == 1 || c == 2 ? 0.75 : 0.25, c >= 2 ? 0.75 : 0.25});
      worst = std::max(worst, (jet.point - limit.row(first + 4 * f + c).transpose()).norm());
    }
  }
  EXPECT_LE(worst, 1e-14);
  expect_the_tessellators_limits(mesh, scheme, "torus");
}

/// Places inside faces, some of them close to a corner.
std::vector<SurfacePlace> random_places(const Topology& base, bool quads, int count, double nearness) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<SurfacePlace> places;
  for (int i = 0; i < count; ++i) {
    double u = unit(random) * nearness;
    double v = unit(random) * nearness;
    if (!quads && u + v > nearness) u = nearness - u, v = nearness - v;
    places.push_back({static_cast<Index>(random() % static_cast<unsigned>(base.face_count())), u, v});
  }
  return places;
}

TEST(LimitSurface, HasTheDerivativesOfItsPoints) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    if (name.find("dihedron") != std::string::npos) return;
    SCOPED_TRACE(name);
    const Topology topology(mesh);
    const LimitSurface surface(topology, scheme, mesh.points);
    for (const double nearness : {1.0, 0.01}) {
      for (const SurfacePlace& place : random_places(surface.base(), scheme.kind != SchemeKind::Loop, 200, nearness)) {
        // Central differences; a step small against the distance to every corner keeps to one polynomial, mostly.
        const double h =
            1e-4 * std::min({place.u, place.v, 1.0 - place.u - (scheme.kind == SchemeKind::Loop ? place.v : 0.0),
                             1.0 - place.v});
        if (h < 1e-8) continue;
        const auto at = [&](double du, double dv) { return surface.jet({place.face, place.u + du, place.v + dv}); };
        const Jet jet = at(0, 0);
        const double size = jet.du.norm() + jet.dv.norm();
        EXPECT_LE(((at(h, 0).point - at(-h, 0).point) / (2 * h) - jet.du).norm(), 1e-5 * size);
        EXPECT_LE(((at(0, h).point - at(0, -h).point) / (2 * h) - jet.dv).norm(), 1e-5 * size);
        const double bend = jet.duu.norm() + jet.duv.norm() + jet.dvv.norm() + size;
        EXPECT_LE(((at(h, 0).du - at(-h, 0).du) / (2 * h) - jet.duu).norm(), 1e-2 * bend);
        EXPECT_LE(((at(0, h).du - at(0, -h).du) / (2 * h) - jet.duv).norm(), 1e-2 * bend);
        EXPECT_LE(((at(0, h).dv - at(0, -h).dv) / (2 * h) - jet.dvv).norm(), 1e-2 * bend);
      }
    }
  });
}

/// Where u + v = 1 rounding may put a place outside every part of the face.
TEST(LimitSurface, HasNoJumpsAlongATrianglesThirdSide) {
  const Mesh mesh = test::jittered(octahedron(), 0.05, 7);
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme_of(SchemeKind::Loop), mesh.points);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double v = unit(random);
    const double u = 1.0 - v;
    const Eigen::Vector3d on_side = surface.jet({i % 8, u, v}).point;
    EXPECT_LE((surface.jet({i % 8, u * (1.0 - 1e-9), v * (1.0 - 1e-9)}).point - on_side).norm(), 1e-7);
  }
}

/// Neighbours agree on the points of their common edge, and on its normals where it is not sharp.
TEST(LimitSurface, IsContinuousAcrossFacesAndSmoothButForCreases) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    if (name.find("dihedron") != std::string::npos) return;  // no normals at valence 2
    SCOPED_TRACE(name);
    const Topology topology(mesh);
    const LimitSurface surface(topology, scheme, mesh.points);
    const Topology& base = surface.base();
    const bool quads = scheme.kind != SchemeKind::Loop;
    const auto at = [&](Index h, double t) {
      const double us[4] = {0.0, 1.0, quads ? 1.0 : 0.0, 0.0};
      const double vs[4] = {0.0, 0.0, 1.0, 1.0};
      const Index size = base.face_size(base.face(h));
      const Index from = h - base.face_begin(base.face(h));
      const Index to = (from + 1) % size;
      return surface.jet({base.face(h), (1.0 - t) * us[from] + t * us[to], (1.0 - t) * vs[from] + t * vs[to]});
    };
    for (Index e = 0; e < base.edge_count(); ++e) {
      if (base.is_boundary_edge(e)) continue;
      const Index h = base.edge_half_edge(e);
      for (const double t : {0.0, 0.125, 0.5, 0.8125, 1.0}) {
        const Jet here = at(h, t);
        const Jet there = at(base.twin(h), 1.0 - t);
        EXPECT_LE((here.point - there.point).norm(), 1e-13 * bounding_diagonal(mesh.points)) << "edge " << e;
        if (base.edge_sharpness(e) >= kInfiniteSharpness || t == 0.0 || t == 1.0) continue;
        const Eigen::Vector3d normal = here.du.cross(here.dv).normalized();
        EXPECT_LE((normal - there.du.cross(there.dv).normalized()).norm(), 1e-9) << "edge " << e << " at " << t;
      }
    }
  });
}

TEST(LimitSurface, MovesWithItsControlPoints) {
  // Weights sum to 1 and their derivatives to 0: an affine map of the control points is one of the surface.
  Eigen::Matrix3d map;
  map << 1.0, 0.5, -0.25, 0.125, -2.0, 0.75, 0.0, 0.5, 1.5;
  const Eigen::Vector3d shift(3.0, -1.0, 2.0);
  test::for_each_sample([&](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    const Topology topology(mesh);
    const LimitSurface surface(topology, scheme, mesh.points);
    Points moved = mesh.points * map.transpose();
    moved.rowwise() += shift.transpose();
    const LimitSurface image(topology, scheme, moved);
    for (const SurfacePlace& place : random_places(surface.base(), scheme.kind != SchemeKind::Loop, 100, 0.5)) {
      const Jet jet = surface.jet(place);
      const Jet other = image.jet(place);
      const double size = 1e-13 * (1.0 + bounding_diagonal(moved));
      EXPECT_LE((map * jet.point + shift - other.point).norm(), size);
      EXPECT_LE((map * jet.du - other.du).norm(), 10.0 * size);
      EXPECT_LE((map * jet.dv - other.dv).norm(), 10.0 * size);
    }
  });
}

/// At an extraordinary vertex the tangent plane is what the planes nearby tend to.
TEST(LimitSurface, HasATangentPlaneAtExtraordinaryVertices) {
  for (const Index valence : {3, 4, 5, 6, 7, 8, 12, 64, 360}) {
    for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
      SCOPED_TRACE(valence);
      const Mesh mesh = test::jittered(test::bipyramid(valence), 0.2 / valence, 3);
      const Topology topology(mesh);
      const LimitSurface surface(topology, scheme_of(kind), mesh.points);
      const Topology& base = surface.base();
      // The pole is vertex `valence` of the mesh: a corner of a base face.
      const Index h = base.vertex_half_edge(valence);
      const Index face = base.face(h);
      const Index corner = h - base.face_begin(face);
      const double us[4] = {0.0, 1.0, kind == SchemeKind::Loop ? 0.0 : 1.0, 0.0};
      const double vs[4] = {0.0, 0.0, 1.0, 1.0};
      const Jet at = surface.jet({face, us[corner], vs[corner]});
      EXPECT_EQ(at.regular, valence == (kind == SchemeKind::Loop ? 6 : 4));
      const Eigen::Vector3d normal = at.du.cross(at.dv).normalized();
      const double t = 1e-7;
      const double middle = kind == SchemeKind::Loop ? 1.0 / 3.0 : 0.5;
      const Jet near =
          surface.jet({face, us[corner] + t * (middle - us[corner]), vs[corner] + t * (middle - vs[corner])});
      EXPECT_LE((near.point - at.point).norm(), 1e-3);
      // From level to level the planes converge by the ratio of the next eigenvalues, which goes to 1 with the valence.
      if (valence <= 12) {
        EXPECT_LE((near.du.cross(near.dv).normalized() - normal).norm(), 2e-2);
      }
      const Values& control = base.vertex_count() == mesh.vertex_count()
                                  ? Values(mesh.points)
                                  : refine(topology, scheme_of(kind), mesh.points, 1).values;
      EXPECT_LE((limit_normals(base, scheme_of(kind), control).vertices.row(valence) - normal.transpose()).norm(),
                1e-12);
      EXPECT_TRUE(near.regular);
    }
  }
}

TEST(LimitSurface, KeepsItsDigitsNextToAnExtraordinaryVertex) {
  // Along the line into the vertex the derivatives scale by the subdominant eigenvalue: their ratio from halving to
  // halving is 2 lambda, whatever the depth.
  const Mesh mesh = icosahedron();
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme_of(SchemeKind::CatmullClark), mesh.points);
  const double lambda = subdominant_eigenvalue(SchemeKind::CatmullClark, 5);
  const Index h = surface.base().vertex_half_edge(0);
  ASSERT_EQ(h % 4, 0);
  const auto slope = [&](int halvings) {
    return surface.jet({h / 4, std::ldexp(1.0, -halvings), std::ldexp(1.0, -halvings)}).du.norm();
  };
  for (const int halvings : {20, 30, 40})
    EXPECT_NEAR(slope(halvings + 1) / slope(halvings), 2.0 * lambda, 1e-6) << halvings;
}

TEST(LimitSurface, BendsAsASphereAndATorusDo) {
  // Interpolated fine meshes come close to the shapes; the curvature of a bicubic spline does so with the second order.
  const Index around = 96;
  const Index across = 48;
  const Mesh mesh = torus(around, across, 2.0, 0.5);
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme_of(SchemeKind::CatmullClark), mesh.points);
  for (Index f = 0; f < surface.base().face_count(); f += 7) {
    const Jet jet = surface.jet({f, 0.3, 0.6});
    const PointCurvature bend = curvature_of(jet);
    const double rho = std::hypot(jet.point.x(), jet.point.y());
    // Catmull-Clark draws the control mesh in a little, by the same factor all over.
    const double tube = std::hypot(rho - 2.0, jet.point.z());
    EXPECT_NEAR(bend.greatest, 1.0 / tube, 0.02);
    EXPECT_NEAR(bend.least, (rho - 2.0) / (rho * tube), 0.02);
    EXPECT_NEAR(bend.mean, 0.5 * (bend.greatest + bend.least), 1e-12);
    EXPECT_NEAR(bend.gaussian, bend.greatest * bend.least, 1e-12);
    EXPECT_NEAR(bend.greatest_direction.dot(bend.least_direction), 0.0, 1e-12);
    EXPECT_NEAR(bend.least_direction.dot(Eigen::Vector3d(-jet.point.y(), jet.point.x(), 0.0)) / rho,
                bend.least_direction.dot(Eigen::Vector3d(-jet.point.y(), jet.point.x(), 0.0)) > 0 ? 1.0 : -1.0, 1e-2);
  }
}

TEST(LimitSurface, CurvatureDoesNotDependOnTheParameters) {
  // z = -(3 x^2 + y^2)/2 at the origin in skew parameters x = u + v/2, y = v.
  Jet jet;
  jet.point.setZero();
  jet.du << 1.0, 0.0, 0.0;
  jet.dv << 0.5, 1.0, 0.0;
  jet.duu << 0.0, 0.0, -3.0;
  jet.duv << 0.0, 0.0, -1.5;
  jet.dvv << 0.0, 0.0, -0.75 - 1.0;
  const PointCurvature bend = curvature_of(jet);
  EXPECT_NEAR(bend.greatest, 3.0, 1e-14);
  EXPECT_NEAR(bend.least, 1.0, 1e-14);
  EXPECT_NEAR(bend.mean, 2.0, 1e-14);
  EXPECT_NEAR(bend.gaussian, 3.0, 1e-14);
  EXPECT_NEAR(std::abs(bend.greatest_direction.x()), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(bend.least_direction.y()), 1.0, 1e-14);
}

TEST(LimitSurface, AnswersInBatchesAndRefusesWhatIsNotThere) {
  const Mesh mesh = test::jittered(dodecahedron(), 0.1, 2);
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme_of(SchemeKind::CatmullClark), mesh.points);
  const std::vector<SurfacePlace> places = random_places(surface.base(), true, 1000, 1.0);
  std::vector<Jet> jets(places.size());
  surface.jets(places, jets);
  for (std::size_t i = 0; i < places.size(); i += 37) EXPECT_EQ(jets[i].dvv, surface.jet(places[i]).dvv);
  const auto code_of = [&](const SurfacePlace& place) {
    try {
      surface.jet(place);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  EXPECT_EQ(code_of({surface.base().face_count(), 0.5, 0.5}), ErrorCode::IndexOutOfRange);
  EXPECT_EQ(code_of({0, 1.5, 0.5}), ErrorCode::BadArgument);
  EXPECT_EQ(code_of({0, 0.5, std::nan("")}), ErrorCode::BadArgument);
}

}  // namespace
}  // namespace batten
