/// Modified Butterfly against OpenMesh's on closed triangle meshes.
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>
#include <map>

#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"
#include "conformance_data.h"
#include "support/shapes.h"

namespace batten {
namespace {

using OpenTriangles = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using OpenButterfly = OpenMesh::Subdivider::Uniform::ModifiedButterflyT<OpenTriangles, double>;

OpenTriangles open_mesh(const Mesh& mesh) {
  OpenTriangles target;
  std::vector<OpenTriangles::VertexHandle> handles;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    handles.push_back(target.add_vertex({mesh.points(v, 0), mesh.points(v, 1), mesh.points(v, 2)}));
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* corners = &mesh.face_vertices[mesh.face_offsets[f]];
    target.add_face(handles[corners[0]], handles[corners[1]], handles[corners[2]]);
  }
  return target;
}

/// Their vertex for each of ours after one more step: even ones stay, and a new one has two even neighbours, its ends.
std::vector<int> matched(const Topology& parent, const OpenTriangles& child, const std::vector<int>& before) {
  const int even = static_cast<int>(before.size());
  std::map<std::pair<int, int>, int> between;
  for (int v = even; v < static_cast<int>(child.n_vertices()); ++v) {
    std::vector<int> ends;
    for (const auto& near : child.vv_range(child.vertex_handle(static_cast<unsigned>(v)))) {
      if (near.idx() < even) ends.push_back(near.idx());
    }
    if (ends.size() != 2) ADD_FAILURE() << "their vertex " << v << " has " << ends.size() << " even neighbours";
    between[std::minmax(ends.front(), ends.back())] = v;
  }
  std::vector<int> after = before;
  for (Index e = 0; e < parent.edge_count(); ++e) {
    const Index h = parent.edge_half_edge(e);
    const auto found = between.find(std::minmax(before[parent.origin(h)], before[parent.destination(h)]));
    if (found == between.end()) ADD_FAILURE() << "they have no vertex on edge " << e;
    after.push_back(found == between.end() ? 0 : found->second);
  }
  return after;
}

/// One step after the other, so that the vertices can be told by their ends.
void expect_same_refinement(const Mesh& mesh, int levels) {
  Scheme scheme;
  scheme.kind = SchemeKind::ModifiedButterfly;
  RefinedSurface ours{Topology(mesh), mesh.points};
  OpenTriangles theirs = open_mesh(mesh);
  std::vector<int> vertices(static_cast<std::size_t>(mesh.vertex_count()));
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = static_cast<int>(v);
  // Ten products and sums a level, of points no larger than this.
  const double tolerance = 1e-14 * (1.0 + mesh.points.cwiseAbs().maxCoeff());
  for (int level = 1; level <= levels; ++level) {
    OpenButterfly step;
    step.attach(theirs);
    step(1);
    step.detach();
    vertices = matched(ours.topology, theirs, vertices);
    ours = refine(ours.topology, scheme, ours.values, 1);
    ASSERT_EQ(static_cast<std::size_t>(ours.topology.vertex_count()), theirs.n_vertices());
    double worst = 0.0;
    for (Index v = 0; v < ours.topology.vertex_count(); ++v) {
      const auto& point = theirs.point(theirs.vertex_handle(static_cast<unsigned>(vertices[v])));
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(ours.values(v, c) - point[c]));
    }
    EXPECT_LE(worst, level * tolerance) << "level " << level;
  }
}

Mesh without_tags(Mesh mesh) {
  mesh.creases.clear();
  mesh.corners.clear();
  return mesh;
}

TEST(OpenMeshConformance, ModifiedButterflyOnClosedShapesOfEveryValence) {
  std::vector<test::NamedMesh> shapes{{"tetrahedron", tetrahedron()},      {"octahedron", octahedron()},
                                      {"icosahedron", icosahedron()},      {"torus", test::triangle_torus(7, 5)},
                                      {"pole of 24", test::bipyramid(24)}, {"pole of 60", test::bipyramid(60)},
                                      {"hull", test::random_hull(60, 3)},  {"hull of 300", test::random_hull(300, 4)}};
  for (const test::NamedMesh& shape : shapes) {
    SCOPED_TRACE(shape.name);
    expect_same_refinement(test::jittered(shape.mesh, 0.05, 3), 3);
  }
}

class OpenMeshConformance : public testing::TestWithParam<std::string> {};

TEST_P(OpenMeshConformance, ModifiedButterflyOnClosedModels) {
  BATTEN_REQUIRE_DATA();
  const Mesh mesh = without_tags(test::load_model(GetParam()));
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) ASSERT_FALSE(topology.is_boundary_edge(e));
  expect_same_refinement(mesh, mesh.face_count() > 20000 ? 1 : 2);
}

INSTANTIATE_TEST_SUITE_P(Model, OpenMeshConformance, testing::Values("spot", "rocker-arm", "fandisk", "nefertiti"),
                         test::test_name);

}  // namespace
}  // namespace batten
