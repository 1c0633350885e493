#include "batten/interpolate/interpolation_updates.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

#include "batten/io/io.h"
#include "batten/mesh/triangulate.h"
#include "support/errors.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::kCatmullClark;

/// Elimination: control points exact to rounding.
Values exact_control(const Topology& topology, const Scheme& scheme, const Values& targets) {
  InterpolateOptions options;
  options.method = SolveMethod::Direct;
  return Interpolator(topology, scheme, options).solve(targets).control;
}

double largest_difference(const Values& a, const Values& b) { return (a - b).rowwise().norm().maxCoeff(); }

/// Moves targets one by one and in pairs, then compares with a solve of all. The tolerance of a whole solve, which the
/// control points reach, since updates ask for 1/16 of it and the inverse of A is about 10 times as long.
void expect_whole_solve(const Mesh& mesh, const Scheme& scheme, const std::string& name) {
  const Topology topology(mesh);
  const Interpolator interpolator(topology, scheme);
  InterpolationUpdates updates(interpolator, mesh.points);
  const double diagonal = bounding_diagonal(mesh.points);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.05 * diagonal, 0.05 * diagonal);
  for (int move = 0; move < 12; ++move) {
    std::vector<Index> rows{static_cast<Index>(random() % static_cast<unsigned>(mesh.vertex_count()))};
    if (move % 3 == 0) rows.push_back((rows.front() + 1) % mesh.vertex_count());
    Values values(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i)
      values.row(static_cast<Eigen::Index>(i)) = updates.targets().row(rows[i]);
    for (double& coordinate : values.reshaped()) coordinate += shift(random);
    const UpdateReport report = updates.update(rows, values);
    EXPECT_TRUE(report.is_local) << name;
    // After each, since a later update nearby would mend what an earlier one has left.
    const Values surface = interpolator.limit_matrix().apply(updates.control());
    EXPECT_LE(largest_difference(surface, updates.targets()), 1e-11 * diagonal) << name;
  }
  const Values exact = exact_control(topology, scheme, updates.targets());
  EXPECT_LE(largest_difference(updates.control(), exact), 1e-10 * diagonal) << name;
}

Mesh creased_torus() {
  Mesh mesh = test::jittered(torus(24, 16), 0.02, 7);
  for (Index i = 0; i < 24; ++i)
    mesh.creases.push_back({mesh.face_vertices[4 * 16 * i], mesh.face_vertices[4 * 16 * i + 1], 10.0});
  mesh.creases.push_back({mesh.face_vertices[4 * 5 + 1], mesh.face_vertices[4 * 5 + 2], 10.0});  // a dart at each end
  mesh.creases.push_back({mesh.face_vertices[4 * 200], mesh.face_vertices[4 * 200 + 1], 1.7});
  mesh.corners.push_back({mesh.face_vertices[4 * 9 + 2], 10.0});
  return mesh;
}

TEST(InterpolationUpdates, EqualAWholeSolveOnClosedMeshes) {
  expect_whole_solve(test::jittered(torus(30, 20), 0.02, 7), kCatmullClark, "torus");
  expect_whole_solve(test::random_hull(300, 2), kCatmullClark, "hull");
  expect_whole_solve(test::random_hull(300, 2), test::kLoop, "hull under Loop");
  expect_whole_solve(test::triangle_torus(20, 14), test::kLoop, "triangle torus under Loop");
  expect_whole_solve(dodecahedron(), kCatmullClark, "dodecahedron");
}

TEST(InterpolationUpdates, EqualAWholeSolveOnOpenMeshes) {
  for (const BoundaryRule rule : {BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner, BoundaryRule::None}) {
    const Mesh mesh = test::jittered(grid(16, 12), 0.1, 7);
    expect_whole_solve(mesh, test::scheme_of(SchemeKind::CatmullClark, rule), "grid");
    expect_whole_solve(triangulated(mesh), test::scheme_of(SchemeKind::Loop, rule), "triangulated grid");
  }
}

TEST(InterpolationUpdates, EqualAWholeSolveAcrossCreasesCornersAndDarts) {
  expect_whole_solve(creased_torus(), kCatmullClark, "creased torus");
  expect_whole_solve(test::with_random_tags(test::jittered(torus(12, 9), 0.02, 7), 5), kCatmullClark, "random tags");
  expect_whole_solve(test::with_random_tags(test::triangle_torus(12, 9), 5), test::kLoop, "random tags under Loop");
}

TEST(InterpolationUpdates, AThousandMovesLeaveNoDrift) {
  const Mesh mesh = creased_torus();
  const Topology topology(mesh);
  InterpolationUpdates updates(Interpolator(topology, kCatmullClark), mesh.points);
  const double diagonal = bounding_diagonal(mesh.points);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> shift(-0.05 * diagonal, 0.05 * diagonal);
  double bound = 0.0;
  for (int move = 0; move < 1000; ++move) {
    const auto v = static_cast<Index>(random() % static_cast<unsigned>(mesh.vertex_count()));
    Values value = mesh.points.row(v);
    for (double& coordinate : value.reshaped()) coordinate += shift(random);
    bound = updates.update({&v, 1}, value).error_bound;
  }
  EXPECT_LE(largest_difference(updates.control(), exact_control(topology, kCatmullClark, updates.targets())),
            1e-10 * diagonal);
  EXPECT_LE(bound, 1e-11 * diagonal);
}

TEST(InterpolationUpdates, ReportABoundOfAllErrors) {
  const Mesh mesh = test::jittered(torus(60, 40), 0.02, 7);
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kCatmullClark);
  InterpolationUpdates updates(interpolator, mesh.points);
  for (Index v = 0; v < 2400; v += 100) {
    const UpdateReport report = updates.update({&v, 1}, 1.05 * mesh.points.row(v));
    const Values surface = interpolator.limit_matrix().apply(updates.control());
    // Sums in another order differ by rounding.
    EXPECT_LE(largest_difference(surface, updates.targets()), report.error_bound + 1e-14);
  }
}

TEST(InterpolationUpdates, MoveNothingFarFromTheChange) {
  const Mesh mesh = test::jittered(torus(200, 150), 0.002, 7);
  InterpolationUpdates updates(Interpolator(Topology(mesh), kCatmullClark), mesh.points);
  const Values before = updates.control();
  const Index v = 12345;
  const UpdateReport report = updates.update({&v, 1}, 1.01 * mesh.points.row(v));
  // A change of some 1e-2 falls below 1e-11 after 16 rings of a factor 3.7: a square of 33 by 33 at the most.
  EXPECT_LT(report.moved, 33 * 33);
  std::vector<std::uint8_t> moved(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const Index m : updates.moved()) moved[static_cast<std::size_t>(m)] = 1;
  for (Index i = 0; i < mesh.vertex_count(); ++i) {
    EXPECT_EQ((updates.control().row(i).array() == before.row(i).array()).all(),
              moved[static_cast<std::size_t>(i)] == 0);
  }
}

TEST(InterpolationUpdates, SolveEverythingWhereMostTargetsChange) {
  const Mesh mesh = test::jittered(torus(60, 40), 0.02, 7);
  const Topology topology(mesh);
  InterpolationUpdates updates(Interpolator(topology, kCatmullClark), mesh.points);
  std::vector<Index> rows(2400);
  for (Index v = 0; v < 2400; ++v) rows[static_cast<std::size_t>(v)] = v;
  const UpdateReport report = updates.update(rows, 2.0 * mesh.points);
  EXPECT_FALSE(report.is_local);
  EXPECT_EQ(report.outcome, Outcome::Reached);
  EXPECT_EQ(updates.moved().size(), 2400U);
  EXPECT_LE(largest_difference(updates.control(), exact_control(topology, kCatmullClark, updates.targets())),
            1e-10 * bounding_diagonal(updates.targets()));
}

/// A vertex in each face and a face around each vertex: of triangles, all valences are 3.
Mesh dual(const Mesh& mesh) {
  const Topology topology(mesh);
  test::Faces faces;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    faces.emplace_back();
    topology.for_each_outgoing(v, [&](Index h) { faces.back().push_back(topology.face(h)); });
  }
  Mesh result = test::mesh_of_faces(mesh.face_count(), faces);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    result.points.row(f).setZero();
    for (Index i = 3 * f; i < 3 * f + 3; ++i) result.points.row(f) += mesh.points.row(mesh.face_vertices[i]) / 3.0;
  }
  return result;
}

/// Nearly singular: the influence of a target reaches far, and relaxation is slow.
TEST(InterpolationUpdates, SolveEverythingWhereTheInfluenceReachesFar) {
  const Mesh mesh = dual(test::random_hull(2500, 3));
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kCatmullClark);
  InterpolationUpdates updates(interpolator, mesh.points);
  const Index v = 1000;
  const UpdateReport report = updates.update({&v, 1}, 1.01 * mesh.points.row(v));
  EXPECT_FALSE(report.is_local);
  EXPECT_GT(report.steps, 0);  // tried
  const Values surface = interpolator.limit_matrix().apply(updates.control());
  EXPECT_LE(largest_difference(surface, updates.targets()), 1e-10 * bounding_diagonal(mesh.points));
}

TEST(InterpolationUpdates, TakeNoChangeAtAll) {
  const Mesh mesh = torus(8, 6);
  InterpolationUpdates updates(Interpolator(Topology(mesh), kCatmullClark), mesh.points);
  EXPECT_EQ(updates.update({}, Values(0, 3)).moved, 0);
  EXPECT_EQ(updates.update_within(2, {}, Values(0, 3)).moved, 0);
}

/// Without a change, the start is as good as an update leaves it.
TEST(InterpolationUpdates, BeginBetterThanAWholeSolve) {
  const Mesh mesh = test::jittered(torus(60, 40), 0.02, 7);
  const Topology topology(mesh);
  InterpolationUpdates updates(Interpolator(topology, kCatmullClark), mesh.points);
  EXPECT_LE(updates.update({}, Values(0, 3)).error_bound, 1e-10 / 16.0 * bounding_diagonal(mesh.points));
}

TEST(InterpolationUpdates, CarryAnyNumberOfColumns) {
  const Mesh mesh = test::jittered(torus(20, 12), 0.02, 7);
  const Topology topology(mesh);
  Values targets(mesh.vertex_count(), 5);
  targets << mesh.points, mesh.points.leftCols(2).array().square().matrix();
  InterpolationUpdates updates(Interpolator(topology, kCatmullClark), targets);
  const Index v = 77;
  EXPECT_TRUE(updates.update({&v, 1}, 1.1 * targets.row(v)).is_local);
  EXPECT_LE(largest_difference(updates.control(), exact_control(topology, kCatmullClark, updates.targets())),
            1e-10 * bounding_diagonal(targets));
}

/// Coordinates of 1e7 have 2e-9 between them: as near as that, and no endless search for more.
TEST(InterpolationUpdates, StopAtRoundingFarFromTheOrigin) {
  Mesh mesh = test::jittered(torus(30, 20), 0.02, 7);
  mesh.points.rowwise() += Eigen::RowVector3d(1e7, -1e7, 1e7);
  InterpolationUpdates updates(Interpolator(Topology(mesh), kCatmullClark), mesh.points);
  const Index v = 99;
  const UpdateReport report = updates.update({&v, 1}, mesh.points.row(v) + Eigen::RowVector3d(0.1, 0.0, 0.0));
  EXPECT_TRUE(report.is_local);
  EXPECT_LE(report.error_bound, 1e-7);
}

Mesh cube_beside_torus() {
  Mesh mesh = cube();
  const Mesh other = test::jittered(torus(30, 20), 0.02, 7);
  test::Faces faces = test::faces_of(mesh);
  for (std::vector<Index> face : test::faces_of(other)) {
    for (Index& v : face) v += 8;
    faces.push_back(face);
  }
  Mesh both = test::mesh_of_faces(608, faces);
  both.points << mesh.points, other.points;
  return both;
}

TEST(InterpolationUpdates, SolveASingularComponentAsAWhole) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kCatmullClark);
  InterpolationUpdates updates(interpolator, mesh.points);  // these targets have a surface
  EXPECT_EQ(updates.control().rows(), 8);
  const Index v = 3;
  const UpdateReport report = updates.update({&v, 1}, 1.5 * mesh.points.row(v));  // these have not
  EXPECT_FALSE(report.is_local);
  const Interpolant whole = interpolator.solve(updates.targets());
  EXPECT_EQ(updates.topology().vertex_count(), whole.topology.vertex_count());
  EXPECT_EQ(largest_difference(updates.control(), whole.control), 0.0);
  test::expect_error(
      [&] {
        updates.update_within(2, {&v, 1}, mesh.points.row(v));
      },
      ErrorCode::SingularSystem, "refined once");
}

TEST(InterpolationUpdates, StayLocalBesideASingularComponent) {
  Mesh mesh = cube_beside_torus();
  mesh.points.row(0) *= 1.5;
  const Topology topology(mesh);
  InterpolateOptions options;
  options.on_singular = OnSingular::LeastSquares;
  const Interpolator interpolator(topology, kCatmullClark, options);
  InterpolationUpdates updates(interpolator, mesh.points);
  const Index v = 100;
  EXPECT_TRUE(updates.update({&v, 1}, 1.1 * mesh.points.row(v)).is_local);
  const Values whole = interpolator.solve(updates.targets()).control;
  // Both to their tolerance; least squares are not refined further.
  EXPECT_LE(largest_difference(updates.control(), whole), 2e-9 * bounding_diagonal(mesh.points));
  const Index w = 1;
  EXPECT_FALSE(updates.update({&w, 1}, 1.1 * mesh.points.row(w)).is_local);
}

TEST(InterpolationUpdates, LeaveEverythingAsItWasWhereTheyCannotBeMade) {
  const Mesh mesh = cube();
  InterpolateOptions options;
  options.on_singular = OnSingular::Refuse;
  InterpolationUpdates updates(Interpolator(Topology(mesh), kCatmullClark, options), mesh.points);
  const Values control = updates.control();
  const Index v = 3;
  test::expect_error([&] { updates.update({&v, 1}, 1.5 * mesh.points.row(v)); }, ErrorCode::SingularSystem, "");
  EXPECT_EQ(largest_difference(updates.control(), control), 0.0);
  EXPECT_EQ(largest_difference(updates.targets(), mesh.points), 0.0);
}

TEST(InterpolationUpdates, RefuseWhatIsNoChangeOfTargets) {
  const Mesh mesh = torus(8, 6);
  InterpolationUpdates updates(Interpolator(Topology(mesh), kCatmullClark), mesh.points);
  const auto update = [&](std::vector<Index> rows, const Values& values) {
    return [&updates, rows = std::move(rows), values] { updates.update(rows, values); };
  };
  const Values one = Values::Zero(1, 3);
  test::expect_error(update({48}, one), ErrorCode::IndexOutOfRange, "no target 48");
  test::expect_error(update({-1}, one), ErrorCode::IndexOutOfRange, "no target -1");
  test::expect_error(update({1}, Values::Zero(1, 2)), ErrorCode::BadShape, "3 numbers");
  test::expect_error(update({1, 2}, one), ErrorCode::BadShape, "2 targets");
  test::expect_error(update({1, 1}, Values::Zero(2, 3)), ErrorCode::BadArgument, "twice");
  test::expect_error(update({1}, Values::Constant(1, 3, std::nan(""))), ErrorCode::NotFinite, "vertex 1");
  const Index v = 1;
  test::expect_error([&] { updates.update_within(-1, {&v, 1}, one); }, ErrorCode::BadArgument, "rings");
  EXPECT_EQ(largest_difference(updates.targets(), mesh.points), 0.0);
}

TEST(InterpolationUpdates, GoOnFromControlPoints) {
  const Mesh mesh = test::jittered(torus(30, 20), 0.02, 7);
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kCatmullClark);
  InterpolationUpdates updates = InterpolationUpdates::from_control(interpolator, mesh.points);
  EXPECT_EQ(largest_difference(updates.control(), mesh.points), 0.0);
  const Index v = 50;
  const Values target = 1.1 * updates.targets().row(v);
  EXPECT_TRUE(updates.update({&v, 1}, target).is_local);
  EXPECT_LE(largest_difference(updates.control(), exact_control(topology, kCatmullClark, updates.targets())),
            1e-10 * bounding_diagonal(mesh.points));
}

/// The two-level oracle: dense least squares in the null space of the constraints.
Values dense_change(const Eigen::MatrixXd& a, const std::vector<Index>& unknown, const std::vector<Index>& exact,
                    const Values& residual) {
  const Eigen::MatrixXd columns = a(Eigen::all, unknown);
  const Eigen::MatrixXd c = columns(exact, Eigen::all);
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> constraints(c);
  const Eigen::MatrixXd particular = constraints.solve(Eigen::MatrixXd(residual(exact, Eigen::all)));
  const Eigen::MatrixXd q = constraints.matrixZ().transpose();
  const Eigen::MatrixXd null = (constraints.colsPermutation() * q).rightCols(c.cols() - constraints.rank());
  const Eigen::MatrixXd rest = residual - columns * particular;
  return particular + null * (columns * null).colPivHouseholderQr().solve(rest);
}

TEST(InterpolationUpdates, WithinRingsAreTheBestThatTheseControlPointsCanDo) {
  for (const bool open : {false, true}) {
    const Mesh mesh = open ? test::jittered(grid(14, 10), 0.1, 7) : test::jittered(torus(14, 10), 0.02, 7);
    const Topology topology(mesh);
    const Interpolator interpolator(topology, kCatmullClark);
    InterpolationUpdates updates = InterpolationUpdates::from_control(interpolator, mesh.points);
    const Values before = updates.control();
    const std::vector<Index> rows{64, 66};
    Values values(2, 3);
    values << updates.targets().row(64), updates.targets().row(66);
    values.array() += 0.1;
    Values residual = Values::Zero(mesh.vertex_count(), 3);
    for (const Index v : rows) residual.row(v).setConstant(0.1);
    const UpdateReport report = updates.update_within(2, rows, values);
    const std::vector<Index> moved(updates.moved().begin(), updates.moved().end());
    const Values expected = dense_change(Eigen::MatrixXd(interpolator.limit_matrix().matrix()), moved, rows, residual);
    const Values change = (updates.control() - before)(moved, Eigen::all);
    EXPECT_LE(largest_difference(change, expected), 1e-12);
    EXPECT_LE(report.max_error, 1e-14);
  }
}

TEST(InterpolationUpdates, WithinRingsMoveNothingElse) {
  const Mesh mesh = test::jittered(torus(40, 30), 0.02, 7);
  const Topology topology(mesh);
  const Interpolator interpolator(topology, kCatmullClark);
  InterpolationUpdates updates(interpolator, mesh.points);
  const Index v = 20 * 30 + 15;
  for (int rings = 0; rings < 4; ++rings) {
    const Values before = updates.control();
    const UpdateReport report = updates.update_within(rings, {&v, 1}, (1.0 + 0.01 * rings) * 1.05 * mesh.points.row(v));
    EXPECT_EQ(report.moved, (2 * rings + 1) * (2 * rings + 1));
    for (Index i = 0; i < mesh.vertex_count(); ++i) {
      const bool inside = std::abs(i / 30 - 20) <= rings && std::abs(i % 30 - 15) <= rings;
      EXPECT_EQ((updates.control().row(i).array() == before.row(i).array()).all(), !inside);
    }
    EXPECT_LE(largest_difference(interpolator.limit_matrix().apply(updates.control()), updates.targets()),
              1e-10 / 16.0 * bounding_diagonal(mesh.points));
  }
}

TEST(InterpolationUpdates, MissLessWithEachRingMore) {
  const Mesh mesh = test::jittered(torus(60, 40), 0.002, 7);
  const Interpolator interpolator(Topology(mesh), kCatmullClark);
  const Index v = 20 * 40 + 15;
  double last = 0.0;
  for (int rings = 0; rings <= 8; ++rings) {
    InterpolationUpdates updates(interpolator, mesh.points);
    const UpdateReport report = updates.update_within(rings, {&v, 1}, 1.05 * mesh.points.row(v));
    if (rings > 2) {
      EXPECT_LT(report.max_miss, 0.4 * last);  // a factor of 2 - sqrt(3) = 0.27 in the end
    }
    last = report.max_miss;
  }
}

TEST(InterpolationUpdates, EqualAWholeSolveOnBeast) {
  const char* const data = std::getenv("BATTEN_DATA");
  if (data == nullptr) GTEST_SKIP() << "BATTEN_DATA is not set";
  const Mesh mesh = read_mesh(std::string(data) + "/meshes/beast.obj");
  expect_whole_solve(mesh, choose_scheme(mesh), "beast");
}

}  // namespace
}  // namespace batten
