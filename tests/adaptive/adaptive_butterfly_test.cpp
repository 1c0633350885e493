#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "batten/adaptive/adaptive.h"
#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/tessellate/tessellator.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

const Scheme kModified = test::scheme_of(SchemeKind::ModifiedButterfly);

Index boundary_edges(const Topology& topology) {
  Index count = 0;
  for (Index e = 0; e < topology.edge_count(); ++e) count += topology.is_boundary_edge(e) ? 1 : 0;
  return count;
}

/// Where a boundary passes by a single triangle the normal depends on the level (limit/butterfly_normals.h).
bool in_single_triangle(const Topology& topology, const SurfacePlace& place) {
  const Index first = topology.face_begin(place.face);
  const Index corner = place.u == 1.0 ? 1 : (place.v == 1.0 ? 2 : (place.u + place.v == 0.0 ? 0 : -1));
  if (corner < 0) return false;
  const Index vertex = topology.origin(first + corner);
  return topology.is_boundary_vertex(vertex) && topology.vertex_face_count(vertex) == 1;
}

/// Every vertex is the one that the uniform tessellation has at its place, and its normal too.
void expect_subset(const Mesh& mesh, const Scheme& scheme, const AdaptiveMesh& adaptive) {
  const int levels = std::max(adaptive.deepest_level, 1);
  const Topology topology(mesh);
  const Tessellator uniform(topology, scheme, levels);
  const auto count = static_cast<std::size_t>(uniform.vertex_count());
  Buffer<double> points(3 * count);
  Buffer<double> normals(3 * count);
  uniform.limit<double>(mesh.points, points, normals);
  // Normals of a side each at creases: which is the vertex's own may differ.
  const Values& own = adaptive.mesh.attributes.front().values;
  for (Index v = 0; v < adaptive.mesh.vertex_count(); ++v) {
    const SurfacePlace& place = adaptive.places[v];
    const double i = place.u * uniform.steps();
    const double j = place.v * uniform.steps();
    ASSERT_EQ(i, std::floor(i));
    ASSERT_EQ(j, std::floor(j));
    const Index other = uniform.vertex(place.face, static_cast<Index>(i), static_cast<Index>(j));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(adaptive.mesh.points(v, c), points[3 * other + c], 1e-14);
      if (!topology.has_creases() && !in_single_triangle(topology, place)) {
        EXPECT_NEAR(own(v, c), normals[3 * other + c], 1e-9);
      }
    }
  }
}

TEST(AdaptiveButterfly, TakesVerticesOfTheUniformMeshWithoutCracks) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name == "dihedron" || sample.name == "bipyramid") continue;  // flat; too many faces for a test
    SCOPED_TRACE(sample.name);
    const Mesh mesh = triangulated(sample.mesh);
    AdaptiveOptions options;
    options.angle = 12.0;
    options.max_level = 5;
    const AdaptiveMesh adaptive = tessellate_adaptively(Topology(mesh), kModified, mesh.points, options);
    expect_subset(mesh, kModified, adaptive);
    // A crack would be a boundary that the mesh does not have; with a Topology of it there are no T-junctions.
    const Topology coarse(mesh);
    const Topology fine(adaptive.mesh);
    if (boundary_edges(coarse) == 0) {
      EXPECT_EQ(boundary_edges(fine), 0);
    }
    const auto euler = [](const Topology& t, Index isolated) {
      return t.vertex_count() - isolated - t.edge_count() + t.face_count();
    };
    Index isolated = 0;
    for (Index v = 0; v < coarse.vertex_count(); ++v) isolated += coarse.is_isolated(v) ? 1 : 0;
    EXPECT_EQ(euler(fine, 0), euler(coarse, isolated));
    EXPECT_GE(adaptive.mesh.face_count(), mesh.face_count());
  }
}

TEST(AdaptiveButterfly, KeepsCreases) {
  Mesh mesh = test::jittered(icosahedron(), 0.05, 3);
  const Topology plain(mesh);
  for (const Index e : {0, 1, 7}) {
    const Index h = plain.edge_half_edge(e);
    mesh.creases.push_back({plain.origin(h), plain.destination(h), e == 7 ? 2.0 : kInfiniteSharpness});
  }
  AdaptiveOptions options;
  options.edge_length = 0.15;
  const AdaptiveMesh adaptive = tessellate_adaptively(Topology(mesh), kModified, mesh.points, options);
  expect_subset(mesh, kModified, adaptive);
  EXPECT_EQ(boundary_edges(Topology(adaptive.mesh)), 0);
  EXPECT_EQ(adaptive.mesh.attributes.size(), 2U);  // normals at corners too, a side each
}

TEST(AdaptiveButterfly, MeetsAnEdgeLength) {
  const Mesh mesh = test::jittered(icosahedron(), 0.1, 2);
  AdaptiveOptions options;
  options.edge_length = 0.2;
  const AdaptiveMesh adaptive = tessellate_adaptively(Topology(mesh), kModified, mesh.points, options);
  EXPECT_LE(adaptive.longest_edge, options.edge_length);
  EXPECT_GT(adaptive.longest_edge, 0.5 * options.edge_length);
  const Topology fine(adaptive.mesh);
  for (Index e = 0; e < fine.edge_count(); ++e) {
    const Index h = fine.edge_half_edge(e);
    const auto& points = adaptive.mesh.points;
    EXPECT_LE((points.row(fine.origin(h)) - points.row(fine.destination(h))).norm(), options.edge_length);
  }
}

/// Deep where requested, coarse elsewhere.
TEST(AdaptiveButterfly, CutsWhatYouSay) {
  const Mesh mesh = icosahedron();
  const Eigen::RowVector3d target = mesh.points.row(0);
  AdaptiveOptions options;
  options.max_level = 6;
  options.cut = [&](const AdaptiveFace& face) {
    return (face.points.rowwise() - target).rowwise().norm().minCoeff() < 1e-12;
  };
  const AdaptiveMesh adaptive = tessellate_adaptively(Topology(mesh), kModified, mesh.points, options);
  EXPECT_EQ(adaptive.deepest_level, 6);
  EXPECT_LT(adaptive.mesh.face_count(), 600);  // uniform: 81,920
  expect_subset(mesh, kModified, adaptive);
}

TEST(AdaptiveButterfly, RefusesWhatItHasNot) {
  const Mesh mesh = icosahedron();
  const Topology topology(mesh);
  const auto message = [&](const AdaptiveOptions& options) -> std::string {
    try {
      tessellate_adaptively(topology, kModified, mesh.points, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  AdaptiveOptions chord;
  chord.chord = 0.01;
  EXPECT_NE(message(chord).find("edge length"), std::string::npos);
  AdaptiveOptions quads;
  quads.angle = 10.0;
  quads.faces = FaceKind::Quads;
  EXPECT_NE(message(quads).find("triangles"), std::string::npos);
}

}  // namespace
}  // namespace batten
