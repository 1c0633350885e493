#include "batten/refine/child_topology.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Edges may be numbered otherwise, and the fan of an interior vertex may start elsewhere.
void expect_same_connectivity(const Topology& child, const Topology& built, const std::string& name) {
  ASSERT_EQ(child.vertex_count(), built.vertex_count()) << name;
  ASSERT_EQ(child.edge_count(), built.edge_count()) << name;
  EXPECT_EQ(child.uniform_face_size(), built.uniform_face_size()) << name;
  EXPECT_EQ(child.tables().face_offsets, built.tables().face_offsets) << name;
  EXPECT_EQ(child.tables().origins, built.tables().origins) << name;
  EXPECT_EQ(child.tables().twins, built.tables().twins) << name;
  EXPECT_EQ(child.tables().faces, built.tables().faces) << name;
  for (Index e = 0; e < child.edge_count(); ++e) {
    const Index h = child.edge_half_edge(e);
    EXPECT_EQ(child.edge(h), e) << name;
    EXPECT_EQ(built.edge_half_edge(built.edge(h)), h) << name;
    EXPECT_TRUE(child.twin(h) < 0 || child.edge(child.twin(h)) == e) << name;
    EXPECT_EQ(child.edge_sharpness(e), built.edge_sharpness(built.edge(h))) << name;
  }
  for (Index v = 0; v < child.vertex_count(); ++v) {
    const Index h = child.vertex_half_edge(v);
    ASSERT_EQ(h < 0, built.is_isolated(v)) << name;
    if (h < 0) continue;
    EXPECT_EQ(child.origin(h), v) << name;
    EXPECT_EQ(child.is_boundary_vertex(v), built.is_boundary_vertex(v)) << name;
    EXPECT_EQ(child.vertex_sharpness(v), built.vertex_sharpness(v)) << name;
  }
}

void expect_closed_form_equals_the_gate(const Mesh& mesh, const Scheme& scheme, const std::string& name) {
  RefinedSurface surface{Topology(mesh), mesh.points};
  for (int level = 0; level < 3; ++level) {
    surface = refine(surface.topology, scheme, surface.values, 1);
    Mesh child = mesh_from_topology(surface.topology);
    child.points = surface.values;
    expect_same_connectivity(surface.topology, Topology(child), name + ", level " + std::to_string(level + 1));
  }
}

TEST(ChildTopology, ChildTopologyIsThatOfTheChildMesh) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    expect_closed_form_equals_the_gate(mesh, scheme, name);
  });
}

TEST(ChildTopology, ChildTagsAreThoseOfTheChildMesh) {
  test::for_each_sample([](const Mesh& mesh, Scheme scheme, const std::string& name) {
    Mesh tagged = test::with_random_tags(mesh, 9);
    tagged.holes = {0};
    expect_closed_form_equals_the_gate(tagged, scheme, name);
    scheme.crease_method = CreaseMethod::Chaikin;
    expect_closed_form_equals_the_gate(tagged, scheme, name + " with Chaikin");
  });
}

TEST(ChildTopology, CountsAreThoseOfTheScheme) {
  const Topology quads(dodecahedron());
  Scheme scheme;
  const Topology child = Refinement(quads, scheme).child();
  EXPECT_EQ(child.vertex_count(), 20 + 30 + 12);
  EXPECT_EQ(child.face_count(), 60);
  const Topology triangles(icosahedron());
  scheme.kind = SchemeKind::Loop;
  const Topology loop_child = Refinement(triangles, scheme).child();
  EXPECT_EQ(loop_child.vertex_count(), 12 + 30);
  EXPECT_EQ(loop_child.face_count(), 80);
}

/// The order that the header promises.
TEST(ChildTopology, ChildOfAHalfEdgeIsAQuadAtItsOrigin) {
  const Topology parent(test::mesh_of_faces(5, {{0, 1, 2, 3}, {1, 0, 4}}));
  const Topology child = Refinement(parent, Scheme()).child();
  for (Index h = 0; h < parent.half_edge_count(); ++h) {
    const Index edges = parent.vertex_count();
    EXPECT_EQ(child.origin(4 * h), parent.origin(h));
    EXPECT_EQ(child.origin(4 * h + 1), edges + parent.edge(h));
    EXPECT_EQ(child.origin(4 * h + 2), edges + parent.edge_count() + parent.face(h));
    EXPECT_EQ(child.origin(4 * h + 3), edges + parent.edge(parent.previous(h)));
  }
}

TEST(ChildTopology, ChildrenOfHolesAreHoles) {
  for (const Mesh& solid : {dodecahedron(), icosahedron()}) {
    Mesh mesh = solid;
    mesh.holes = {3, 7};
    const Topology parent(mesh);
    const Scheme scheme = choose_scheme(mesh);
    const Topology child = Refinement(parent, scheme).child();
    const Index children = scheme.kind == SchemeKind::Loop ? 4 : 5;
    for (Index f = 0; f < child.face_count(); ++f) EXPECT_EQ(child.is_hole(f), parent.is_hole(f / children));
  }
}

TEST(ChildTopology, SemiSharpEdgesCountDown) {
  Mesh mesh = cube();
  mesh.creases = {{mesh.face_vertices[0], mesh.face_vertices[1], 2.5}};
  const Topology topology(mesh);
  for (int level = 0; level < 4; ++level) {
    const Topology child = refine(topology, Scheme(), mesh.points, level).topology;
    const float expected = std::max(0.0F, 2.5F - static_cast<float>(level));
    Index sharp = 0;
    for (Index e = 0; e < child.edge_count(); ++e) {
      if (child.edge_sharpness(e) == 0.0F) continue;
      EXPECT_EQ(child.edge_sharpness(e), expected);
      ++sharp;
    }
    EXPECT_EQ(sharp, expected > 0.0F ? 1 << level : 0);
  }
}

}  // namespace
}  // namespace batten
