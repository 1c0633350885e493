#include "batten/patch/quad_ring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "batten/patch/face_ring.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// The quads of one refinement, tags and all.
Topology quads_of(const Mesh& mesh, const Scheme& scheme) {
  const Topology topology(mesh);
  return Refinement(topology, scheme).child();
}

/// Returns how many rings were gathered.
int expect_what_face_ring_finds(const Topology& topology, const Scheme& scheme) {
  const SharpnessCodes codes(topology);
  QuadRing quad(topology, scheme, codes);
  FaceRing ring;
  std::map<std::string, QuadRing::Code> code_of;
  std::map<QuadRing::Code, std::string> key_of;
  int gathered = 0;
  for (Index h = 0; h < topology.half_edge_count(); ++h) {
    if (!quad.gather(h)) continue;
    ++gathered;
    ring.gather(topology, scheme, h);
    EXPECT_EQ(code_of.emplace(ring.key(), quad.code()).first->second, quad.code()) << h;
    EXPECT_EQ(key_of.emplace(quad.code(), ring.key()).first->second, ring.key()) << h;
    Buffer<Index> vertices(quad.begin(), quad.end());
    Buffer<Index> expected = ring.vertices();
    EXPECT_TRUE(std::equal(vertices.begin(), vertices.begin() + 4, expected.begin())) << h;
    std::sort(vertices.begin(), vertices.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(vertices, expected) << h;
  }
  return gathered;
}

TEST(QuadRing, TellsApartWhatFaceRingTellsApart) {
  int gathered = 0;
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    for (const unsigned seed : {0U, 1U, 2U}) {
      SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
      Mesh mesh = seed == 0 ? sample.mesh : test::with_random_tags(sample.mesh, seed);
      for (const BoundaryRule boundary : {BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner}) {
        Scheme scheme;
        scheme.boundary = boundary;
        gathered += expect_what_face_ring_finds(quads_of(mesh, scheme), scheme);
      }
    }
  }
  EXPECT_GT(gathered, 1000);
}

TEST(QuadRing, LeavesToFaceRingWhatRepeatsVertices) {
  // Three quads around each way: the rings of opposite sides meet.
  const Index n = 3;
  test::Faces faces;
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const auto at = [&](Index x, Index y) { return (y % n) * n + x % n; };
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const Topology topology(test::mesh_of_faces(n * n, faces));
  EXPECT_EQ(expect_what_face_ring_finds(topology, Scheme()), 0);
}

TEST(QuadRing, LeavesChaikinsRuleToFaceRing) {
  Scheme scheme;
  scheme.crease_method = CreaseMethod::Chaikin;
  const Mesh mesh = test::with_random_tags(test::annulus(12), 1);
  EXPECT_EQ(expect_what_face_ring_finds(quads_of(mesh, scheme), scheme), 0);
}

}  // namespace
}  // namespace batten
