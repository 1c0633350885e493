#include <gtest/gtest.h>

#include "batten/adaptive/adaptive.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// The same mesh, its faces from the last to the first.
AdaptiveMesh reversed(const AdaptiveMesh& mesh) {
  AdaptiveMesh result = mesh;
  result.mesh.face_offsets = {0};
  result.mesh.face_vertices.clear();
  result.base_faces.clear();
  result.corner_parameters.clear();
  for (Index f = mesh.mesh.face_count() - 1; f >= 0; --f) {
    for (Index c = mesh.mesh.face_offsets[f]; c < mesh.mesh.face_offsets[f + 1]; ++c) {
      result.mesh.face_vertices.push_back(mesh.mesh.face_vertices[c]);
      result.corner_parameters.push_back(mesh.corner_parameters[c]);
    }
    result.mesh.face_offsets.push_back(static_cast<Index>(result.mesh.face_vertices.size()));
    result.base_faces.push_back(mesh.base_faces[f]);
  }
  return result;
}

/// A sample is not looked at closely where it cannot be the farthest, and which those are depends on the order.
TEST(MeasuredChord, DoesNotDependOnTheOrderOfFaces) {
  for (const Index valence : {5, 24, 100}) {
    const Mesh mesh = test::jittered(test::bipyramid(valence), 0.02, 7);
    const Topology topology(mesh);
    for (const FaceKind kind : {FaceKind::Triangles, FaceKind::Quads}) {
      AdaptiveOptions options;
      options.chord = 0.02;
      options.faces = kind;
      const AdaptiveMesh result = tessellate_adaptively(topology, Scheme(), mesh.points, options);
      const LimitSurface surface(topology, Scheme(), mesh.points);
      const double measured = measured_chord(surface, result);
      EXPECT_GT(measured, 0.0);
      EXPECT_EQ(measured_chord(surface, reversed(result)), measured) << valence;
    }
  }
}

}  // namespace
}  // namespace batten
