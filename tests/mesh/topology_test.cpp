#include "batten/mesh/topology.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <set>

#include "batten/parallel/parallel.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::sample_meshes;

TEST(Topology, NextAndPreviousAreInverseAndStayInTheFace) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
      EXPECT_EQ(topology.previous(topology.next(h)), h) << sample.name;
      EXPECT_EQ(topology.face(topology.next(h)), topology.face(h)) << sample.name;
      EXPECT_EQ(topology.destination(h), topology.origin(topology.next(h))) << sample.name;
    }
  }
}

TEST(Topology, TwinsRunBetweenTheSameVerticesTheOtherWay) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    std::map<std::pair<Index, Index>, Index> directed;
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
      directed[{topology.origin(h), topology.destination(h)}] = h;
    }
    for (const auto& [ends, h] : directed) {
      const auto opposite = directed.find({ends.second, ends.first});
      EXPECT_EQ(topology.twin(h), opposite == directed.end() ? -1 : opposite->second) << sample.name;
    }
  }
}

TEST(Topology, FacesKeepTheirCornersInOrder) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    const Mesh again = mesh_from_topology(topology);
    EXPECT_EQ(again.face_offsets, sample.mesh.face_offsets) << sample.name;
    EXPECT_EQ(again.face_vertices, sample.mesh.face_vertices) << sample.name;
  }
}

TEST(Topology, EdgesAreNumberedOnceByTheirLowerHalfEdge) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    Index next_edge = 0;
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
      const Index twin = topology.twin(h);
      const bool lower = twin < 0 || h < twin;
      if (lower) {
        EXPECT_EQ(topology.edge(h), next_edge++) << sample.name;
        EXPECT_EQ(topology.edge_half_edge(topology.edge(h)), h) << sample.name;
      } else {
        EXPECT_EQ(topology.edge(h), topology.edge(twin)) << sample.name;
      }
    }
    EXPECT_EQ(topology.edge_count(), next_edge) << sample.name;
  }
}

TEST(Topology, AFanMeetsEveryOutgoingHalfEdgeOnce) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    std::vector<std::set<Index>> outgoing(static_cast<std::size_t>(topology.vertex_count()));
    for (Index h = 0; h < topology.half_edge_count(); ++h) outgoing[topology.origin(h)].insert(h);
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      std::set<Index> met;
      topology.for_each_outgoing(v, [&](Index h) { EXPECT_TRUE(met.insert(h).second) << sample.name; });
      EXPECT_EQ(met, outgoing[v]) << sample.name;
      EXPECT_EQ(topology.vertex_face_count(v), static_cast<Index>(met.size())) << sample.name;
    }
  }
}

/// Counter-clockwise: each next face lies across the edge that comes before the vertex in the face.
TEST(Topology, AFanTurnsCounterClockwiseFromTheBoundary) {
  for (const auto& sample : sample_meshes()) {
    const Topology topology(sample.mesh);
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      Index last = -1;
      topology.for_each_outgoing(v, [&](Index h) {
        if (last >= 0) {
          EXPECT_EQ(topology.origin(topology.previous(last)), topology.destination(h)) << sample.name;
        }
        last = h;
      });
      if (last < 0) continue;
      const bool open = topology.twin(topology.previous(last)) < 0;
      EXPECT_EQ(topology.is_boundary_vertex(v), open) << sample.name;
    }
  }
}

TEST(Topology, UniformFaceSizeIsThatOfEveryFaceOrZero) {
  EXPECT_EQ(Topology(cube()).uniform_face_size(), 4);
  EXPECT_EQ(Topology(dodecahedron()).uniform_face_size(), 5);
  EXPECT_EQ(Topology(test::mesh_of_faces(5, {{0, 1, 2}, {0, 2, 3, 4}})).uniform_face_size(), 0);
  EXPECT_EQ(Topology(Mesh()).uniform_face_size(), 0);
}

TEST(Topology, EmptyMeshesAndLonePointsAreAccepted) {
  EXPECT_EQ(Topology(Mesh()).vertex_count(), 0);
  const Topology points(test::mesh_of_faces(3, {}));
  EXPECT_EQ(points.vertex_count(), 3);
  for (Index v = 0; v < 3; ++v) EXPECT_TRUE(points.is_isolated(v));
}

TEST(Topology, DihedraAreAccepted) {
  for (const Index n : {3, 4, 7}) {
    const Topology topology(test::dihedron(n));
    EXPECT_EQ(topology.edge_count(), n);
    for (Index v = 0; v < n; ++v) EXPECT_EQ(topology.vertex_face_count(v), 2);
  }
}

TEST(Topology, TagsReachTheirElements) {
  Mesh mesh = test::with_faces(cube(), test::faces_of(cube()));
  const Index a = mesh.face_vertices[0];
  const Index b = mesh.face_vertices[1];
  mesh.creases = {{b, a, 2.5}};  // against the half-edge's direction
  mesh.corners = {{3, 1.5}};
  mesh.holes = {2};
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    EXPECT_EQ(topology.edge_sharpness(e), e == topology.edge(0) ? 2.5F : 0.0F);
  }
  for (Index v = 0; v < 8; ++v) EXPECT_EQ(topology.vertex_sharpness(v), v == 3 ? 1.5F : 0.0F);
  for (Index f = 0; f < 6; ++f) EXPECT_EQ(topology.is_hole(f), f == 2);
}

TEST(Topology, SharpnessIsClampedToInfiniteAndToZero) {
  Mesh mesh = cube();
  mesh.corners = {{0, 1e300}, {1, -2.0}};
  const Topology topology(mesh);
  EXPECT_EQ(topology.vertex_sharpness(0), kInfiniteSharpness);
  EXPECT_EQ(topology.vertex_sharpness(1), 0.0F);
}

TEST(Topology, BoundaryEdgesAreInfinitelySharp) {
  const Topology topology(grid(2, 2));
  Index boundary = 0;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    EXPECT_EQ(topology.edge_sharpness(e), topology.is_boundary_edge(e) ? kInfiniteSharpness : 0.0F);
    boundary += topology.is_boundary_edge(e) ? 1 : 0;
  }
  EXPECT_EQ(boundary, 8);
}

TEST(Topology, TagsComeBackAsTheyWere) {
  Mesh mesh = test::with_random_tags(test::without_face(test::bipyramid(8), 3), 3);
  mesh.holes = {1, 4};
  const Topology topology(mesh);
  Mesh again = mesh_from_topology(topology);
  again.points = mesh.points;
  const Topology same(again);
  EXPECT_EQ(topology.tables().edge_sharpness, same.tables().edge_sharpness);
  EXPECT_EQ(topology.tables().vertex_sharpness, same.tables().vertex_sharpness);
  EXPECT_EQ(topology.tables().holes, same.tables().holes);
}

TEST(Topology, ComponentsAreNumberedByTheirLowestVertex) {
  const Topology topology(test::mesh_of_faces(9, {{8, 6, 4}, {4, 6, 2}, {1, 3, 5}}));
  const Components components = connected_components(topology);
  EXPECT_EQ(components.count, 4);
  EXPECT_EQ(components.of_vertex, (Buffer<Index>{0, 1, 2, 1, 2, 1, 2, 3, 2}));
}

/// Searching each spoke among 100,000 would take 10^10 steps: half a minute.
/// Long strips side by side, whose vertices are numbered in no order, so that several threads join the same trees.
TEST(Topology, ComponentsAreTheSameForAnyNumberOfThreads) {
  constexpr Index kStrips = 7;
  constexpr Index kLength = 20000;
  const Index vertex_count = 2 * kStrips * (kLength + 1);
  const auto number_of = [&](Index strip, Index side, Index i) {
    const std::int64_t place = 2 * (std::int64_t{strip} * (kLength + 1) + i) + side;
    return static_cast<Index>(place * 7919 % vertex_count);
  };
  Mesh mesh;
  mesh.points = Values::Zero(vertex_count, 3);
  std::vector<Index> strip_of(static_cast<std::size_t>(vertex_count));
  mesh.face_offsets.assign(1, 0);
  for (Index i = 0; i <= kLength; ++i) {
    for (Index s = 0; s < kStrips; ++s) {
      strip_of[number_of(s, 0, i)] = strip_of[number_of(s, 1, i)] = s;
      if (i == kLength) continue;
      for (const Index v : {number_of(s, 0, i), number_of(s, 0, i + 1), number_of(s, 1, i + 1), number_of(s, 1, i)})
        mesh.face_vertices.push_back(v);
      mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
    }
  }
  std::vector<Index> number_of_strip(kStrips, -1);
  std::vector<Index> expected;
  Index count = 0;
  for (const Index strip : strip_of) {
    if (number_of_strip[strip] < 0) number_of_strip[strip] = count++;
    expected.push_back(number_of_strip[strip]);
  }
  const Topology topology(mesh);
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    const Components components = connected_components(topology);
    EXPECT_EQ(components.count, kStrips);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), components.of_vertex.begin())) << threads;
  }
}

TEST(Topology, APoleOfAHundredThousandFacesTakesNoQuadraticTime) {
  const Mesh mesh = test::bipyramid(100000);
  const auto start = std::chrono::steady_clock::now();
  const Topology topology(mesh);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(topology.vertex_face_count(100000), 100000);
  EXPECT_LT(seconds.count(), 2.0);
}

/// 300,000 half-edges: more than one block in every loop.
TEST(Topology, TablesHaveTheSameBitsForAnyNumberOfThreads) {
  Mesh mesh = torus(300, 250);
  mesh.creases = {{mesh.face_vertices[0], mesh.face_vertices[1], 2.0}};
  const auto tables_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return Topology(mesh).tables();
  };
  const TopologyTables one = tables_with(1);
  const TopologyTables two = tables_with(2);
  EXPECT_EQ(one.twins, two.twins);
  EXPECT_EQ(one.faces, two.faces);
  EXPECT_EQ(one.edges, two.edges);
  EXPECT_EQ(one.edge_half_edges, two.edge_half_edges);
  EXPECT_EQ(one.vertex_half_edges, two.vertex_half_edges);
  EXPECT_EQ(one.edge_sharpness, two.edge_sharpness);
}

}  // namespace
}  // namespace batten
