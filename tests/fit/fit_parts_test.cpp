/// What a fit is made of: models of distances, the linear system, spheres around points, outliers, fewer points.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>
#include <set>

#include "batten/fit/belonging.h"
#include "batten/fit/enclosing_sphere.h"
#include "batten/fit/normal_equations.h"
#include "batten/fit/outliers.h"
#include "batten/fit/squared_distance_model.h"
#include "batten/fit/start_sphere.h"
#include "batten/fit/surface_fitter.h"
#include "batten/fit/thin_cloud.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "fit/clouds.h"
#include "support/dense.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::CloudMaker;

Eigen::Matrix3d matrix_of_form(const Form& form) {
  Eigen::Matrix3d matrix;
  for (int c = 0; c < 3; ++c) matrix.col(c) = multiply(form, Eigen::Vector3d::Unit(c));
  return matrix;
}

/// A sphere of radius r: 1 along the normal, d / (d + r) along the surface, inside and outside.
TEST(SquaredDistanceModel, OfASphereHasItsClosedForm) {
  const double r = 2.0;
  Jet jet;
  jet.point = {0.0, 0.0, r};
  jet.du = Eigen::Vector3d::UnitX();
  jet.dv = Eigen::Vector3d::UnitY();
  jet.duu = jet.dvv = {0.0, 0.0, -1.0 / r};
  jet.duv.setZero();
  for (const double d : {0.5, -0.5, 1e-9}) {
    const double along = std::abs(d) / (std::abs(d) + r);
    const Eigen::Matrix3d form = matrix_of_form(distance_form(jet, {0.0, 0.0, d}));
    EXPECT_LT((form - Eigen::Vector3d(along, along, 1.0).asDiagonal().toDenseMatrix()).norm(), 1e-12);
  }
  EXPECT_LT((matrix_of_form(distance_form(jet, {1.0, 0.0, 0.1})) - Eigen::Matrix3d::Identity()).norm(), 1e-15)
      << "an offset along the surface, as beside a boundary";
}

/// Four control points, all of which share one face, with rows, forms and normals at random: the dense system.
TEST(NormalEquations, SolveWhatTheyState) {
  constexpr Index kPoints = 4;
  constexpr Index kPlaces = 7;
  std::srand(3);
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(kPoints, kPoints);
  const Eigen::MatrixXd energy = root * root.transpose();
  const Eigen::MatrixXd rows = Eigen::MatrixXd::Random(kPlaces, kPoints);
  const Points offsets = Points::Random(kPlaces, 3);
  const Values control = Values::Random(kPoints, 3);
  Values normals = Values::Random(kPoints, 3);
  normals.rowwise().normalize();
  Fairness fairness{0.3, 0.7, Scalars::LinSpaced(kPoints, 1.0, 4.0), 0.0};
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(12, 12);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(12);
  std::vector<Form> forms(kPlaces);
  for (Index i = 0; i < kPlaces; ++i) {
    const Eigen::Matrix3d half = Eigen::Matrix3d::Random();
    const Eigen::Matrix3d whole = half * half.transpose();
    forms[i] = {whole(0, 0), whole(0, 1), whole(0, 2), whole(1, 1), whole(1, 2), whole(2, 2)};
    Eigen::MatrixXd place(3, 12);
    for (Index v = 0; v < kPoints; ++v) place.middleCols(3 * v, 3) = rows(i, v) * Eigen::Matrix3d::Identity();
    matrix += place.transpose() * whole * place;
    right += place.transpose() * whole * offsets.row(i).transpose();
  }
  for (Index v = 0; v < kPoints; ++v) {
    const auto plane = [&](Index of) -> Eigen::Matrix3d {
      return std::sqrt(fairness.stiffness[of]) *
             (Eigen::Matrix3d::Identity() - normals.row(of).transpose() * normals.row(of));
    };
    for (Index w = 0; w < kPoints; ++w) {
      matrix.block(3 * v, 3 * w, 3, 3) +=
          energy(v, w) * (0.3 * Eigen::Matrix3d::Identity() + 0.7 * plane(v) * plane(w));
      right.segment(3 * v, 3) -=
          energy(v, w) * (0.3 * Eigen::Matrix3d::Identity() + 0.7 * std::sqrt(fairness.stiffness[v]) * plane(v)) *
          control.row(w).transpose();
    }
  }
  NormalEquations equations(NormalEquations::Matrix(energy.sparseView(0.0, 0.0)));
  equations.assemble(NormalEquations::Matrix(rows.sparseView(0.0, 0.0)), forms, offsets);
  SolveReport report;
  const Values x = equations.solve(control, normals, fairness, {1e-13, 1000, {}}, report);
  const Eigen::VectorXd expected = test::solve_dense(matrix, right);
  for (Index v = 0; v < kPoints; ++v)
    EXPECT_LT((x.row(v).transpose() - expected.segment(3 * v, 3)).norm(), 1e-9 * expected.norm());
  // With one move given, the rows of the others hold.
  const GivenMoves given{{0, 1, 0, 0}, Values::Constant(kPoints, 3, 0.25)};
  const Values beside = equations.solve(control, normals, fairness, {1e-13, 1000, {}}, report, given);
  EXPECT_EQ(beside.row(1), given.moves.row(1));
  const Eigen::VectorXd flat = Eigen::Map<const Eigen::VectorXd>(beside.data(), 12);
  const Eigen::VectorXd rest = matrix * flat - right;
  EXPECT_LT(rest.head(3).norm() + rest.tail(6).norm(), 1e-9 * right.norm());
  EXPECT_GT(rest.segment(3, 3).norm(), 1e-3 * right.norm()) << "what holds the given one";
}

TEST(EnclosingSphere, OfSmallShapesIsKnown) {
  EXPECT_NEAR(enclosing_sphere(cube().points).radius, std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(enclosing_sphere(icosahedron().points).radius, std::sqrt(std::numbers::phi + 2.0), 1e-12);
  EXPECT_EQ(enclosing_sphere(Points::Ones(5, 3)).radius, 0.0);
  EXPECT_EQ(enclosing_sphere(Points(0, 3)).radius, 0.0);
  Points flat = Points::Zero(3, 3);  // obtuse: the longest side is the diameter
  flat.row(1) = Eigen::RowVector3d(10.0, 0.0, 0.0);
  flat.row(2) = Eigen::RowVector3d(4.0, 1.0, 0.0);
  EXPECT_NEAR(enclosing_sphere(flat).radius, 5.0, 1e-12);
}

/// Every sphere that holds the points is as large: no direction leads the middle away from all points on it.
TEST(EnclosingSphere, IsTheSmallest) {
  const Points points = CloudMaker(4).torus(400) * Eigen::Vector3d(1.0, 0.7, 2.0).asDiagonal();
  const Sphere sphere = enclosing_sphere(points);
  const Scalars distances = (points.rowwise() - sphere.centre.transpose()).rowwise().norm();
  EXPECT_LE(distances.maxCoeff(), sphere.radius * (1.0 + 1e-11));
  CloudMaker maker;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::RowVector3d direction = maker.direction();
    double most = -1.0;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (distances[i] > sphere.radius * (1.0 - 1e-9))
        most = std::max(most, -direction.dot(points.row(i) - sphere.centre.transpose()));
    }
    EXPECT_GE(most, -1e-6);
  }
}

TEST(OutlierFilter, FindsLonelyPointsAndThoseFarAmongNearOnes) {
  Points points = CloudMaker().sphere(1000);
  points.row(0) *= 2.0;
  const OutlierFilter filter(points);
  Buffer<std::uint8_t> flags = filter.lonely();
  EXPECT_EQ(flags[0], 1);
  EXPECT_LE(std::count(flags.begin(), flags.end(), 1), 5) << "even where points lie at random";
  Scalars distances = Scalars::Constant(1000, 1e-4);
  distances[7] = 0.5;
  std::fill(flags.begin(), flags.end(), std::uint8_t{0});
  filter.add_far(distances, flags);
  EXPECT_EQ(std::count(flags.begin(), flags.end(), 1), 1);
  EXPECT_EQ(flags[7], 1);
}

TEST(OutlierFilter, KeepsAPartThatIsFarAsAWhole) {
  const Points points = CloudMaker().sphere(1000);
  const OutlierFilter filter(points);
  Scalars distances = Scalars::Constant(1000, 1e-4);
  for (Index i = 0; i < 1000; ++i) distances[i] += 0.3 * std::max(0.0, points(i, 2) - 0.3);
  Buffer<std::uint8_t> flags(1000, 0);
  filter.add_far(distances, flags);
  EXPECT_EQ(std::count(flags.begin(), flags.end(), 1), 0);
}

/// A flat square, on a grid, of which the surface has been 1e-3 away with noise of 1e-4, a rim has not been reached,
/// and one point in it is off its neighbours by 0.02, a fifth of their distance. Others lie far away, or none do.
TEST(Belonging, TellsAPointOffItsNeighboursFromARimThatIsFarAsAWhole) {
  constexpr Index kSide = 20;
  CloudMaker maker(2);
  Points points(kSide * kSide + 8, 3);
  Points offsets = Points::Zero(points.rows(), 3);
  for (Index i = 0; i < kSide * kSide; ++i) {
    points.row(i) << 0.1 * (i % kSide), 0.1 * (i / kSide), 0.0;
    const double rim = std::max(0.0, points(i, 0) - 1.45);
    offsets.row(i) << 0.0, 0.0, 1e-3 + maker.uniform(-1e-4, 1e-4) + rim;
  }
  constexpr Index kOff = 5 * kSide + 7;
  offsets(kOff, 2) += 0.02;
  for (Index i = kSide * kSide; i < points.rows(); ++i) {
    points.row(i) << maker.uniform(0.0, 2.0), maker.uniform(0.0, 2.0), maker.uniform(0.5, 2.0);
    offsets(i, 2) = points(i, 2);
  }
  const NeighbourTable neighbours = find_neighbours(PointTree(points), 12);
  Buffer<std::uint8_t> far(static_cast<std::size_t>(points.rows()), 0);
  EXPECT_EQ(belonging({points, neighbours, far, 0.1}, offsets).minCoeff(), 1.0) << "there are no outliers";
  std::fill(far.begin() + kSide * kSide, far.end(), std::uint8_t{1});
  const Scalars belong = belonging({points, neighbours, far, 0.1}, offsets);
  for (Index i = 0; i < kSide * kSide; ++i) {
    if (i == kOff) continue;
    EXPECT_GT(belong[i], 0.9) << i;
  }
  EXPECT_LT(belong[kOff], 1e-3);
  EXPECT_EQ(belong.tail(8).maxCoeff(), 0.0);
  points.col(2) *= 1e-12;
  const Scalars flat = belonging({points, neighbours, far, 0.1}, offsets);
  EXPECT_LT((flat.head(kOff) - belong.head(kOff)).cwiseAbs().maxCoeff(), 0.1) << "a flat box has no endless density";
}

TEST(SurfaceFitter, StepsNeedNormals) {
  const Mesh start = torus(6, 4);
  PointCloud cloud{CloudMaker().torus(100), Points(0, 3)};
  test::expect_error([&] { SurfaceFitter(Topology(start), Scheme(), start.points, cloud); }, ErrorCode::BadShape,
                     "a normal for each point");
  cloud.normals = estimate_normals(cloud.points);
  SurfaceFitter fitter(Topology(start), Scheme(), start.points, cloud);
  test::expect_error([&] { fitter.stepped(start.points, Values::Zero(3, 3)); }, ErrorCode::BadShape, "");
  EXPECT_EQ(fitter.stepped(start.points, Values::Zero(24, 3)), start.points);
}

TEST(ThinnedRows, KeepSomeOfThePointsWhateverTheirOrder) {
  const Points points = CloudMaker().sphere(20000);
  const Points shuffled = CloudMaker(3).shuffled(points);
  std::set<double> chosen;
  std::set<double> others;
  for (const Index row : thinned_rows(points, 2000)) chosen.insert(points(row, 0));
  for (const Index row : thinned_rows(shuffled, 2000)) others.insert(shuffled(row, 0));
  EXPECT_EQ(chosen, others);
  EXPECT_LE(chosen.size(), 2000U);
  EXPECT_GE(chosen.size(), 1500U);
  EXPECT_EQ(thinned_rows(points, 20000).size(), 20000U);
}

TEST(StartSphere, FillsTheBoxAlongThePrincipalAxes) {
  const Points points = CloudMaker().sphere(4000) * Eigen::Vector3d(3.0, 2.0, 1.0).asDiagonal();
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const Mesh start = start_sphere(points, kind);
    EXPECT_EQ(start.vertex_count(), kind == SchemeKind::Loop ? 66 : 98);
    EXPECT_NO_THROW(Topology{start});
    const Points unit = start.points * Eigen::Vector3d(1.0 / 3.0, 0.5, 1.0).asDiagonal();
    EXPECT_LT((unit.rowwise().norm().array() - 1.0).abs().maxCoeff(), 0.1) << "random points leave gaps at the ends";
  }
}

}  // namespace
}  // namespace batten
