#include "batten/refine/refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <numeric>
#include <random>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Sums of at most some hundred terms of order 1.
constexpr double kRounding = 1e-13;

double worst(ConstValuesRef a, ConstValuesRef b) { return (a - b).cwiseAbs().maxCoeff(); }

TEST(Refinement, RowsSumToOne) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(test::with_random_tags(mesh, 2));
    const RefinedSurface surface = refine(topology, scheme, Values::Ones(topology.vertex_count(), 1), 3);
    EXPECT_LT(worst(surface.values, Values::Ones(surface.values.rows(), 1)), kRounding) << name;
  });
}

TEST(Refinement, CommutesWithAffineMaps) {
  const Eigen::Matrix3d linear = (Eigen::Matrix3d() << 2, 1, 0, -1, 3, 0.5, 0.25, -2, 1).finished();
  const Eigen::RowVector3d shift(1, -2, 3);
  test::for_each_sample([&](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(test::with_random_tags(mesh, 4));
    const Values moved = (mesh.points * linear).rowwise() + shift;
    const Values expected = (refine(topology, scheme, mesh.points, 2).values * linear).rowwise() + shift;
    EXPECT_LT(worst(refine(topology, scheme, moved, 2).values, expected), 1e-12) << name;
  });
}

TEST(Refinement, ColumnsDoNotMix) {
  const Mesh mesh = test::with_random_tags(test::random_hull(30, 3), 1);
  const Topology topology(mesh);
  const Refinement step(topology, Scheme());
  const Values positions = step.apply(mesh.points);
  Values wide(mesh.vertex_count(), 7);
  for (int c = 0; c < 7; ++c) wide.col(c) = mesh.points.col(c % 3);
  const Values columns = step.apply(wide);
  for (int c = 0; c < 7; ++c) EXPECT_LT(worst(columns.col(c), positions.col(c % 3)), 1e-15);
  EXPECT_LT(worst(step.apply(mesh.points.col(1)), positions.col(1)), 1e-15);
  EXPECT_EQ(step.apply(wide.middleCols(3, 3)), positions);  // a block of columns, read in place
}

/// Vertices, faces and first corners in another order: the same points, wherever they stand.
TEST(Refinement, DoesNotDependOnTheOrderOfVerticesAndFaces) {
  const Mesh mesh = test::jittered(dodecahedron(), 0.1, 5);
  std::mt19937 random(3);
  std::vector<Index> place(20);
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  test::Faces faces = test::faces_of(mesh);
  for (auto& face : faces) {
    for (Index& v : face) v = place[v];
    std::rotate(face.begin(), face.begin() + static_cast<int>(random() % 5), face.end());
  }
  std::shuffle(faces.begin(), faces.end(), random);
  Mesh other = test::with_faces(mesh, faces);
  for (Index v = 0; v < 20; ++v) other.points.row(place[v]) = mesh.points.row(v);
  const Values a = refine(Topology(mesh), Scheme(), mesh.points, 2).values;
  const Values b = refine(Topology(other), Scheme(), other.points, 2).values;
  for (Index v = 0; v < 20; ++v) EXPECT_LT(worst(a.row(v), b.row(place[v])), kRounding);
  EXPECT_LT(worst(a.colwise().sum(), b.colwise().sum()), 1e-11);
  EXPECT_NEAR(a.norm(), b.norm(), 1e-11);
}

TEST(Refinement, IsolatedVerticesStayWhereTheyAre) {
  const Mesh mesh = test::mesh_of_faces(6, {{0, 1, 3}});
  for (const auto kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    Scheme scheme;
    scheme.kind = kind;
    const RefinedSurface surface = refine(Topology(mesh), scheme, mesh.points, 2);
    for (const Index v : {2, 4, 5}) EXPECT_EQ(surface.values.row(v), mesh.points.row(v));
  }
}

TEST(Refinement, SingleFaceVerticesStayUnderEdgeAndCornerOnly) {
  const Mesh mesh = grid(1, 1);
  Scheme scheme;
  const Eigen::RowVector3d corner = mesh.points.row(0);
  EXPECT_LT(worst(refine(Topology(mesh), scheme, mesh.points, 1).values.row(0), 0.75 * corner), kRounding);
  scheme.boundary = BoundaryRule::EdgeAndCorner;
  EXPECT_EQ(refine(Topology(mesh), scheme, mesh.points, 3).values.row(0), corner);
}

TEST(Refinement, ACreaseAcrossASurfaceIsACubicSpline) {
  Mesh mesh = test::jittered(torus(8, 6), 0.1, 2);
  for (Index i = 0; i < 8; ++i) mesh.creases.push_back({i * 6, (i + 1) % 8 * 6, 10.0});
  const Values fine = refine(Topology(mesh), Scheme(), mesh.points, 1).values;
  for (Index i = 0; i < 8; ++i) {
    const Eigen::RowVector3d before = mesh.points.row((i + 7) % 8 * 6);
    const Eigen::RowVector3d after = mesh.points.row((i + 1) % 8 * 6);
    const Eigen::RowVector3d expected = (before + 6.0 * mesh.points.row(i * 6) + after) / 8.0;
    EXPECT_LT(worst(fine.row(i * 6), expected), kRounding);
  }
}

// Splines: on regular connectivity the schemes are knot insertion, written here without masks.

/// A periodic grid of values, refined by the factors (1 + z^d)^2/4 for each direction d after doubling: times 4.
Eigen::MatrixXd box_spline_step(const Eigen::MatrixXd& coarse, const std::vector<std::pair<int, int>>& directions) {
  const auto rows = static_cast<int>(2 * coarse.rows());
  const auto cols = static_cast<int>(2 * coarse.cols());
  Eigen::MatrixXd fine = Eigen::MatrixXd::Zero(rows, cols);
  for (int i = 0; i < rows; i += 2) {
    for (int j = 0; j < cols; j += 2) fine(i, j) = 4.0 * coarse(i / 2, j / 2);
  }
  for (const auto& direction : directions) {
    const Eigen::MatrixXd before = fine;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < cols; ++j) {
        const auto at = [&](int k) {
          return before((i + k * direction.first + rows) % rows, (j + k * direction.second + cols) % cols);
        };
        fine(i, j) = (at(-1) + 2.0 * at(0) + at(1)) / 4.0;
      }
    }
  }
  return fine;
}

/// Compares a step on a torus, vertex i * across + j, with a grid of twice the size.
void expect_grid_step(const Topology& topology, const Scheme& scheme, const Eigen::MatrixXd& coarse,
                      const Eigen::MatrixXd& fine) {
  const auto around = static_cast<Index>(coarse.rows());
  const auto across = static_cast<Index>(coarse.cols());
  Values values(topology.vertex_count(), 1);
  for (Index v = 0; v < values.rows(); ++v) values(v, 0) = coarse(v / across, v % across);
  const Values result = Refinement(topology, scheme).apply(values);
  const auto middle = [](Index a, Index b, Index n) { return std::abs(a - b) <= 1 ? a + b : 2 * n - 1; };
  for (Index v = 0; v < values.rows(); ++v) EXPECT_NEAR(result(v, 0), fine(v / across * 2, v % across * 2), kRounding);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index a = topology.origin(topology.edge_half_edge(e));
    const Index b = topology.destination(topology.edge_half_edge(e));
    const Index i = middle(a / across, b / across, around);
    const Index j = middle(a % across, b % across, across);
    EXPECT_NEAR(result(values.rows() + e, 0), fine(i, j), kRounding);
  }
  for (Index f = 0; scheme.kind == SchemeKind::CatmullClark && f < topology.face_count(); ++f) {
    const Index row = topology.vertex_count() + topology.edge_count() + f;
    EXPECT_NEAR(result(row, 0), fine(f / across * 2 + 1, f % across * 2 + 1), kRounding);
  }
}

Eigen::MatrixXd random_grid(Index rows, Index cols) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return value(random); });
}

TEST(Refinement, CatmullClarkOnARegularGridIsBicubicKnotInsertion) {
  const Eigen::MatrixXd coarse = random_grid(6, 5);
  // Cubic knot insertion, (1, 4, 6, 4, 1)/8, is the square of (1, 2, 1)/4 times 2.
  const Eigen::MatrixXd fine = box_spline_step(coarse, {{1, 0}, {1, 0}, {0, 1}, {0, 1}});
  expect_grid_step(Topology(torus(6, 5)), Scheme(), coarse, fine);
}

TEST(Refinement, LoopOnARegularGridIsTheThreeDirectionBoxSpline) {
  const Eigen::MatrixXd coarse = random_grid(6, 5);
  Scheme scheme;
  scheme.kind = SchemeKind::Loop;
  const Eigen::MatrixXd fine = box_spline_step(coarse, {{1, 0}, {0, 1}, {1, 1}});
  expect_grid_step(Topology(test::triangle_torus(6, 5)), scheme, coarse, fine);
}

// Alpha.

/// Around a cube's vertex the neighbours and the centroids each sum to the vertex itself: (5 + 2 alpha)/9.
TEST(Refinement, AlphaOnTheCubeIsTheClosedForm) {
  const Mesh mesh = cube();
  for (const double alpha : {0.0, 0.5, 1.0}) {
    Scheme scheme;
    scheme.alpha = alpha;
    const Values fine = refine(Topology(mesh), scheme, mesh.points, 1).values;
    EXPECT_LT(worst(fine.topRows(8), (5.0 + 2.0 * alpha) / 9.0 * mesh.points), kRounding) << alpha;
  }
}

TEST(Refinement, AlphaActsInTheFirstStepOnly) {
  const Mesh mesh = cube();
  Scheme scheme;
  scheme.alpha = 0.5;
  const RefinedSurface once = refine(Topology(mesh), scheme, mesh.points, 1);
  const RefinedSurface twice = refine(once.topology, Scheme(), once.values, 1);
  EXPECT_EQ(refine(Topology(mesh), scheme, mesh.points, 2).values, twice.values);
}

TEST(Refinement, AlphaCanBeGivenVertexByVertex) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  std::vector<double> alpha(8, 0.0);
  alpha[3] = 0.5;
  const Values fine = Refinement(topology, Scheme(), alpha).apply(mesh.points);
  for (Index v = 0; v < 8; ++v) {
    const double expected = (v == 3 ? 6.0 : 5.0) / 9.0;
    EXPECT_LT(worst(fine.row(v), expected * mesh.points.row(v)), kRounding);
  }
}

// Errors, threads, size.

TEST(Refinement, LoopOnQuadsNamesTheFace) {
  const Topology topology(test::mesh_of_faces(5, {{0, 1, 2}, {0, 2, 3, 4}}));
  Scheme scheme;
  scheme.kind = SchemeKind::Loop;
  test::expect_error([&] { Refinement(topology, scheme); }, ErrorCode::NotTriangles, "face 1 has 4");
}

TEST(Refinement, WrongArgumentsAreRefused) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  Scheme scheme;
  test::expect_error([&] { refine(topology, scheme, mesh.points, -1); }, ErrorCode::BadArgument, "levels");
  test::expect_error([&] { refine(topology, scheme, mesh.points.topRows(7), 1); }, ErrorCode::BadShape, "7 rows");
  test::expect_error([&] { Refinement(topology, scheme, {0.5}); }, ErrorCode::BadShape, "vertex_alpha");
  test::expect_error([&] { Refinement(topology, scheme, std::vector<double>(8, -0.1)); }, ErrorCode::BadArgument,
                     "alpha");
  scheme.alpha = 1.5;
  test::expect_error([&] { Refinement(topology, scheme); }, ErrorCode::BadArgument, "alpha");
  scheme.alpha = std::nan("");
  test::expect_error([&] { Refinement(topology, scheme); }, ErrorCode::BadArgument, "alpha");
}

TEST(Refinement, NoLevelsAndNoFacesAreNoError) {
  const Mesh mesh = cube();
  EXPECT_EQ(refine(Topology(mesh), Scheme(), mesh.points, 0).values, mesh.points);
  for (const auto kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    Scheme scheme;
    scheme.kind = kind;
    EXPECT_EQ(refine(Topology(Mesh()), scheme, Points(0, 3), 2).topology.vertex_count(), 0);
  }
}

TEST(Refinement, ResultsHaveTheSameBitsForAnyNumberOfThreads) {
  const Mesh mesh = test::with_random_tags(torus(120, 100), 6);
  const auto refined_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return refine(Topology(mesh), Scheme(), mesh.points, 2);
  };
  const RefinedSurface one = refined_with(1);
  const RefinedSurface two = refined_with(2);
  EXPECT_EQ(one.values, two.values);
  EXPECT_EQ(one.topology.tables().twins, two.topology.tables().twins);
  EXPECT_EQ(one.topology.tables().vertex_half_edges, two.topology.tables().vertex_half_edges);
  EXPECT_EQ(one.topology.tables().edge_sharpness, two.topology.tables().edge_sharpness);
}

/// Chaikin's rule looks at every edge around a vertex; asked edge by edge, 50,000 creases would take 10^10 steps.
TEST(Refinement, APoleOfCreasesTakesNoQuadraticTime) {
  Mesh mesh = test::bipyramid(50000);
  for (Index v = 0; v < 50000; ++v) mesh.creases.push_back({v, 50000, 2.5});
  Scheme scheme;
  scheme.crease_method = CreaseMethod::Chaikin;
  const Topology topology(mesh);
  const auto start = std::chrono::steady_clock::now();
  Refinement(topology, scheme).apply(mesh.points);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_LT(seconds.count(), 2.0);
}

}  // namespace
}  // namespace batten
