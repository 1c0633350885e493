#include "batten/expand/sharpen.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "batten/error.h"
#include "batten/expand/denoise.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

SharpenResult sharpened(const Mesh& mesh, const SharpenOptions& options = {}) {
  return sharpen(Topology(mesh), test::kCatmullClark, mesh.points, options);
}

/// Two grids that cross at a right angle, n by n each.
Mesh crossed(Index n, double shift) {
  const Mesh flat = grid(n, n);
  Mesh mesh = flat;
  for (Index f = 0; f < flat.face_count(); ++f) {
    for (Index i = flat.face_offsets[f]; i < flat.face_offsets[f + 1]; ++i)
      mesh.face_vertices.push_back(flat.face_vertices[i] + flat.vertex_count());
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  mesh.points.resize(2 * flat.vertex_count(), 3);
  mesh.points.topRows(flat.vertex_count()) = flat.points;
  for (Index v = 0; v < flat.vertex_count(); ++v)
    mesh.points.row(flat.vertex_count() + v) << flat.points(v, 0) + 0.013, 0.017, flat.points(v, 1) + shift;
  return mesh;
}

/// Every pair of triangles of the mesh, tested by solving for where each edge meets the other's plane.
std::int64_t brute_force(const Mesh& mesh) {
  const Mesh triangles = triangulated(mesh);
  std::vector<Index> face_of;
  for (Index f = 0; f < mesh.face_count(); ++f) face_of.insert(face_of.end(), mesh.face_size(f) - 2, f);
  const auto corner = [&](Index t, int i) { return triangles.face_vertices[3 * t + i % 3]; };
  const auto at = [&](Index v) { return Eigen::Vector3d(triangles.points.row(v).transpose()); };
  const auto runs_through = [&](Index s, Index t) {
    for (int i = 0; i < 3; ++i) {
      bool touches = false;
      for (int k = 0; k < 3; ++k) touches = touches || corner(t, k) == corner(s, i) || corner(t, k) == corner(s, i + 1);
      if (touches) continue;
      Eigen::Matrix3d system;
      system << at(corner(s, i)) - at(corner(s, i + 1)), at(corner(t, 1)) - at(corner(t, 0)),
          at(corner(t, 2)) - at(corner(t, 0));
      if (std::abs(system.determinant()) < 1e-14) continue;
      const Eigen::Vector3d x = system.inverse() * (at(corner(s, i)) - at(corner(t, 0)));
      if (x[0] > 0.0 && x[0] < 1.0 && x[1] > 0.0 && x[2] > 0.0 && x[1] + x[2] < 1.0) return true;
    }
    return false;
  };
  std::int64_t count = 0;
  for (Index s = 0; s < triangles.face_count(); ++s) {
    for (Index t = s + 1; t < triangles.face_count(); ++t) {
      int shared = 0;
      for (int i = 0; i < 9; ++i) shared += corner(s, i / 3) == corner(t, i % 3) ? 1 : 0;
      if (face_of[s] == face_of[t] || shared > 1) continue;
      count += runs_through(s, t) || runs_through(t, s) ? 1 : 0;
    }
  }
  return count;
}

TEST(SelfIntersections, AreThoseOfAllPairs) {
  std::vector<Mesh> meshes{crossed(9, 0.0), crossed(9, 0.98), test::jittered(torus(20, 12), 0.15, 1),
                           test::jittered(torus(20, 12), 0.4, 2), test::mesh_of_faces(6, {{0, 1, 2}, {3, 4, 5}})};
  for (const test::NamedMesh& sample : test::sample_meshes()) meshes.push_back(test::jittered(sample.mesh, 0.7, 3));
  std::int64_t all = 0;
  for (const Mesh& mesh : meshes) {
    const SelfIntersections found = find_self_intersections(Topology(mesh), mesh.points);
    EXPECT_EQ(found.count, brute_force(mesh));
    EXPECT_EQ(found.faces.size(), static_cast<std::size_t>(std::min<std::int64_t>(10, found.count)));
    all += found.count;
  }
  EXPECT_GT(all, 300);
}

TEST(SelfIntersections, AreNoneOnSmoothShapes) {
  for (const Mesh& mesh : {torus(200, 100), grid(80, 80), cube(), icosahedron(), crossed(20, 1.5)})
    EXPECT_EQ(find_self_intersections(Topology(mesh), mesh.points).count, 0);
}

TEST(SelfIntersections, FoldedFacesAreCounted) {
  const Mesh mesh = grid(4, 4);
  Points folded = mesh.points;
  folded(2 * 5 + 2, 0) += 1.2;  // past its neighbour: two faces to its right turn over
  EXPECT_EQ(count_turned_faces(Topology(mesh), mesh.points, folded), 2);
  EXPECT_EQ(count_turned_faces(Topology(mesh), mesh.points, mesh.points), 0);
}

/// Against the dense matrix: E + amount sum G^i.
TEST(Sharpen, AddsTheTermsItIsAskedFor) {
  const Mesh mesh = test::jittered(torus(12, 8), 0.02, 1);
  const Topology topology(mesh);
  const Index count = mesh.vertex_count();
  const Values g = Values::Identity(count, count) - LimitMatrix(topology, test::kCatmullClark).matrix().toDense();
  const Values step = Values::Identity(count, count) + 0.3 * (g * g + g * g * g + g * g * g * g);
  SharpenOptions options;
  options.m = 2;
  options.n = 4;
  options.passes = 2;
  options.amount = 0.3;
  const SharpenResult result = sharpened(mesh, options);
  EXPECT_EQ(result.amount, 0.3);
  EXPECT_NEAR(result.growth, 1.9 * 1.9, 1e-12);
  EXPECT_LT((result.points - step * step * mesh.points).cwiseAbs().maxCoeff(), 1e-13);
}

/// The bound holds for the worst possible detail, the two-colouring of an even prism, where a = 0.
TEST(Sharpen, GrowsNoDetailBeyondTheBound) {
  Mesh mesh = cube();
  const Topology topology(mesh);
  for (Index v = 0; v < 8; ++v) {
    const int ups =
        (mesh.points(v, 0) > 0.0 ? 1 : 0) + (mesh.points(v, 1) > 0.0 ? 1 : 0) + (mesh.points(v, 2) > 0.0 ? 1 : 0);
    mesh.points.row(v).setConstant(ups % 2 == 0 ? 1.0 : -1.0);
  }
  SharpenOptions options;
  for (const int passes : {1, 3, 20}) {
    for (const double most : {1.0, 2.0, 50.0}) {
      options.passes = passes;
      options.most_growth = most;
      options.amount = 100.0;
      const SharpenResult result = sharpen(topology, test::kCatmullClark, mesh.points, options);
      EXPECT_NEAR(result.points.cwiseAbs().maxCoeff(), most, 1e-9 * most);
      EXPECT_NEAR(result.growth, most, 1e-9 * most);
    }
  }
}

TEST(Sharpen, SaysWhenTheResultPassesThroughItself) {
  const Mesh mesh = test::jittered(torus(40, 20), 0.01, 1);
  SharpenOptions options;
  options.amount = 0.5;
  const SharpenResult mild = sharpened(mesh, options);
  EXPECT_EQ(mild.before.count, 0);
  EXPECT_EQ(mild.after.count, 0);
  options.passes = 12;
  options.amount = 1.0;
  options.most_growth = 1e4;
  const SharpenResult wild = sharpened(mesh, options);
  EXPECT_GT(wild.after.count, 0);
  EXPECT_GT(wild.turned_faces, 0);
}

/// Denoising blurs a wave of six edges a little; sharpening brings it back nearer to what it was.
TEST(Sharpen, BringsBackWhatDenoisingTook) {
  Mesh mesh = grid(30, 30);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    mesh.points(v, 2) = 0.05 * std::cos(mesh.points(v, 0) * 15.0 * 2.0 * std::numbers::pi / 6.0);
  DenoiseOptions smooth;
  smooth.m = 0;
  smooth.passes = 2;
  smooth.keep_boundary = true;
  Mesh blurred = mesh;
  blurred.points = denoise(mesh, test::kCatmullClark, smooth).points;
  SharpenOptions options;
  options.keep_boundary = true;
  options.amount = 2.0;
  options.most_growth = 100.0;
  const auto error = [&](const Points& points) {
    double sum = 0.0;
    for (Index j = 8; j <= 22; ++j) {
      for (Index i = 8; i <= 22; ++i) sum += std::pow(points(31 * j + i, 2) - mesh.points(31 * j + i, 2), 2);
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(error(sharpened(blurred, options).points), 0.5 * error(blurred.points));
}

TEST(Sharpen, ThreadsDoNotChangeABit) {
  const Mesh mesh = test::jittered(torus(120, 60), 0.02, 1);
  const SharpenResult all = sharpened(mesh);
  const ThreadLimit limit(1);
  const SharpenResult one = sharpened(mesh);
  EXPECT_TRUE((all.points.array() == one.points.array()).all());
  EXPECT_EQ(all.after.faces, one.after.faces);
}

TEST(Sharpen, RefusesWhatMakesNoSense) {
  const auto refuses = [](const auto& change) {
    SharpenOptions options;
    change(options);
    EXPECT_THROW(sharpened(cube(), options), Error);
  };
  refuses([](SharpenOptions& options) { options.m = 0; });
  refuses([](SharpenOptions& options) { options.n = 0; });
  refuses([](SharpenOptions& options) { options.passes = -1; });
  refuses([](SharpenOptions& options) { options.amount = -0.1; });
  refuses([](SharpenOptions& options) { options.amount = std::nan(""); });
  refuses([](SharpenOptions& options) { options.most_growth = 0.9; });
}

}  // namespace
}  // namespace batten
