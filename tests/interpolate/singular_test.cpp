/// Components on which arbitrary targets have no surface.
#include <gtest/gtest.h>

#include "batten/error.h"
#include "batten/interpolate/interpolator.h"
#include "batten/interpolate/singular_components.h"
#include "batten/mesh/primitives.h"
#include "support/shapes.h"

namespace batten {
namespace {

Mesh perturbed_cube() {
  Mesh mesh = cube();
  mesh.points(0, 0) += 0.3;
  mesh.points(5, 1) -= 0.2;
  return mesh;
}

Interpolant solve(const Mesh& mesh, OnSingular choice) {
  InterpolateOptions options;
  options.on_singular = choice;
  const Topology topology(mesh);
  return Interpolator(topology, Scheme(), options).solve(mesh.points);
}

std::size_t singular_count(const Mesh& mesh, const Scheme& scheme = {}) {
  const Topology topology(mesh);
  return find_singular_components(LimitMatrix(topology, scheme)).size();
}

Mesh prism(Index n) {
  test::Faces faces;
  std::vector<Index> bottom;
  std::vector<Index> top;
  for (Index v = 0; v < n; ++v) {
    faces.push_back({v, (v + 1) % n, n + (v + 1) % n, n + v});
    bottom.push_back(n - 1 - v);
    top.push_back(n + v);
  }
  faces.push_back(bottom);
  faces.push_back(top);
  return test::mesh_of_faces(2 * n, faces);
}

TEST(Singular, CubeUnderCatmullClarkIsSingular) { EXPECT_EQ(singular_count(cube()), 1U); }

TEST(Singular, EvenPrismsAreAndOddOnesAreNot) {
  for (Index n = 3; n < 10; ++n) EXPECT_EQ(singular_count(prism(n)), n % 2 == 0 ? 1U : 0U) << n;
}

TEST(Singular, NothingElseIs) {
  EXPECT_EQ(singular_count(tetrahedron()), 0U);
  EXPECT_EQ(singular_count(dodecahedron()), 0U);
  EXPECT_EQ(singular_count(torus(8, 6)), 0U);
  Mesh creased = cube();
  for (Index i = 0; i < 4; ++i) {
    creased.creases.push_back({creased.face_vertices[i], creased.face_vertices[(i + 1) % 4], 10.0});
  }
  EXPECT_EQ(singular_count(creased), 0U);
  Scheme damped;
  damped.alpha = 0.25;
  EXPECT_EQ(singular_count(cube(), damped), 0U);
}

TEST(Singular, ConsistentTargetsAreSolved) {
  // The regular cube: P = 2 V exactly, without alpha (data/reference.json).
  const Interpolant result = solve(cube(), OnSingular::Refuse);
  EXPECT_EQ(result.topology.vertex_count(), 8);
  ASSERT_EQ(result.report.singular.size(), 1U);
  EXPECT_EQ(result.report.singular[0].treatment, SingularTreatment::None);
  EXPECT_LT((result.control - 2.0 * cube().points).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Singular, RefusalNamesTheComponent) {
  try {
    solve(perturbed_cube(), OnSingular::Refuse);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::SingularSystem);
    EXPECT_NE(std::string(error.what()).find("the component of vertex 0 (8 vertices)"), std::string::npos)
        << error.what();
  }
}

TEST(Singular, AlphaIsExactOnTheSurfaceThatIsHandedOut) {
  const Mesh mesh = perturbed_cube();
  const Interpolant result = solve(mesh, OnSingular::Alpha);
  EXPECT_LE(result.report.max_error, 1e-10 * bounding_diagonal(mesh.points));
  EXPECT_EQ(result.topology.vertex_count(), 8 + 12 + 6);
  EXPECT_EQ(result.report.singular.at(0).treatment, SingularTreatment::Alpha);
  EXPECT_EQ(result.report.singular.at(0).alpha, 0.5);
  const Values limit = LimitMatrix(result.topology, result.scheme).apply(result.control);
  EXPECT_LT((limit.topRows(8) - mesh.points).rowwise().norm().maxCoeff(), 1e-10 * bounding_diagonal(mesh.points));
}

TEST(Singular, LeastSquaresMissesAllByTheSame) {
  const Mesh mesh = perturbed_cube();
  const Topology topology(mesh);
  const Interpolant result = solve(mesh, OnSingular::LeastSquares);
  const Values miss = LimitMatrix(topology, Scheme()).apply(result.control) - mesh.points;
  const double expected = std::hypot(0.3, 0.2) / 8.0;  // |sum +-M_i| / N
  for (Index v = 0; v < 8; ++v) EXPECT_NEAR(miss.row(v).norm(), expected, 1e-9);
  EXPECT_EQ(result.report.outcome, Outcome::LeastSquares);
  EXPECT_NEAR(result.report.max_error, expected, 1e-9);
}

/// A perturbed cube with a torus beside it.
Mesh cube_and_torus() {
  Mesh mesh = perturbed_cube();
  const Mesh other = torus(8, 6);
  const Index first = mesh.vertex_count();
  mesh.points.conservativeResize(first + other.vertex_count(), 3);
  mesh.points.bottomRows(other.vertex_count()) = other.points.rowwise() + Eigen::RowVector3d(9, 0, 0);
  for (Index f = 0; f < other.face_count(); ++f) {
    for (Index i = 0; i < 4; ++i) mesh.face_vertices.push_back(first + other.face_vertices[4 * f + i]);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  return mesh;
}

TEST(Singular, OnlyTheSingularComponentTakesAlpha) {
  const Mesh mesh = cube_and_torus();
  const Interpolant result = solve(mesh, OnSingular::Alpha);
  EXPECT_LE(result.report.max_error, 1e-10 * bounding_diagonal(mesh.points));
  ASSERT_EQ(result.report.singular.size(), 1U);
  EXPECT_EQ(result.report.singular[0].vertex, 0);
  EXPECT_EQ(result.report.singular[0].vertex_count, 8);
}

TEST(Singular, LeastSquaresOnOneComponentExcusesNoOther) {
  const Mesh mesh = cube_and_torus();
  InterpolateOptions options;
  options.method = SolveMethod::Jacobi;
  options.max_iterations = 8;
  options.on_singular = OnSingular::LeastSquares;
  const Topology topology(mesh);
  EXPECT_EQ(Interpolator(topology, Scheme(), options).solve(mesh.points).report.outcome, Outcome::NotReached);
  options.max_iterations = 2000;
  EXPECT_EQ(Interpolator(topology, Scheme(), options).solve(mesh.points).report.outcome, Outcome::LeastSquares);
}

TEST(Singular, ASolvedComponentDoesNotHideOneThatIsNot) {
  const Mesh mesh = cube_and_torus();
  const Topology topology(mesh);
  InterpolateOptions options;
  options.method = SolveMethod::Jacobi;
  options.max_iterations = 8;
  const Interpolant result = Interpolator(topology, Scheme(), options).solve(mesh.points);
  EXPECT_FALSE(result.report.converged());
  EXPECT_GT(result.report.max_error, 1e-10 * bounding_diagonal(mesh.points));
}

/// Two n-gons back to back: every vertex has valence 2 and the system is indefinite or singular.
TEST(Singular, DihedraPassThroughTheirVertices) {
  for (Index n = 3; n < 12; ++n) {
    const Mesh mesh = test::dihedron(n);
    EXPECT_LE(solve(mesh, OnSingular::Alpha).report.max_error, 1e-10 * bounding_diagonal(mesh.points)) << n;
  }
}

TEST(Singular, ACubeWithItsEdgesSplitPassesThroughItsVertices) {
  // Valence 2 on every edge: four negative eigenvalues , where the papers' iterations diverge.
  const Mesh solid = cube();
  test::Faces faces = test::faces_of(solid);
  std::map<std::pair<Index, Index>, Index> middle;
  Index count = solid.vertex_count();
  for (auto& face : faces) {
    std::vector<Index> split;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Index a = face[i];
      const Index b = face[(i + 1) % face.size()];
      const auto [place, is_new] = middle.emplace(std::minmax(a, b), count);
      if (is_new) ++count;
      split.insert(split.end(), {a, place->second});
    }
    face = split;
  }
  const Mesh mesh = test::mesh_of_faces(count, faces);
  EXPECT_LE(solve(mesh, OnSingular::Alpha).report.max_error, 1e-10 * bounding_diagonal(mesh.points));
}

/// A cube with one crease in the middle of nothing: two darts. No rule recognises it, but its smallest singular value
/// is 1e-16.
Mesh cube_with_dart(double shake) {
  Mesh mesh = perturbed_cube();
  mesh.points(3, 2) += shake;
  mesh.creases = {{mesh.face_vertices[0], mesh.face_vertices[1], kInfiniteSharpness}};
  return mesh;
}

TEST(Singular, WhatNoRuleRecognisesIsRecognisedByItsSolution) {
  const Mesh mesh = cube_with_dart(0.1);
  try {
    solve(mesh, OnSingular::Refuse);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::SingularSystem);
    EXPECT_NE(std::string(error.what()).find("the component of vertex 0 (8 vertices): its equations are singular"),
              std::string::npos)
        << error.what();
  }
}

TEST(Singular, WhatNoRuleRecognisesTakesAlpha) {
  const Mesh mesh = cube_with_dart(0.1);
  const Interpolant result = solve(mesh, OnSingular::Alpha);
  EXPECT_EQ(result.report.singular.at(0).reason, SingularReason::Unsolvable);
  EXPECT_EQ(result.report.singular.at(0).alpha, 1.0);
  const Values limit = LimitMatrix(result.topology, result.scheme).apply(result.control);
  EXPECT_LE((limit.topRows(8) - mesh.points).rowwise().norm().maxCoeff(), 1e-10 * bounding_diagonal(mesh.points));
}

/// The least squares of a dense factorisation are the oracle.
TEST(Singular, WhatNoRuleRecognisesIsMissedByTheLeast) {
  const Mesh mesh = cube_with_dart(0.1);
  const Topology topology(mesh);
  const Interpolant result = solve(mesh, OnSingular::LeastSquares);
  EXPECT_EQ(result.report.outcome, Outcome::LeastSquares);
  const LimitMatrix matrix(topology, Scheme());
  const Eigen::MatrixXd a = matrix.matrix();
  const Eigen::MatrixXd targets = mesh.points;
  const Eigen::MatrixXd best = a.completeOrthogonalDecomposition().solve(targets);
  EXPECT_NEAR((a * result.control - targets).norm(), (a * best - targets).norm(), 1e-9);
  EXPECT_GT(result.report.max_error, 1e-3);
}

TEST(Singular, AnUnsolvableComponentSpoilsNoOther) {
  Mesh mesh = cube_with_dart(0.1);
  const Mesh other = cube_and_torus();
  mesh.points = other.points;
  mesh.face_offsets = other.face_offsets;
  mesh.face_vertices = other.face_vertices;
  const Interpolant result = solve(mesh, OnSingular::LeastSquares);
  EXPECT_EQ(result.report.outcome, Outcome::LeastSquares);
  const Topology topology(mesh);
  const Values miss = LimitMatrix(topology, Scheme()).apply(result.control) - mesh.points;
  EXPECT_LE(miss.bottomRows(mesh.vertex_count() - 8).rowwise().norm().maxCoeff(),
            1e-10 * bounding_diagonal(mesh.points.bottomRows(mesh.vertex_count() - 8)));
}

TEST(Singular, TheRescueOfValenceTwoIsReported) {
  Index rescued = 0;
  for (Index n = 3; n < 12; ++n) {
    const Interpolant result = solve(test::dihedron(n), OnSingular::Alpha);
    if (result.topology.vertex_count() == n) continue;
    ++rescued;
    ASSERT_EQ(result.report.singular.size(), 1U);
    EXPECT_EQ(result.report.singular[0].reason, SingularReason::ValenceTwo);
    EXPECT_EQ(result.report.singular[0].alpha, 1.0);
  }
  EXPECT_GT(rescued, 0);
}

}  // namespace
}  // namespace batten
