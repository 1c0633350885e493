#include "batten/limit/limit_matrix.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"

namespace batten {
namespace {

/// Quads, but for faces of the torus cut into triangles.
Mesh mixed_torus() {
  Mesh mesh = torus(12, 8);
  Mesh mixed;
  mixed.points = mesh.points;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* v = mesh.face_vertices.data() + mesh.face_offsets[f];
    if (f % 5 == 0) {
      mixed.add_face({v[0], v[1], v[2]});
      mixed.add_face({v[0], v[2], v[3]});
    } else {
      mixed.add_face({v[0], v[1], v[2], v[3]});
    }
  }
  return mixed;
}

template <typename Work>
ErrorCode code_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::Cancelled;
}

/// Rows among quads alone are met by a way of their own; the assembled matrix and the product must agree on them too.
TEST(LimitMatrix, AssembledItIsWhatItApplies) {
  for (const Mesh& mesh : {torus(12, 8), mixed_torus(), cube()}) {
    const Topology topology(mesh);
    const LimitMatrix matrix(topology, Scheme());
    const Values product = matrix.matrix() * mesh.points;
    EXPECT_LT((matrix.apply(mesh.points) - product).cwiseAbs().maxCoeff(), 1e-15 * 16);  // sums of up to 16 terms
  }
}

TEST(LimitMatrix, WritesIntoTheCallersMemory) {
  const Mesh mesh = mixed_torus();
  const Topology topology(mesh);
  const LimitMatrix matrix(topology, Scheme());
  const Values expected = matrix.apply(mesh.points);
  Values wide = Values::Constant(topology.vertex_count(), 5, 7.0);
  matrix.apply_into(mesh.points, wide.middleCols(1, 3));
  EXPECT_TRUE((wide.middleCols(1, 3).array() == expected.array()).all());
  EXPECT_TRUE((wide.col(0).array() == 7.0).all() && (wide.col(4).array() == 7.0).all());
}

TEST(LimitMatrix, RefusesWrongShapesAndWhatIsNotFinite) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const LimitMatrix matrix(topology, Scheme());
  Values result(8, 2);
  EXPECT_EQ(code_of([&] { matrix.apply_into(mesh.points, result); }), ErrorCode::BadShape);
  Values points = mesh.points;
  points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([&] { matrix.apply(points); }), ErrorCode::NotFinite);
}

TEST(Refinement, WritesIntoTheCallersMemory) {
  const Mesh mesh = mixed_torus();
  const Refinement step{Topology(mesh), Scheme()};
  const Values expected = step.apply(mesh.points);
  Values result(expected.rows(), 3);
  step.apply_into(mesh.points, result);
  EXPECT_TRUE((result.array() == expected.array()).all());
  Values wide = Values::Constant(expected.rows(), 5, 7.0);
  step.apply_into(mesh.points, wide.middleCols(1, 3));
  EXPECT_TRUE((wide.middleCols(1, 3).array() == expected.array()).all());
  EXPECT_TRUE((wide.col(0).array() == 7.0).all() && (wide.col(4).array() == 7.0).all());
}

TEST(Refinement, RefusesWrongShapesAndWhatIsNotFinite) {
  const Mesh mesh = cube();
  const Refinement step{Topology(mesh), Scheme()};
  Values result(25, 3);
  EXPECT_EQ(code_of([&] { step.apply_into(mesh.points, result); }), ErrorCode::BadShape);
  Values points = mesh.points;
  points(3, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code_of([&] { step.apply(points); }), ErrorCode::NotFinite);
}

}  // namespace
}  // namespace batten
