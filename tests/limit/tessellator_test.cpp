#include "batten/limit/tessellator.h"

#include <gtest/gtest.h>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "support/shapes.h"
#include "support/tessellation.h"

namespace batten {
namespace {

Scheme scheme_of(SchemeKind kind) {
  Scheme scheme;
  scheme.kind = kind;
  return scheme;
}

void expect_refinement(const Mesh& mesh, const Scheme& scheme, int levels) {
  const Topology topology(mesh);
  const test::TessellationErrors errors = test::compare_with_refinement<double>(topology, scheme, mesh.points, levels);
  EXPECT_LE(errors.refined, 1e-14);
  EXPECT_LE(errors.limit, 1e-14);
  EXPECT_LE(errors.normal, 1e-9);
}

TEST(Tessellator, IsRefinementOnSmoothAndTaggedShapes) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    for (const unsigned seed : {0U, 1U, 2U}) {
      SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
      Mesh mesh = test::jittered(sample.mesh, 0.05, 7);
      if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
      const bool flat = sample.name.find("dihedron") != std::string::npos;
      if (flat) continue;  // no normals at valence 2
      expect_refinement(mesh, scheme_of(SchemeKind::CatmullClark), 3);
      if (all_triangles(mesh)) expect_refinement(mesh, scheme_of(SchemeKind::Loop), 3);
    }
  }
}

TEST(Tessellator, SharesWhatOccursOften) {
  // A refined hull: its triangles make hundreds of vertices of valence 3 between few other kinds.
  const Mesh hull = test::random_hull(200, 3);
  const Topology coarse(hull);
  const RefinedSurface once = refine(coarse, scheme_of(SchemeKind::CatmullClark), hull.points, 1);
  Mesh mesh = mesh_from_topology(once.topology);
  mesh.points = once.values;
  expect_refinement(mesh, scheme_of(SchemeKind::CatmullClark), 4);
}

TEST(Tessellator, TakesLaisAlphaInTheFirstStepOnly) {
  Scheme scheme = scheme_of(SchemeKind::CatmullClark);
  scheme.alpha = 0.5;
  expect_refinement(test::jittered(cube(), 0.1, 3), scheme, 3);
}

TEST(Tessellator, TakesAnyNumberOfColumns) {
  const Mesh mesh = test::jittered(torus(7, 5), 0.02, 4);
  const Topology topology(mesh);
  const Tessellator tessellator(topology, scheme_of(SchemeKind::CatmullClark), 3);
  const auto count = static_cast<std::size_t>(tessellator.vertex_count());
  Buffer<double> three(3 * count);
  tessellator.refined<double>(mesh.points, three);
  for (const int k : {1, 2, 4, 7}) {
    Values values(mesh.vertex_count(), k);
    for (int c = 0; c < k; ++c) values.col(c) = (c + 1.0) * mesh.points.col(c % 3);
    Buffer<double> out(static_cast<std::size_t>(k) * count);
    tessellator.refined<double>(values, out);
    for (std::size_t v = 0; v < count; ++v) {
      for (int c = 0; c < k; ++c) ASSERT_NEAR(out[v * k + c], (c + 1.0) * three[3 * v + c % 3], 1e-13);
    }
  }
}

TEST(Tessellator, HasTheSameBitsForAnyNumberOfThreads) {
  const Mesh mesh = test::jittered(test::random_hull(400, 5), 0.01, 6);
  const Topology topology(mesh);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return tessellate<float>(topology, scheme_of(SchemeKind::Loop), mesh.points, 4, {true, true});
  };
  const Tessellation<float> one = run(1);
  const Tessellation<float> two = run(2);
  EXPECT_TRUE(one.points == two.points);
  EXPECT_TRUE(one.normals == two.normals);
  EXPECT_TRUE(one.faces == two.faces);
}

TEST(Tessellator, KeepsFloatsExactFarFromTheOrigin) {
  // The rounding of a float at 1000 is 6e-5; sums of sixteen terms around the origin would lose a digit.
  Mesh mesh = test::jittered(torus(9, 6), 0.02, 4);
  mesh.points.array() += 1000.0;
  const Topology topology(mesh);
  const Tessellator tessellator(topology, scheme_of(SchemeKind::CatmullClark), 3);
  Buffer<double> exact(3 * static_cast<std::size_t>(tessellator.vertex_count()));
  Buffer<float> rounded(exact.size());
  tessellator.refined<double>(mesh.points, exact);
  tessellator.refined<float>(mesh.points, rounded);
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, std::abs(exact[i] - rounded[i]));
  EXPECT_LE(worst, 1.5 * 6.2e-5);
}

TEST(Tessellator, MeasuresTinySurfacesToo) {
  Mesh mesh = test::jittered(torus(9, 6), 0.02, 4);
  const Topology topology(mesh);
  const Scheme scheme = scheme_of(SchemeKind::CatmullClark);
  const Tessellation<float> plain = tessellate<float>(topology, scheme, mesh.points, 2, {true, true});
  const Tessellation<float> tiny = tessellate<float>(topology, scheme, mesh.points * 0x1p-60, 2, {true, true});
  EXPECT_TRUE(plain.normals == tiny.normals);
}

TEST(Tessellator, NamesWhatIsWrong) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const auto code_of = [](const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  EXPECT_EQ(code_of([&] { Tessellator(topology, Scheme(), 0); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([&] { Tessellator(topology, Scheme(), 15); }), ErrorCode::TooLarge);
  EXPECT_EQ(code_of([&] { Tessellator(topology, scheme_of(SchemeKind::Loop), 2); }), ErrorCode::NotTriangles);
  const Tessellator tessellator(topology, Scheme(), 2);
  Buffer<float> small(5);
  Buffer<Index> few(5);
  EXPECT_EQ(code_of([&] { tessellator.refined<float>(mesh.points, small); }), ErrorCode::BadShape);
  EXPECT_EQ(code_of([&] { tessellator.refined<float>(mesh.points.topRows(3), small); }), ErrorCode::BadShape);
  EXPECT_EQ(code_of([&] { tessellator.faces(few); }), ErrorCode::BadShape);
}

TEST(Tessellator, GivesNothingForNothing) {
  Mesh mesh;
  mesh.points.resize(2, 3);
  mesh.points << 0, 1, 2, 3, 4, 5;
  const Topology topology(mesh);
  const Tessellation<double> points = tessellate<double>(topology, Scheme(), mesh.points, 3);
  EXPECT_EQ(points.points, Buffer<double>({0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(points.faces.empty());
}

}  // namespace
}  // namespace batten
