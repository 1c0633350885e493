/// Adaptive tessellation of OpenSubdiv's shapes: no cracks, and the tolerance asked for.
#include <gtest/gtest.h>

#include <set>

#include "batten/adaptive/adaptive.h"
#include "batten/refine/refinement.h"
#include "conformance/conformance_data.h"

namespace batten::test {
namespace {

/// Their holes leave a vertex with two fans of faces.
const std::set<std::string> kFansApart{"catmark_hole_test4"};

/// A boundary vertex's own half-edge is the one along the boundary.
Index boundary_loops(const Topology& topology) {
  std::set<Index> seen;
  Index loops = 0;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (!topology.is_boundary_edge(e) || seen.count(topology.edge_half_edge(e)) > 0) continue;
    ++loops;
    for (Index h = topology.edge_half_edge(e); seen.insert(h).second;) {
      h = topology.vertex_half_edge(topology.destination(h));
    }
  }
  return loops;
}

class AdaptiveShapes : public ShapeTest {};
INSTANTIATE_TEST_SUITE_P(Conformance, AdaptiveShapes, ::testing::ValuesIn(shape_names()), test_name);

TEST_P(AdaptiveShapes, KeepTheirToleranceWithoutCracks) {
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  for (const FaceKind kind : {FaceKind::Triangles, FaceKind::Quads}) {
    AdaptiveOptions options;
    options.chord = 5e-4 * bounding_diagonal(mesh.points);
    options.faces = kind;
    const AdaptiveMesh result = tessellate_adaptively(topology, scheme, mesh.points, options);
    EXPECT_EQ(result.unmet, 0);
    EXPECT_LE(measured_chord(surface, result), options.chord);
    if (kFansApart.count(GetParam()) > 0) {
      EXPECT_THROW(Topology{result.mesh}, Error) << "no longer the exception that it was";
      continue;
    }
    // The gate refuses edges of three faces and more; a crack would be a boundary that the control mesh has not.
    const Topology found(result.mesh);
    if (!with_surface_holes(topology, scheme).has_holes()) {
      EXPECT_EQ(boundary_loops(found), boundary_loops(topology));
    }
  }
}

}  // namespace
}  // namespace batten::test
