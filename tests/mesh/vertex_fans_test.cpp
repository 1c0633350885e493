#include "batten/mesh/vertex_fans.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "support/shapes.h"

namespace batten {
namespace {

using test::sample_meshes;

TEST(VertexFans, StepsInAFaceAreThoseOfTheTopology) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
      EXPECT_EQ(next_half_edge(topology.tables(), h), topology.next(h)) << sample.name;
      EXPECT_EQ(previous_half_edge(topology.tables(), h), topology.previous(h)) << sample.name;
    }
  }
}

TEST(VertexFans, SpokesAreTheOutgoingHalfEdgesInTheirOrder) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      std::vector<std::pair<Index, Index>> expected;
      std::vector<std::pair<Index, Index>> found;
      topology.for_each_outgoing(v, [&](Index h) { expected.emplace_back(h, topology.destination(h)); });
      for_each_spoke(topology, v, [&](Index h, Index destination) { found.emplace_back(h, destination); });
      EXPECT_EQ(found, expected) << sample.name << " vertex " << v;
    }
  }
}

TEST(VertexFans, CornersCountTheFacesAroundEachVertex) {
  for (auto sample : sample_meshes()) {
    sample.mesh.points.conservativeResize(sample.mesh.points.rows() + 1, 3);  // and one vertex without a face
    sample.mesh.points.bottomRows(1).setZero();
    const Topology topology(sample.mesh);
    const Buffer<Index> counts = vertex_face_counts(topology);
    ASSERT_EQ(counts.size(), static_cast<std::size_t>(topology.vertex_count()));
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      EXPECT_EQ(counts[v], topology.vertex_face_count(v)) << sample.name << " vertex " << v;
    }
  }
}

}  // namespace
}  // namespace batten
