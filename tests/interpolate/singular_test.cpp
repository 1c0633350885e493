/// Components on which arbitrary targets have no surface (MATH 2.2).
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
  EXPECT_TRUE(result.vertex_alpha.empty());
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

TEST(Singular, AlphaIsExactAndTheOnceRefinedMeshSaysSo) {
  const Mesh mesh = perturbed_cube();
  const Topology topology(mesh);
  const Interpolant result = solve(mesh, OnSingular::Alpha);
  EXPECT_LE(result.max_error, 1e-10 * bounding_diagonal(mesh.points));
  const RefinedSurface surface = ordinary_surface(topology, Scheme(), result);
  EXPECT_EQ(surface.topology.vertex_count(), 8 + 12 + 6);
  const Values limit = LimitMatrix(surface.topology, Scheme()).apply(surface.values);
  EXPECT_LT((limit.topRows(8) - mesh.points).rowwise().norm().maxCoeff(), 1e-10 * bounding_diagonal(mesh.points));
}

TEST(Singular, LeastSquaresMissesAllByTheSame) {
  const Mesh mesh = perturbed_cube();
  const Topology topology(mesh);
  const Interpolant result = solve(mesh, OnSingular::LeastSquares);
  const Values miss = LimitMatrix(topology, Scheme()).apply(result.control) - mesh.points;
  const double expected = std::hypot(0.3, 0.2) / 8.0;  // |sum +-M_i| / N (MATH 2.2)
  for (Index v = 0; v < 8; ++v) EXPECT_NEAR(miss.row(v).norm(), expected, 1e-9);
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
  EXPECT_LE(result.max_error, 1e-10 * bounding_diagonal(mesh.points));
  EXPECT_EQ(result.vertex_alpha.front(), 0.5);
  EXPECT_EQ(result.vertex_alpha.back(), 0.0);
}

TEST(Singular, ASolvedComponentDoesNotHideOneThatIsNot) {
  const Mesh mesh = cube_and_torus();
  const Topology topology(mesh);
  InterpolateOptions options;
  options.method = SolveMethod::Jacobi;
  options.max_iterations = 8;
  const Interpolant result = Interpolator(topology, Scheme(), options).solve(mesh.points);
  EXPECT_FALSE(result.report.converged);
  EXPECT_GT(result.max_error, 1e-10 * bounding_diagonal(mesh.points));
}

/// Two n-gons back to back: every vertex has valence 2 and the system is indefinite or singular.
TEST(Singular, DihedraPassThroughTheirVertices) {
  for (Index n = 3; n < 12; ++n) {
    const Mesh mesh = test::dihedron(n);
    EXPECT_LE(solve(mesh, OnSingular::Alpha).max_error, 1e-10 * bounding_diagonal(mesh.points)) << n;
  }
}

TEST(Singular, ACubeWithItsEdgesSplitPassesThroughItsVertices) {
  // Valence 2 on every edge: four negative eigenvalues (MATH 1.4), where the papers' iterations diverge.
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
  EXPECT_LE(solve(mesh, OnSingular::Alpha).max_error, 1e-10 * bounding_diagonal(mesh.points));
}

}  // namespace
}  // namespace batten
