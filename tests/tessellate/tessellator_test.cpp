#include "batten/tessellate/tessellator.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "batten/error.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refined_mesh.h"
#include "support/schemes.h"
#include "support/shapes.h"
#include "support/tessellation.h"

namespace batten {
namespace {

using test::scheme_of;

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

TEST(Tessellator, IsRefinementUnderTheButterflies) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    for (const unsigned seed : {0U, 1U, 2U}) {
      SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
      Mesh mesh = triangulated(test::jittered(sample.mesh, 0.05, 7));
      if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
      if (sample.name.find("dihedron") != std::string::npos) continue;  // flat
      Scheme scheme = scheme_of(SchemeKind::ModifiedButterfly);
      for (const int levels : {1, 2, 4}) expect_refinement(mesh, scheme, levels);
      scheme.tension = 1.0 / 64;
      scheme.butterfly_boundary = ButterflyBoundary::Reflect;
      expect_refinement(mesh, scheme, 3);
      expect_refinement(mesh, scheme_of(SchemeKind::Butterfly), 3);
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

/// Two rows a vertex, a seam where neighbours take different ones, and one face without any.
Attribute seamed(const Mesh& mesh) {
  Attribute uv{"uv", Values::Random(2 * mesh.vertex_count(), 2), Buffer<Index>(mesh.face_vertices.size())};
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
      uv.corner_rows[c] = f == 1 ? -1 : 2 * mesh.face_vertices[c] + (f % 3 == 0 ? 1 : 0);
    }
  }
  return uv;
}

/// A face by its corners' places, and what stands at them: sorted, so that order does not matter.
using CornerValues = std::vector<std::array<double, 5>>;

template <typename Rows>
CornerValues corner_values(const Rows& points, const Index* vertices, const Attribute& uv, const Index* rows,
                           Index size) {
  CornerValues face;
  for (Index c = 0; c < size; ++c) {
    const bool has = rows[c] >= 0;
    face.push_back({points(vertices[c], 0), points(vertices[c], 1), points(vertices[c], 2),
                    has ? uv.values(rows[c], 0) : -9.0, has ? uv.values(rows[c], 1) : -9.0});
    for (double& number : face.back()) number = std::round(1e9 * number);
  }
  std::sort(face.begin(), face.end());
  return face;
}

std::vector<CornerValues> all_corner_values(const Values& points, const Buffer<Index>& faces, const Attribute& uv,
                                            Index size) {
  std::vector<CornerValues> all;
  for (std::size_t c = 0; c < faces.size(); c += static_cast<std::size_t>(size)) {
    all.push_back(corner_values(points, &faces[c], uv, &uv.corner_rows[c], size));
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::size_t distinct(Buffer<Index> rows) {
  std::sort(rows.begin(), rows.end());
  return static_cast<std::size_t>(std::unique(rows.begin(), rows.end()) - rows.begin());
}

TEST(Tessellator, CarriesCornersAsRefinementDoesLevelByLevel) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    for (const test::NamedMesh& sample : test::sample_meshes()) {
      if ((kind == SchemeKind::Loop && !all_triangles(sample.mesh)) || sample.mesh.face_count() < 3) continue;
      SCOPED_TRACE(sample.name);
      Mesh mesh = test::jittered(sample.mesh, 0.05, 7);
      mesh.attributes = {seamed(mesh)};
      mesh.holes = {2};
      const Topology topology(mesh);
      constexpr int kLevels = 3;
      const Tessellator tessellator(topology, scheme_of(kind), kLevels);
      const Index size = tessellator.face_size();
      Values points(tessellator.vertex_count(), 3);
      tessellator.refined<double>(mesh.points, {points.data(), static_cast<std::size_t>(points.size())});
      Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) * static_cast<std::size_t>(size));
      tessellator.faces(faces);
      const Attribute ours = tessellator.at_corners(mesh.attributes[0]);
      ASSERT_EQ(ours.corner_rows.size(), faces.size());

      const RefinedMesh refined = refine_mesh(topology, scheme_of(kind), mesh, kLevels);
      Buffer<Index> kept;
      Attribute theirs{"uv", refined.mesh.attributes[0].values, {}};
      for (Index f = 0; f < refined.topology.face_count(); ++f) {
        if (refined.topology.is_hole(f)) continue;
        for (Index h = refined.topology.face_begin(f); h < refined.topology.face_end(f); ++h) {
          kept.push_back(refined.topology.origin(h));
          theirs.corner_rows.push_back(refined.mesh.attributes[0].corner_rows[h]);
        }
      }
      EXPECT_TRUE(all_corner_values(points, faces, ours, size) ==
                  all_corner_values(refined.mesh.points, kept, theirs, size));
      EXPECT_EQ(distinct(ours.corner_rows), distinct(theirs.corner_rows)) << "seams differ";
    }
  }
}

/// Moves one vertex after another; each time the update must leave what a whole evaluation gives, bit for bit.
void expect_updates(const Mesh& mesh, const Scheme& scheme) {
  const Topology topology(mesh);
  const Tessellator tessellator(topology, scheme, 2);
  const auto numbers = 3 * static_cast<std::size_t>(tessellator.vertex_count());
  Points control = mesh.points;
  Buffer<double> points(numbers), normals(numbers), all(numbers), all_normals(numbers);
  tessellator.limit<double>(control, points, normals);
  for (Index vertex = 0; vertex < mesh.vertex_count(); vertex += 1 + mesh.vertex_count() / 8) {
    const Buffer<double> before = points;
    const Index moved[] = {vertex, (vertex + 5) % mesh.vertex_count()};
    for (const Index one : moved) control.row(one) += Eigen::RowVector3d(0.03, -0.02, 0.05);
    std::vector<Index> written = tessellator.limit_around<double>(moved, control, points, normals);
    tessellator.limit<double>(control, all, all_normals);
    ASSERT_EQ(points, all) << vertex;
    ASSERT_EQ(normals, all_normals) << vertex;
    std::sort(written.begin(), written.end());
    EXPECT_EQ(std::adjacent_find(written.begin(), written.end()), written.end()) << "a vertex is written twice";
    for (std::size_t i = 0; i < numbers; ++i) {
      const auto place = static_cast<Index>(i / 3);
      ASSERT_TRUE(points[i] == before[i] || std::binary_search(written.begin(), written.end(), place)) << place;
    }
  }
}

TEST(Tessellator, EvaluatesAgainWhatMovedVerticesReach) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    for (const unsigned seed : {0U, 1U}) {
      SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
      Mesh mesh = test::jittered(sample.mesh, 0.05, 7);
      if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
      expect_updates(mesh, scheme_of(SchemeKind::CatmullClark));
      if (!all_triangles(mesh)) continue;
      expect_updates(mesh, scheme_of(SchemeKind::Loop));
      expect_updates(mesh, scheme_of(SchemeKind::ModifiedButterfly));
    }
  }
}

TEST(Tessellator, EvaluatesFewFacesForOneVertex) {
  const Mesh mesh = torus(60, 40);
  const Tessellator tessellator(Topology(mesh), scheme_of(SchemeKind::CatmullClark), 2);
  const auto numbers = 3 * static_cast<std::size_t>(tessellator.vertex_count());
  Buffer<float> points(numbers), normals(numbers);
  tessellator.limit<float>(mesh.points, points, normals);
  const Index moved[] = {100};
  // 4 by 4 faces have 17 by 17 points, of which the outermost stay, so that it does not matter who writes them.
  const std::size_t written = tessellator.limit_around<float>(moved, mesh.points, points, normals).size();
  EXPECT_GE(written, 15U * 15U);
  EXPECT_LE(written, 17U * 17U);
  const Index none[] = {2400};
  EXPECT_THROW(tessellator.limit_around<float>(none, mesh.points, points, normals), Error);
}

}  // namespace
}  // namespace batten
