#include "batten/limit/vertex_frames.h"

#include <gtest/gtest.h>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Compares every frame with LimitMatrix and limit_normals, which visit all vertices by other code.
void expect_equal_limits(const Topology& topology, const Scheme& scheme, const Values& control,
                         const std::string& name) {
  const Values limits = LimitMatrix(topology, scheme).apply(control);
  const Values normals = limit_normals(topology, scheme, control).vertices;
  const VertexFrames frames(topology, scheme);
  FrameRing ring;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    frames.find(v, ring);
    const VertexFrame frame = VertexFrames::frame(control, ring);
    if (frame.kind == FrameKind::Outside) continue;
    EXPECT_LT((frame.position.transpose() - limits.row(v)).norm(), 1e-14 * control.cwiseAbs().maxCoeff()) << name;
    if (frame.kind != FrameKind::Interior && frame.kind != FrameKind::Boundary) continue;
    EXPECT_LT((frame.normal.transpose() - normals.row(v)).norm(), 1e-12) << name << ", vertex " << v;
  }
}

TEST(VertexFrames, AgreeWithTheLimitsOfAllVertices) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const RefinedSurface fine = refine(Topology(mesh), scheme, mesh.points, 1);
    expect_equal_limits(fine.topology, scheme, fine.values, name);
  });
}

TEST(VertexFrames, AgreeWithTheLimitsUnderRandomTags) {
  for (const CreaseMethod method : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
    Scheme scheme;
    scheme.crease_method = method;
    for (const Mesh& shape : {torus(7, 5), grid(4, 3), dodecahedron()}) {
      const Mesh mesh = test::with_random_tags(test::jittered(shape, 0.05, 3), 9);
      const RefinedSurface fine = refine(Topology(mesh), scheme, mesh.points, 1);
      expect_equal_limits(fine.topology, scheme, fine.values, "tagged");
    }
  }
}

TEST(VertexFrames, TellTheKindsOfVertices) {
  Mesh mesh = grid(4, 4);
  mesh.creases = {{7, 12, 10.0}, {12, 17, 10.0}, {17, 22, 10.0}};
  const Topology topology(mesh);
  const VertexFrames frames(topology, test::scheme_of(SchemeKind::CatmullClark, BoundaryRule::EdgeAndCorner));
  const auto kind_of = [&](Index vertex) {
    FrameRing ring;
    frames.find(vertex, ring);
    return VertexFrames::frame(mesh.points, ring).kind;
  };
  EXPECT_EQ(kind_of(6), FrameKind::Interior);
  EXPECT_EQ(kind_of(7), FrameKind::Interior);  // a dart
  EXPECT_EQ(kind_of(12), FrameKind::Crease);
  EXPECT_EQ(kind_of(10), FrameKind::Boundary);
  EXPECT_EQ(kind_of(0), FrameKind::Corner);
  EXPECT_EQ(kind_of(22), FrameKind::Corner);  // a crease meets the boundary
}

TEST(VertexFrames, FindTheOneRing) {
  const Mesh mesh = torus(6, 5);
  FrameRing ring;
  VertexFrames(Topology(mesh), {}).find(7, ring);
  std::vector<Index> found = ring.vertices;
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<Index>{1, 2, 3, 6, 7, 8, 11, 12, 13}));
}

}  // namespace
}  // namespace batten
