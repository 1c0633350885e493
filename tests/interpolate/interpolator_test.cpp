#include "batten/interpolate/interpolator.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

Interpolant solve(const Mesh& mesh, const Scheme& scheme, const InterpolateOptions& options = {}) {
  const Topology topology(mesh);
  return Interpolator(topology, scheme, options).solve(mesh.points);
}

Scheme scheme_of(SchemeKind kind, BoundaryRule boundary = BoundaryRule::EdgeOnly) {
  Scheme scheme;
  scheme.kind = kind;
  scheme.boundary = boundary;
  return scheme;
}

const Scheme kQuads = scheme_of(SchemeKind::CatmullClark);
const Scheme kLoop = scheme_of(SchemeKind::Loop);

/// Points moved by up to `amount`, the same at every run.
Mesh shaken(Mesh mesh, double amount) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (int c = 0; c < 3; ++c) mesh.points(v, c) += uniform(generator);
  }
  return mesh;
}

double error_of(const Mesh& mesh, const Interpolant& result) {
  return result.report.max_error / bounding_diagonal(mesh.points);
}

TEST(Interpolator, PassesThroughANoisyTorus) {
  const Mesh mesh = shaken(torus(60, 40), 0.02);
  EXPECT_LE(error_of(mesh, solve(mesh, kQuads)), 1e-10);
}

TEST(Interpolator, SolvesWhereSquaresLeaveTheDoubles) {
  const Mesh mesh = shaken(torus(12, 8), 0.02);
  const Interpolant unit = solve(mesh, kQuads);
  for (const int exponent : {-700, 700}) {
    Mesh scaled = mesh;
    scaled.points *= std::ldexp(1.0, exponent);
    const Interpolant result = solve(scaled, kQuads);
    EXPECT_EQ(result.report.outcome, Outcome::Reached);
    EXPECT_EQ(result.report.solve.iterations, unit.report.solve.iterations);
    EXPECT_TRUE(std::isfinite(result.report.rms_error));
    EXPECT_LE(result.report.max_error / result.report.diagonal, 1e-10);
    EXPECT_NEAR(result.report.diagonal * std::ldexp(1.0, -exponent), unit.report.diagonal, 1e-12);
    const Values back = result.control * std::ldexp(1.0, -exponent);
    EXPECT_LE((back - unit.control).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Interpolator, PassesThroughTheRegularSolidsByBothSchemes) {
  for (const Mesh& mesh : {tetrahedron(), octahedron(), icosahedron()}) {
    EXPECT_LE(error_of(mesh, solve(mesh, kQuads)), 1e-10);
    EXPECT_LE(error_of(mesh, solve(mesh, kLoop)), 1e-10);
  }
}

/// Closed form: on the tetrahedron the Loop limit shrinks every vertex by 5, Catmull-Clark's by 9/2
/// (data/reference.json).
TEST(Interpolator, ScalesTheTetrahedronByTheInverseOfItsLimit) {
  const Mesh mesh = tetrahedron();
  EXPECT_LT((solve(mesh, kLoop).control - 5.0 * mesh.points).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((solve(mesh, kQuads).control - 4.5 * mesh.points).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Interpolator, ReproducesAPlaneWithItsBoundary) {
  const Mesh mesh = grid(9, 7);
  const Interpolant result = solve(mesh, kQuads);
  EXPECT_LE(error_of(mesh, result), 1e-10);
  EXPECT_LT(result.control.col(2).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Interpolator, KeepsCornersUnderEdgeAndCorner) {
  const Mesh mesh = shaken(grid(6, 6), 0.1);
  const Interpolant result = solve(mesh, scheme_of(SchemeKind::CatmullClark, BoundaryRule::EdgeAndCorner));
  EXPECT_TRUE((result.control.row(0).array() == mesh.points.row(0).array()).all());
  EXPECT_LE(error_of(mesh, result), 1e-10);
}

TEST(Interpolator, PassesThroughCreasesCornersAndDarts) {
  Mesh mesh = shaken(torus(24, 16), 0.02);
  for (Index i = 0; i < 24; ++i)
    mesh.creases.push_back({mesh.face_vertices[4 * 16 * i], mesh.face_vertices[4 * 16 * i + 1], 10.0});
  mesh.creases.push_back({mesh.face_vertices[4 * 5 + 1], mesh.face_vertices[4 * 5 + 2], 10.0});  // a dart at each end
  mesh.corners.push_back({mesh.face_vertices[4 * 9 + 2], 10.0});
  EXPECT_LE(error_of(mesh, solve(mesh, kQuads)), 1e-10);
}

TEST(Interpolator, PassesThroughSemiSharpCreases) {
  for (const CreaseMethod method : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
    Mesh mesh = shaken(torus(20, 14), 0.02);
    for (Index f = 0; f < 40; ++f) {
      mesh.creases.push_back({mesh.face_vertices[4 * f], mesh.face_vertices[4 * f + 1], 0.3 + 0.11 * f});
    }
    Scheme scheme = kQuads;
    scheme.crease_method = method;
    const Interpolant result = solve(mesh, scheme);
    EXPECT_LE(error_of(mesh, result), 1e-10);
    // Forty times faster than BiCGSTAB on the rows; the equations are not symmetric here.
    EXPECT_EQ(result.report.solve.method, SolveMethod::Chebyshev);
  }
}

/// What the report says must be what refinement does: the refined even vertices come to the targets.
TEST(Interpolator, RefinementConvergesToTheTargets) {
  Mesh mesh = shaken(torus(10, 8), 0.02);
  mesh.creases.push_back({mesh.face_vertices[0], mesh.face_vertices[1], 1.7});
  const Topology topology(mesh);
  const Interpolant result = Interpolator(topology, kQuads).solve(mesh.points);
  const RefinedSurface refined = refine(topology, kQuads, result.control, 5);
  const double miss = (refined.values.topRows(mesh.vertex_count()) - mesh.points).rowwise().norm().maxCoeff();
  const double start = (result.control - mesh.points).rowwise().norm().maxCoeff();
  EXPECT_LT(miss,
            start * std::pow(0.45, 5));  // the slowest rate towards the limit is about 1/4 at valence 4, 0.41 at a dart
}

TEST(Interpolator, CarriesOtherColumnsAlong) {
  const Mesh mesh = shaken(torus(20, 12), 0.02);
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kQuads);
  Values columns(mesh.vertex_count(), 6);
  columns << mesh.points, mesh.points.cwiseAbs();
  const Interpolant result = interpolator.solve(columns);
  EXPECT_LE(result.report.max_error, 1e-10 * bounding_diagonal(columns));
  EXPECT_EQ(result.control.cols(), 6);
}

TEST(Interpolator, PassesIsolatedVerticesThrough) {
  Mesh mesh = tetrahedron();
  mesh.points.conservativeResize(5, 3);
  mesh.points.row(4) << 3.0, 4.0, 5.0;
  const Interpolant result = solve(mesh, kLoop);
  EXPECT_TRUE((result.control.row(4).array() == mesh.points.row(4).array()).all());
  EXPECT_LE(error_of(mesh, result), 1e-10);
}

TEST(Interpolator, MethodsAgree) {
  Mesh mesh = shaken(torus(40, 30), 0.02);
  mesh.face_offsets.pop_back();  // one face less: a boundary
  mesh.face_vertices.resize(static_cast<std::size_t>(mesh.face_offsets.back()));
  const Interpolant direct = solve(mesh, kQuads, {SolveMethod::Direct});
  EXPECT_LE(error_of(mesh, direct), 1e-14);
  for (const SolveMethod method : {SolveMethod::Auto, SolveMethod::ConjugateGradient, SolveMethod::Chebyshev,
                                   SolveMethod::Jacobi, SolveMethod::Richardson}) {
    const Interpolant result = solve(mesh, kQuads, {method});
    EXPECT_TRUE(result.report.converged()) << result.report.solve.method_name;
    // An error of 1e-10 in the limit positions is at most 1/lambda_min(A), some 13, times that in the control points.
    EXPECT_LT((result.control - direct.control).rowwise().norm().maxCoeff(), 2e-9 * bounding_diagonal(mesh.points))
        << result.report.solve.method_name;
  }
}

TEST(Interpolator, CommutesWithAffineMaps) {
  const Mesh mesh = shaken(torus(16, 12), 0.02);
  const Eigen::Matrix3d linear = (Eigen::Matrix3d() << 1, 2, 0, -1, 1, 3, 0.5, 0, 2).finished();
  Mesh mapped = mesh;
  mapped.points = (mesh.points * linear).rowwise() + Eigen::RowVector3d(5, -7, 9);
  const Values direct = solve(mapped, kQuads, {SolveMethod::Direct}).control;
  const Values image =
      (solve(mesh, kQuads, {SolveMethod::Direct}).control * linear).rowwise() + Eigen::RowVector3d(5, -7, 9);
  EXPECT_LT((direct - image).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Interpolator, DoesNotDependOnTheNumbering) {
  const Mesh mesh = shaken(torus(30, 20), 0.02);
  const Index n = mesh.vertex_count();
  Mesh renumbered = mesh;
  const auto image = [&](Index v) { return static_cast<Index>((std::int64_t{v} * 77 + 5) % n); };  // gcd(77, 600) = 1
  for (Index v = 0; v < n; ++v) renumbered.points.row(image(v)) = mesh.points.row(v);
  for (Index& v : renumbered.face_vertices) v = image(v);
  const Values a = solve(mesh, kQuads, {SolveMethod::Auto, 1e-13}).control;
  const Values b = solve(renumbered, kQuads, {SolveMethod::Auto, 1e-13}).control;
  for (Index v = 0; v < n; ++v) EXPECT_LT((a.row(v) - b.row(image(v))).norm(), 1e-11);
}

TEST(Interpolator, ThreadsDoNotChangeABit) {
  Mesh mesh = shaken(torus(90, 80), 0.01);
  mesh.face_offsets.pop_back();
  mesh.face_vertices.resize(static_cast<std::size_t>(mesh.face_offsets.back()));
  for (const SolveMethod method : {SolveMethod::Auto, SolveMethod::ConjugateGradient}) {
    const auto solved = [&](int threads) {
      const ThreadLimit limit(threads);
      return solve(mesh, kQuads, {method}).control;
    };
    EXPECT_TRUE((solved(1).array() == solved(2).array()).all());
  }
}

TEST(Interpolator, ReportsWhereItIsWorst) {
  const Mesh mesh = shaken(torus(20, 12), 0.05);
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kQuads, {SolveMethod::Jacobi, 1e-3});
  const Interpolant result = interpolator.solve(mesh.points);
  const Eigen::VectorXd errors = (interpolator.limit_matrix().apply(result.control) - mesh.points).rowwise().norm();
  Eigen::Index worst = 0;
  EXPECT_NEAR(result.report.max_error, errors.maxCoeff(&worst), 1e-15);
  EXPECT_EQ(result.report.worst.front().row, worst);
  EXPECT_NEAR(result.report.rms_error, errors.norm() / std::sqrt(mesh.vertex_count()), 1e-15);
  EXPECT_EQ(result.report.worst.size(), 10U);
}

TEST(Interpolator, RefusesTargetsOfTheWrongShapeOrValue) {
  const Mesh mesh = torus(8, 6);
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kQuads);
  EXPECT_THROW(interpolator.solve(Values::Zero(5, 3)), Error);
  Values targets = mesh.points;
  targets(3, 1) = std::nan("");
  EXPECT_THROW(interpolator.solve(targets), Error);
}

TEST(Interpolator, SolvesAPoleOfHighValenceAndAFaceOfManySides) {
  const Mesh pole = test::bipyramid(5000);
  EXPECT_LE(error_of(pole, solve(pole, kLoop)), 1e-10);
  EXPECT_LE(error_of(pole, solve(pole, kQuads)), 1e-10);
  Mesh prism;  // two faces of 2,001 sides, odd, so that the system is regular though every valence is 3
  const Index n = 2001;
  prism.points.resize(2 * n, 3);
  for (Index v = 0; v < n; ++v) {
    prism.points.row(v) << std::cos(2 * M_PI * v / n), std::sin(2 * M_PI * v / n), 0.0;
    prism.points.row(n + v) = prism.points.row(v) + Eigen::RowVector3d(0, 0, 1);
    prism.add_face({v, (v + 1) % n, n + (v + 1) % n, n + v});
  }
  for (Index v = 0; v < n; ++v) prism.face_vertices.push_back(n - 1 - v);
  prism.face_offsets.push_back(static_cast<Index>(prism.face_vertices.size()));
  for (Index v = 0; v < n; ++v) prism.face_vertices.push_back(n + v);
  prism.face_offsets.push_back(static_cast<Index>(prism.face_vertices.size()));
  EXPECT_LE(error_of(prism, solve(prism, kQuads)), 1e-10);
}

TEST(Interpolator, RefusesOptionsBeforeItBuilds) {
  const Topology quads(torus(8, 6));
  for (const InterpolateOptions& options :
       {InterpolateOptions{SolveMethod::Auto, 0.0}, InterpolateOptions{SolveMethod::Jacobi, 1e-10, -1.0},
        InterpolateOptions{SolveMethod::Auto, 1e-10, 0.5, -1}}) {
    try {
      Interpolator(quads, kLoop, options);  // quads under Loop are an error too, but a later one
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::BadArgument) << error.what();
    }
  }
}

TEST(Interpolator, NamesTheMethodThatSolved) {
  Mesh mesh = shaken(torus(12, 9), 0.02);
  EXPECT_EQ(solve(mesh, kQuads).report.solve.method, SolveMethod::Chebyshev);
  EXPECT_EQ(solve(mesh, kQuads, {SolveMethod::Direct}).report.solve.method, SolveMethod::Direct);
  EXPECT_EQ(solve(mesh, kQuads, {SolveMethod::ConjugateGradient}).report.solve.method, SolveMethod::ConjugateGradient);
  mesh.creases = {{mesh.face_vertices[0], mesh.face_vertices[1], 10.0}};  // darts
  EXPECT_EQ(solve(mesh, kQuads, {SolveMethod::ConjugateGradient}).report.solve.method, SolveMethod::BiCgStab);
}

/// At 4.5e7 numbers are rounded by up to 3.7e-9.
TEST(Interpolator, ComesAsNearAsDoublesFarFromTheOrigin) {
  Mesh mesh = shaken(tetrahedron(), 0.1);
  mesh.points.rowwise() += Eigen::RowVector3d(4.5e7, 5.2e6, 300.0);
  const Interpolant result = solve(mesh, kQuads);
  EXPECT_EQ(result.report.outcome, Outcome::Rounding);
  EXPECT_LE(result.report.max_error, 1e-8);
  Mesh near = mesh;
  near.points.rowwise() -= Eigen::RowVector3d(4.5e7, 5.2e6, 300.0);
  Values moved = solve(near, kQuads, {SolveMethod::Direct}).control;
  moved.rowwise() += Eigen::RowVectorXd(Eigen::RowVector3d(4.5e7, 5.2e6, 300.0));
  EXPECT_LE((result.control - moved).cwiseAbs().maxCoeff(), 1.5e-8);  // 2 units in the last place
}

TEST(Interpolator, DoesNotClaimAToleranceBelowRounding) {
  const Interpolant result = solve(shaken(torus(12, 9), 0.02), kQuads, {SolveMethod::Auto, 1e-17});
  EXPECT_EQ(result.report.outcome, Outcome::Rounding);
  EXPECT_LE(result.report.max_error, 1e-14);
}

TEST(Interpolator, HoldsASmallComponentToItsOwnSize) {
  Mesh mesh = shaken(torus(16, 12), 0.02);
  const Mesh small = shaken(torus(16, 12), 0.03);
  const Index count = mesh.vertex_count();
  mesh.points *= 1e6;
  mesh.points.conservativeResize(2 * count, 3);
  mesh.points.bottomRows(count) = small.points;
  for (Index f = 0; f < small.face_count(); ++f) {
    for (Index i = 0; i < 4; ++i) mesh.face_vertices.push_back(count + small.face_vertices[4 * f + i]);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  const Interpolant result = solve(mesh, kQuads);
  EXPECT_EQ(result.report.outcome, Outcome::Reached);
  const Topology topology(mesh);
  const Values miss = LimitMatrix(topology, kQuads).apply(result.control) - mesh.points;
  EXPECT_LE(miss.bottomRows(count).rowwise().norm().maxCoeff(), 1e-10 * bounding_diagonal(small.points));
}

TEST(Interpolator, ReachesValuesThatAreEverywhereTheSame) {
  const Mesh mesh = torus(12, 9);
  const Topology topology(mesh);
  const Interpolant result = Interpolator(topology, kQuads).solve(Values::Constant(mesh.vertex_count(), 1, 0.1));
  EXPECT_EQ(result.report.outcome, Outcome::Reached);
  EXPECT_TRUE((result.control.array() == 0.1).all());
}

}  // namespace
}  // namespace batten
