/// The fairest surface: through its targets, with its normals, never swinging more than the plain one.
#include "batten/interpolate/fair_interpolation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <string>

#include "batten/energy/shape_energy.h"
#include "batten/interpolate/fair_mesh.h"
#include "batten/interpolate/fair_system.h"
#include "batten/interpolate/interpolator.h"
#include "batten/interpolate/local_normals.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/limit/limit_matrix.h"
#include "batten/limit/vertex_limit.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/threads.h"
#include "batten/refine/refinement.h"
#include "batten/surface/limit_surface.h"
#include "batten/surface/quadrature.h"
#include "support/dense.h"
#include "support/errors.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr double kPi = std::numbers::pi;

/// Closed and open, quads, triangles and larger faces, regular or not, with creases of every kind.
std::vector<test::NamedMesh> fair_samples() {
  Mesh creased = test::jittered(grid(4, 4), 0.05, 3);
  creased.points.col(2) += 0.3 * creased.points.col(0).cwiseAbs2();
  creased.creases = {{10, 11, 10.0}, {11, 12, 10.0}, {12, 13, 1.5}};
  creased.corners = {{18, 10.0}};
  return {{"torus", test::jittered(torus(7, 5), 0.05, 1)},
          {"triangle torus", test::jittered(test::triangle_torus(7, 5), 0.05, 1)},
          {"icosahedron", icosahedron()},
          {"dodecahedron", test::jittered(dodecahedron(), 0.1, 2)},
          {"cube", cube()},
          {"bipyramid", test::bipyramid(7)},
          {"grid", test::jittered(grid(5, 4), 0.1, 5)},
          {"creased", creased}};
}

Scheme scheme_for(const Mesh& mesh) { return choose_scheme(mesh); }

double missed(const FairInterpolant& fair, ConstValuesRef targets) {
  const Values limit = LimitMatrix(fair.topology, fair.scheme).apply(fair.control);
  return (limit.topRows(targets.rows()) - targets).rowwise().norm().maxCoeff();
}

TEST(FairInterpolation, MeasuresWhereSquaresLeaveTheDoubles) {
  Mesh mesh = test::jittered(torus(7, 5), 0.05, 1);
  mesh.points *= 1e200;
  const FairInterpolant result = interpolate_fairly(Topology(mesh), Scheme(), mesh.points, {});
  EXPECT_LE(result.report.max_error / result.report.diagonal, 1e-14);
  EXPECT_TRUE(std::isfinite(result.report.rms_error));
}

TEST(FairInterpolation, PassesThroughItsTargets) {
  for (const test::NamedMesh& sample : fair_samples()) {
    for (const int levels : {1, 2}) {
      FairOptions options;
      options.levels = levels;
      const FairInterpolant fair =
          interpolate_fairly(Topology(sample.mesh), scheme_for(sample.mesh), sample.mesh.points, options);
      EXPECT_LE(missed(fair, sample.mesh.points), 1e-10 * fair.report.diagonal) << sample.name << levels;
      EXPECT_TRUE(fair.report.solve.converged) << sample.name << levels;
    }
  }
}

TEST(FairInterpolation, NeverHasMoreEnergyThanThePlainSurface) {
  for (const test::NamedMesh& sample : fair_samples()) {
    for (const auto kind : {ShapeEnergyKind::Stretch, ShapeEnergyKind::Bending, ShapeEnergyKind::Variation}) {
      FairOptions options;
      options.energy = kind;
      const FairReport report =
          interpolate_fairly(Topology(sample.mesh), scheme_for(sample.mesh), sample.mesh.points, options).report;
      // Where the plain surface is kept, its points are moved by its own error of 1e-10.
      EXPECT_LE(report.energy, report.plain_energy * (1.0 + 1e-6)) << sample.name << static_cast<int>(kind);
    }
  }
}

/// The energies are in the unit that the header says: a mesh ten times as large.
TEST(FairInterpolation, ReportsEnergiesInTheUnitOfThePoints) {
  const Mesh mesh = test::jittered(torus(6, 5), 0.05, 1);
  const Topology topology(mesh);
  const auto energy = [&](ShapeEnergyKind kind, double scale) {
    FairOptions options;
    options.energy = kind;
    options.rounds = 1;
    return interpolate_fairly(topology, test::kCatmullClark, scale * mesh.points, options).report.plain_energy;
  };
  for (int order = 1; order <= 3; ++order) {
    const auto kind = static_cast<ShapeEnergyKind>(order - 1);
    const double expected = energy(kind, 1.0);
    EXPECT_NEAR(energy(kind, 10.0) / std::pow(10.0, 4 - 2 * order), expected, 1e-6 * expected);
  }
}

/// The quadratic problem by its Lagrange multipliers: K P + A^T m = 0, A P = q.
TEST(FairInterpolation, IsTheSolutionOfTheDenseSystem) {
  for (const Mesh& mesh : {test::jittered(torus(5, 4), 0.1, 1), test::jittered(icosahedron(), 0.1, 1),
                           test::jittered(grid(3, 3), 0.1, 1)}) {
    const Scheme scheme = scheme_for(mesh);
    const RefinedSurface fine = refine(Topology(mesh), scheme, mesh.points, 1);
    const ShapeEnergy::Matrix energy =
        ShapeEnergy(SurfacePatches(fine.topology, scheme), ShapeEnergyKind::Variation).matrix(fine.values);
    const LimitMatrix limit(fine.topology, scheme);
    const auto given = static_cast<Eigen::Index>(mesh.vertex_count());
    const Eigen::Index all = fine.values.rows();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(all + given, all + given);
    system.topLeftCorner(all, all) = energy;
    system.topRightCorner(all, given) = Eigen::MatrixXd(limit.matrix()).topRows(given).transpose();
    system.bottomLeftCorner(given, all) = Eigen::MatrixXd(limit.matrix()).topRows(given);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(all + given, 3);
    right.bottomRows(given) = mesh.points;
    const Eigen::MatrixXd expected = test::solve_dense(system, right).topRows(all);

    const FairSystem fair(limit, mesh.vertex_count(), Scalars());
    Values unknowns = fair.unknowns(fine.values);
    const SolveReport report = fair.minimise(energy, mesh.points, FairNormals(), {1e-12, 1000, {}}, unknowns).solve;
    EXPECT_TRUE(report.converged);
    EXPECT_LT((fair.control(unknowns, mesh.points) - expected).cwiseAbs().maxCoeff(), 1e-7);
  }
}

/// Likewise with wanted normals n: n . t = 0 for two tangents at each vertex, over the coordinates of all points.
/// Returns how it was found.
std::string expect_dense_solution(const Mesh& mesh, const Values& wanted) {
  const RefinedSurface fine = refine(Topology(mesh), test::kLoop, mesh.points, 2);
  const ShapeEnergy::Matrix energy =
      ShapeEnergy(SurfacePatches(fine.topology, test::kLoop), ShapeEnergyKind::Bending).matrix(fine.values);
  const LimitMatrix limit(fine.topology, test::kLoop);
  const Eigen::Index all = fine.values.rows();
  const Eigen::Index given = mesh.points.rows();
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(5 * given, 3 * all);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(5 * given);
  for (Index v = 0; v < static_cast<Index>(given); ++v) {
    for (int c = 0; c < 3; ++c) {
      limit.visit_row(v, [&](Index column, double weight) { conditions(5 * v + c, 3 * column + c) += weight; });
      values[5 * v + c] = mesh.points(v, c);
    }
    for (const int t : {0, 1}) {
      visit_vertex_limit(fine.topology, test::kLoop, t == 0 ? TileValue::TangentU : TileValue::TangentV,
                         fine.topology.vertex_half_edge(v), [&](Index column, double weight) {
                           conditions.block<1, 3>(5 * v + 3 + t, 3 * column) += weight * wanted.row(v);
                         });
    }
  }
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(3 * all + 5 * given, 3 * all + 5 * given);
  for (Eigen::Index i = 0; i < all; ++i) {
    for (ShapeEnergy::Matrix::InnerIterator entry(energy, i); entry; ++entry) {
      for (int c = 0; c < 3; ++c) system(3 * i + c, 3 * entry.col() + c) = entry.value();
    }
  }
  system.topRightCorner(3 * all, 5 * given) = conditions.transpose();
  system.bottomLeftCorner(5 * given, 3 * all) = conditions;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(system.rows());
  right.tail(5 * given) = values;
  const Eigen::VectorXd expected = test::solve_dense(system, right).col(0).head(3 * all);

  const FairSystem fair(limit, mesh.vertex_count(), Scalars());
  Values unknowns = fair.unknowns(fine.values);
  const FairNormals normals(limit, wanted, fair.to_control(),
                            fair.control(Values::Zero(unknowns.rows(), 3), mesh.points));
  const SolveReport report = fair.minimise(energy, mesh.points, normals, {1e-12, 2000, {}}, unknowns).solve;
  EXPECT_TRUE(report.converged);
  const Values found = fair.control(unknowns, mesh.points);
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(found.data(), found.size()) - expected).cwiseAbs().maxCoeff(), 1e-7);
  return report.method_name;
}

TEST(FairInterpolation, IsTheSolutionOfTheDenseSystemWithNormals) {
  const Mesh mesh = test::jittered(octahedron(), 0.1, 1);
  const Values wanted = (mesh.points + 0.2 * test::jittered(mesh, 1.0, 4).points).rowwise().normalized();
  expect_dense_solution(mesh, wanted);
}

/// Steep shapes take conjugate gradients long; the whole factor and its multipliers find the same.
TEST(FairInterpolation, IsTheSolutionOfTheDenseSystemWithNormalsThatSuitNoSmoothSurface) {
  Mesh mesh = test::jittered(icosahedron(), 0.3, 1);
  mesh.points.col(0) *= 8.0;
  const Values wanted = (test::jittered(mesh, 1.0, 4).points - mesh.points).rowwise().normalized();
  EXPECT_NE(expect_dense_solution(mesh, wanted).find("sparse Cholesky"), std::string::npos);
}

/// The root of the mean square over the area of what `deviation` says of each jet.
template <typename Deviation>
double spread(const Topology& topology, const Scheme& scheme, const Values& control, const Deviation& deviation) {
  const SurfacePatches patches(topology, scheme);
  const LimitSurface surface(patches, control);
  const SurfaceQuadrature quadrature = surface_quadrature(patches, {4, 3});
  const Scalars weights = area_weights(surface, quadrature);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    sum += weights[i] * std::pow(deviation(surface.jet(quadrature.places[static_cast<std::size_t>(i)])), 2);
  }
  return std::sqrt(sum / weights.sum());
}

/// How many times nearer the fair surface is than the plain one.
template <typename Deviation>
double gain(const Mesh& mesh, const Deviation& deviation) {
  const Topology topology(mesh);
  const Scheme scheme = scheme_for(mesh);
  const Values plain = Interpolator(topology, scheme).solve(mesh.points).control;
  const FairInterpolant fair = interpolate_fairly(topology, scheme, mesh.points);
  return spread(topology, scheme, plain, deviation) / spread(fair.topology, fair.scheme, fair.control, deviation);
}

TEST(FairInterpolation, IsRounderThroughPointsOfASphere) {
  const double radius = icosahedron().points.row(0).norm();
  const auto distance = [&](const Jet& jet) { return jet.point.norm() - radius; };
  const auto bending = [&](const Jet& jet) { return curvature_of(jet).mean - 1.0 / radius; };
  EXPECT_GT(gain(icosahedron(), distance), 20.0);
  EXPECT_GT(gain(icosahedron(), bending), 3.0);
}

TEST(FairInterpolation, HasTheCurvatureOfATorusThroughFewPoints) {
  const auto gaussian = [](const Jet& jet) {
    const double angle = std::atan2(jet.point[2], std::hypot(jet.point[0], jet.point[1]) - 1.0);
    return curvature_of(jet).gaussian - std::cos(angle) / (0.4 * (1.0 + 0.4 * std::cos(angle)));
  };
  EXPECT_GT(gain(torus(12, 6), gaussian), 3.0);
  EXPECT_GT(gain(torus(24, 12), gaussian), 3.8);
  EXPECT_GT(gain(test::triangle_torus(12, 6), gaussian), 3.0);
}

/// Rows of seven points around a tube.
TEST(FairInterpolation, IsACylinderThroughPointsOfOne) {
  constexpr Index kAround = 7;
  test::Faces faces;
  for (Index i = 0; i < 6; ++i) {
    for (Index j = 0; j < kAround; ++j) {
      const Index right = (j + 1) % kAround;
      faces.push_back({i * kAround + j, i * kAround + right, (i + 1) * kAround + right, (i + 1) * kAround + j});
    }
  }
  Mesh mesh = test::mesh_of_faces(7 * kAround, faces);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double angle = 2.0 * kPi * v / kAround;
    mesh.points.row(v) << std::cos(angle), std::sin(angle), 0.8 * (v / kAround);  // NOLINT: whole rows
  }
  EXPECT_GT(gain(mesh, [](const Jet& jet) { return std::hypot(jet.point[0], jet.point[1]) - 1.0; }), 10.0);
}

TEST(FairInterpolation, DoesNotDependOnWhereAndHowLargeThePointsAre) {
  const Mesh mesh = test::jittered(test::triangle_torus(6, 5), 0.05, 1);
  const Topology topology(mesh);
  const FairInterpolant near = interpolate_fairly(topology, test::kLoop, mesh.points);
  Values moved = 1e3 * mesh.points;
  moved.rowwise() += Eigen::RowVector3d(1e9, -2e9, 5e8);
  const FairInterpolant far = interpolate_fairly(topology, test::kLoop, moved);
  Values back = far.control;
  back.rowwise() -= Eigen::RowVector3d(1e9, -2e9, 5e8);
  // Coordinates of 1e9 have digits of 2e-7, which third derivatives over edges of a tenth see a thousand times as
  // large.
  EXPECT_LT((1e-3 * back - near.control).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(1e6 * far.report.energy, near.report.energy, 1e-4 * near.report.energy);
}

TEST(FairInterpolation, HasTheNormalsWanted) {
  for (const test::NamedMesh& sample : fair_samples()) {
    const Topology topology(sample.mesh);
    const Scheme scheme = scheme_for(sample.mesh);
    FairOptions options;
    const Interpolant plain = Interpolator(topology, scheme).solve(sample.mesh.points);
    options.normals =
        limit_normals(plain.topology, plain.scheme, plain.control).vertices.topRows(topology.vertex_count());
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      options.normals.row(v) *= v % 3 == 0 ? 0.0 : 2.0;
      options.normals.row(v) +=
          options.normals.row(v).norm() * 0.05 * Eigen::RowVector3d(std::sin(v), 0.3, std::cos(v));
    }
    const FairInterpolant fair = interpolate_fairly(topology, scheme, sample.mesh.points, options);
    EXPECT_GT(fair.report.normal_count, 0) << sample.name;
    EXPECT_LE(fair.report.max_angle, 1e-8) << sample.name;
    EXPECT_LE(missed(fair, sample.mesh.points), 1e-10 * fair.report.diagonal) << sample.name;
    if (sample.name == "creased") continue;
    const LimitNormals reached = limit_normals(fair.topology, fair.scheme, fair.control);
    for (Index v = 1; v < topology.vertex_count(); v += 3) {
      const Eigen::RowVector3d normal = reached.vertices.row(v);
      if (fair.report.normal_count < topology.vertex_count() * 2 / 3) continue;  // corners of the grid
      EXPECT_LT(normal.cross(Eigen::RowVector3d(options.normals.row(v).normalized())).norm(), 1e-8) << sample.name << v;
    }
  }
}

/// The conditions alone hold for n as for -n, which is nearer here.
TEST(FairInterpolation, HasNormalsThatThePlainSurfaceHasTheOtherWay) {
  const Mesh mesh = test::jittered(torus(7, 5), 0.05, 1);
  const Topology topology(mesh);
  const Interpolant plain = Interpolator(topology, test::kCatmullClark).solve(mesh.points);
  FairOptions options;
  options.normals = limit_normals(plain.topology, plain.scheme, plain.control).vertices;
  options.normals.row(3) += Eigen::RowVector3d(0.1, 0.2, -0.1);
  options.normals.row(3) *= -1.0;
  const FairInterpolant fair = interpolate_fairly(topology, test::kCatmullClark, mesh.points, options);
  EXPECT_LE(fair.report.max_angle, 1e-8);
  EXPECT_LE(missed(fair, mesh.points), 1e-10 * fair.report.diagonal);
}

/// Normals that do not suit the points at all make opposite ones wherever the search goes.
TEST(FairInterpolation, HasNormalsThatDoNotSuitThePoints) {
  const Mesh mesh = test::jittered(torus(9, 6), 0.05, 1);
  FairOptions options;
  options.normals = test::jittered(mesh, 1.0, 7).points - mesh.points;
  for (const ShapeEnergyKind energy :
       {ShapeEnergyKind::Stretch, ShapeEnergyKind::Bending, ShapeEnergyKind::Variation}) {
    options.energy = energy;
    const FairInterpolant fair = interpolate_fairly(Topology(mesh), test::kCatmullClark, mesh.points, options);
    EXPECT_TRUE(fair.report.solve.converged);
    EXPECT_EQ(fair.report.normal_count, mesh.vertex_count());
    EXPECT_LE(fair.report.max_angle, 1e-8);
    EXPECT_LE(missed(fair, mesh.points), 1e-10 * fair.report.diagonal);
  }
}

/// A wave of eight faces along a strip, far from its ends. Bending lets the strip's free sides follow.
TEST(FairInterpolation, NeverHasMoreEnergyThanTheSurfaceWhoseNormalsAreTurned) {
  for (const test::NamedMesh& sample : fair_samples()) {
    const Topology topology(sample.mesh);
    const Scheme scheme = scheme_for(sample.mesh);
    FairOptions options;
    options.normals = estimated_wanted_normals(topology, sample.mesh.points);
    const FairInterpolant fair = interpolate_fairly(topology, scheme, sample.mesh.points, options);
    InterpolateOptions plain;
    plain.on_singular = OnSingular::Refuse;
    try {
      const Interpolant solved = Interpolator(topology, scheme, plain).solve(sample.mesh.points);
      const TurnedSurface turned = turn_normals(solved.topology, solved.scheme, solved.control, options.normals);
      const ShapeEnergy energy(SurfacePatches(fair.topology, fair.scheme), options.energy);
      EXPECT_LE(energy.energy(fair.control), energy.energy(turned.control)) << sample.name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::SingularSystem) << sample.name;
    }
  }
}

TEST(FairInterpolation, SmoothingHalvesWavesOfItsLength) {
  constexpr Index kWave = 8;
  constexpr Index kFaces = 5 * kWave;
  Mesh mesh = grid(kFaces, 4);
  const double length = 2.0 / 5.0;
  mesh.points.col(1) *= 0.4;
  mesh.points.col(2) = 0.002 * (2.0 * kPi / length * mesh.points.col(0)).array().cos();
  const Index middle = 2 * (kFaces + 1) + kFaces / 2;
  const auto height = [&](ShapeEnergyKind kind, double smoothing) {
    FairOptions options;
    options.energy = kind;
    options.smoothing = smoothing;
    const FairInterpolant fair = interpolate_fairly(Topology(mesh), test::kCatmullClark, mesh.points, options);
    return LimitMatrix(fair.topology, fair.scheme).apply(fair.control)(middle, 2) / mesh.points(middle, 2);
  };
  EXPECT_NEAR(height(ShapeEnergyKind::Bending, length), 0.5, 0.04);
  EXPECT_NEAR(height(ShapeEnergyKind::Variation, length), 0.5, 0.02);
  // Of half the length 1 of 1 + 2^-4 is left, or 1 + 2^-6.
  EXPECT_NEAR(height(ShapeEnergyKind::Bending, 0.5 * length), 16.0 / 17.0, 0.01);
  EXPECT_NEAR(height(ShapeEnergyKind::Variation, 0.5 * length), 64.0 / 65.0, 0.01);
}

/// Where points are dense the control points' lengths are those of the surface, and a second round changes nothing
/// worth its time: it is left out. Where they are not, it counts.
TEST(FairInterpolation, TakesFurtherRoundsOnlyWhereTheyCount) {
  const auto energy = [](const Mesh& mesh, int rounds) {
    FairOptions options;
    options.rounds = rounds;
    return interpolate_fairly(Topology(mesh), test::kCatmullClark, mesh.points, options).report.energy;
  };
  const Mesh dense = torus(100, 50);
  EXPECT_EQ(energy(dense, 1), energy(dense, 3));
  const Mesh coarse = torus(12, 6);
  EXPECT_LT(energy(coarse, 2), 0.99 * energy(coarse, 1));
}

TEST(FairInterpolation, ResultsDoNotDependOnTheNumberOfThreads) {
  const Mesh mesh = test::jittered(torus(40, 20), 0.01, 1);
  const Topology topology(mesh);
  FairOptions options;
  options.normals = estimated_wanted_normals(topology, mesh.points);  // in parts: 12,000 unknowns
  const Values expected = interpolate_fairly(topology, test::kCatmullClark, mesh.points, options).control;
  const ThreadLimit one(1);
  EXPECT_EQ(interpolate_fairly(topology, test::kCatmullClark, mesh.points, options).control, expected);
}

TEST(FairInterpolation, RefusesWhatHasNoMeaning) {
  const Mesh mesh = icosahedron();
  const Topology topology(mesh);
  const auto code = [&](auto change, const Scheme& scheme = test::kLoop) {
    FairOptions options;
    change(options);
    return test::code_of([&] { interpolate_fairly(topology, scheme, mesh.points, options); });
  };
  EXPECT_EQ(code([](FairOptions& o) { o.levels = 3; }), ErrorCode::BadArgument);
  EXPECT_EQ(code([](FairOptions& o) { o.rounds = 0; }), ErrorCode::BadArgument);
  for (const double length : {-1.0, 6.0, 1e300})
    EXPECT_EQ(code([=](FairOptions& o) { o.smoothing = length; }), ErrorCode::BadArgument) << length;
  EXPECT_EQ(code([](FairOptions& o) { o.normals = Values::Ones(3, 3); }), ErrorCode::BadShape);
  EXPECT_EQ(code([](FairOptions& o) {
              o.normals = Values::Ones(12, 3);
              o.levels = 1;
            }),
            ErrorCode::BadArgument);
  EXPECT_EQ(code([](FairOptions& /*o*/) {}, test::scheme_of(SchemeKind::Butterfly)), ErrorCode::BadArgument);
  EXPECT_EQ(code([](FairOptions& /*o*/) {}, test::scheme_of(SchemeKind::Loop, BoundaryRule::None)),
            ErrorCode::BadArgument);
}

TEST(FairMesh, KeepsAttributesWhereTheVerticesWere) {
  Mesh mesh = test::jittered(dodecahedron(), 0.1, 2);
  const Values colors = 0.5 + 0.4 * mesh.points.array().sin();
  mesh.attributes.push_back({"color", colors, {}});
  const Topology topology(mesh);
  const FairMesh fair = interpolate_fairly(topology, test::kCatmullClark, mesh, AttributeRule::Interpolated);
  ASSERT_EQ(fair.mesh.attributes.size(), 1U);
  const Values limit = LimitMatrix(fair.topology, fair.scheme).apply(fair.mesh.attributes[0].values);
  EXPECT_LT((limit.topRows(colors.rows()) - colors).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(Topology(fair.mesh).face_count(), fair.topology.face_count());
}

}  // namespace
}  // namespace batten
