#include "batten/dynamics/elastic_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "batten/dynamics/pressure.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/threads.h"
#include "batten/refine/refinement.h"
#include "batten/solve/cholesky_factor.h"
#include "support/errors.h"
#include "support/loads.h"
#include "support/schemes.h"
#include "support/shapes.h"
#include "support/values.h"

namespace batten {
namespace {

constexpr TimeScheme kSchemes[] = {TimeScheme::BackwardEuler, TimeScheme::SecondOrder, TimeScheme::MassFree,
                                   TimeScheme::Paper, TimeScheme::PaperMassFree};

ElasticSurface torus_body(RestModel rest, double damping = 0.0) {
  const Mesh mesh = torus(8, 5);
  ElasticOptions options;
  options.rest = rest;
  options.material.damping = {damping};
  return ElasticSurface(Topology(mesh), test::kCatmullClark, mesh.points, options);
}

std::shared_ptr<const Force> four_springs(const ElasticSurface& surface, bool lasting = true) {
  const std::vector<SurfacePlace> places{{0, 0.5, 0.5}, {11, 0.1, 0.9}, {22, 1.0, 0.3}, {33, 0.0, 0.0}};
  Points targets(4, 3);
  targets << 2.0, 0.0, 0.1, 0.0, 2.0, 0.3, -2.0, 0.2, 0.0, 0.1, -1.5, 1.0;
  return std::make_shared<test::SpringLoad>(surface, places, targets, 50.0, lasting);
}

ElasticState thrown(const ElasticSurface& surface) {
  ElasticState state = state_at_rest(surface);
  for (Eigen::Index i = 0; i < state.positions.rows(); ++i) {
    const Eigen::Vector3d point = state.positions.row(i);
    state.velocities.row(i) = Eigen::Vector3d(1.0, 0.5, 0.0) + Eigen::Vector3d(0.3, -0.2, 2.0).cross(point) +
                              point.cwiseProduct(Eigen::Vector3d(1.0, -1.0, 0.0));
  }
  return state;
}

Eigen::RowVector3d momentum(const ElasticSurface& surface, const ElasticState& state) {
  return (surface.mass() * state.velocities).colwise().sum();
}

Eigen::RowVector3d angular_momentum(const ElasticSurface& surface, const ElasticState& state) {
  const Points flow = surface.mass() * state.velocities;
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Eigen::Index i = 0; i < flow.rows(); ++i) {
    sum += Eigen::RowVector3d(state.positions.row(i)).cross(Eigen::RowVector3d(flow.row(i)));
  }
  return sum;
}

MotionOptions steps_of(TimeScheme scheme, double step) {
  MotionOptions options;
  options.scheme = scheme;
  options.step = step;
  options.rounds = 100;
  options.tolerance = 1e-13;
  return options;
}

Points after(const ElasticSurface& surface, const MotionOptions& options, int steps, ElasticState state) {
  ElasticMotion motion(surface, {four_springs(surface)}, {}, options);
  for (int i = 0; i < steps; ++i) motion.step(state);
  return state.positions;
}

TEST(ElasticMotion, AFreeBodyKeepsItsMomentum) {
  for (const RestModel rest : {RestModel::Rotating, RestModel::Linear, RestModel::Point}) {
    const ElasticSurface surface = torus_body(rest);
    for (const TimeScheme scheme : {TimeScheme::BackwardEuler, TimeScheme::SecondOrder, TimeScheme::Paper}) {
      ElasticState state = thrown(surface);
      const Eigen::RowVector3d before = momentum(surface, state);
      ElasticMotion motion(surface, {}, {}, steps_of(scheme, 0.02));
      for (int i = 0; i < 10; ++i) motion.step(state);
      EXPECT_LE((momentum(surface, state) - before).norm(), 1e-11 * before.norm());
      EXPECT_NEAR(state.time, 0.2, 1e-15);
    }
  }
}

/// Halving the step halves what backward Euler loses, and quarters it under the second-order scheme.
TEST(ElasticMotion, AFreeBodyKeepsItsAngularMomentumToTheOrderOfTheScheme) {
  for (const RestModel rest : {RestModel::Rotating, RestModel::Point}) {
    const ElasticSurface surface = torus_body(rest);
    for (const TimeScheme scheme : {TimeScheme::BackwardEuler, TimeScheme::SecondOrder}) {
      const double order = scheme == TimeScheme::BackwardEuler ? 1.0 : 2.0;
      const auto loss = [&](double step) {
        ElasticState state = thrown(surface);
        const Eigen::RowVector3d before = angular_momentum(surface, state);
        ElasticMotion motion(surface, {}, {}, steps_of(scheme, step));
        for (int i = 0; i < std::lround(0.1 / step); ++i) motion.step(state);
        return (angular_momentum(surface, state) - before).norm() / before.norm();
      };
      const double coarse = loss(0.0025);
      const double fine = loss(0.00125);
      if (fine < 1e-10) continue;  // kept exactly
      EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << static_cast<int>(rest) << " " << static_cast<int>(scheme);
    }
  }
}

TEST(ElasticMotion, SchemesHaveTheirOrder) {
  const ElasticSurface surface = torus_body(RestModel::Linear, 2.0);
  const double orders[] = {1.0, 2.0, 1.0, 1.0, 1.0};
  for (const TimeScheme scheme : kSchemes) {
    const auto at_end = [&](int steps) {
      ElasticState state = state_at_rest(surface);
      const double step = 0.2 / steps;
      ElasticMotion motion(surface, {four_springs(surface)}, {}, steps_of(scheme, step));
      for (int i = 0; i < steps; ++i) motion.step(state);
      return state.positions;
    };
    const Points p1 = at_end(800);
    const Points p2 = at_end(1600);
    const Points p3 = at_end(3200);
    const double measured = std::log2((p1 - p2).norm() / (p2 - p3).norm());
    EXPECT_NEAR(measured, orders[static_cast<int>(scheme)], 0.15) << static_cast<int>(scheme);
  }
}

TEST(ElasticMotion, EnergyNeverGrowsUnderDamping) {
  for (const RestModel rest : {RestModel::Rotating, RestModel::Linear, RestModel::Point}) {
    const ElasticSurface surface = torus_body(rest, 1.0);
    for (const TimeScheme scheme : {TimeScheme::BackwardEuler, TimeScheme::SecondOrder}) {
      for (const double step : {0.003, 0.05, 1.0}) {
        if (scheme == TimeScheme::SecondOrder && rest == RestModel::Rotating && step > 0.01) continue;
        ElasticMotion motion(surface, {four_springs(surface)}, {}, steps_of(scheme, step));
        ElasticState state = thrown(surface);
        const auto energy = [&] {
          const MotionMeasure at = motion.measure(state);
          return at.kinetic_energy + at.elastic_energy + at.force_energy;
        };
        for (int i = 0; i < 15; ++i) {
          const double before = energy();
          motion.step(state);
          EXPECT_LE(energy(), before * (1.0 + 1e-10)) << static_cast<int>(rest) << " " << step;
        }
      }
    }
  }
}

TEST(ElasticMotion, SecondOrderKeepsTheEnergyOfLinearMotion) {
  const ElasticSurface surface = torus_body(RestModel::Linear);
  ElasticMotion motion(surface, {four_springs(surface)}, {}, steps_of(TimeScheme::SecondOrder, 0.02));
  ElasticState state = thrown(surface);
  const auto energy = [&] {
    const MotionMeasure at = motion.measure(state);
    return at.kinetic_energy + at.elastic_energy + at.force_energy;
  };
  const double before = energy();
  for (int i = 0; i < 50; ++i) motion.step(state);
  EXPECT_NEAR(energy(), before, 1e-10 * before);
}

TEST(ElasticMotion, SpringsThatChangeGiveWhatLastingOnesDo) {
  for (const MotionSolver solver : {MotionSolver::Direct, MotionSolver::Iterative}) {
    const ElasticSurface surface = torus_body(RestModel::Rotating, 1.0);
    MotionOptions options = steps_of(TimeScheme::BackwardEuler, 0.02);
    const auto run = [&](bool lasting) {
      ElasticMotion motion(surface, {four_springs(surface, lasting)}, {}, options);
      ElasticState state = thrown(surface);
      for (int i = 0; i < 5; ++i) motion.step(state);
      return state.positions;
    };
    const Points lasting = run(true);
    options.solver = solver;
    options.solver_tolerance = 1e-13;
    EXPECT_LE((run(false) - lasting).norm(), 1e-9 * surface.diagonal()) << static_cast<int>(solver);
  }
}

TEST(ElasticMotion, RestIsReachedWhereTheForcesBalance) {
  for (const RestModel rest : {RestModel::Rotating, RestModel::Linear, RestModel::Point}) {
    const ElasticSurface surface = torus_body(rest, 40.0);
    ElasticMotion motion(surface, {four_springs(surface)}, {}, steps_of(TimeScheme::MassFree, 20.0));
    ElasticState moving = state_at_rest(surface);
    for (int i = 0; i < 60; ++i) motion.step(moving);
    ElasticState still = state_at_rest(surface);
    const EquilibriumReport report = motion.find_equilibrium(still, {1e-13});
    EXPECT_TRUE(report.converged) << report.change;
    EXPECT_LE(report.residual_force, 1e-9) << static_cast<int>(rest);
    EXPECT_LE((still.positions - moving.positions).rowwise().norm().maxCoeff(), 1e-10 * surface.diagonal());
    EXPECT_TRUE(still.velocities.isZero(0.0));
  }
}

TEST(ElasticMotion, SupportsAreHeldExactly) {
  for (const MotionSolver solver : {MotionSolver::Direct, MotionSolver::Iterative}) {
    const ElasticSurface surface = torus_body(RestModel::Rotating, 1.0);
    Supports supports;
    const auto along = [](double time) -> Eigen::Vector3d { return {1.5 + time, 0.0, 0.1 * time}; };
    supports.pins.push_back({{0, 0.25, 0.5}, along});
    supports.pins.push_back({{0, 0.25, 0.5}, along});  // twice the same does no harm
    supports.pins.push_back({{20, 0.5, 0.5}, stay_at({-1.0, 0.0, 0.0})});
    supports.pins.push_back({{20, 0.5, 0.5}, stay_at({0.0, 0.5, 0.0}), JetPart::Du});
    supports.points.push_back({13, straight_path({0.0, 1.0}, {{0.0, 1.0, 0.0}, {0.0, 2.0, 0.0}})});
    MotionOptions options = steps_of(TimeScheme::BackwardEuler, 0.05);
    options.solver = solver;
    options.solver_tolerance = 1e-14;
    ElasticMotion motion(surface, {four_springs(surface)}, supports, options);
    ElasticState state = thrown(surface);
    for (int i = 0; i < 8; ++i) EXPECT_LE(motion.step(state).support_error, 1e-11 * surface.diagonal());
    const Points at = place_rows(surface.patches(), std::vector<SurfacePlace>{{0, 0.25, 0.5}}).rows * state.positions;
    EXPECT_LE((at.row(0) - Eigen::RowVector3d(1.9, 0.0, 0.04)).norm(), 1e-11);
    EXPECT_LE((state.positions.row(13) - Eigen::RowVector3d(0.0, 1.4, 0.0)).norm(), 1e-15);
    const EquilibriumReport report = motion.find_equilibrium(state);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.residual_force, 1e-6);
  }
}

TEST(ElasticMotion, RefiningInMidRunChangesNothingThatIsSeen) {
  const ElasticSurface surface = torus_body(RestModel::Rotating, 1.0);
  Supports supports;
  supports.pins.push_back({{20, 0.3, 0.6}, stay_at({-1.0, 0.0, 0.0})});
  supports.pins.push_back({{20, 0.3, 0.6}, stay_at({0.1, 0.5, 0.0}), JetPart::Du});
  supports.pins.push_back({{7, 0.9, 0.2}, stay_at({0.0, 0.4, 0.2}), JetPart::Dv});
  supports.points.push_back({13, stay_at({0.0, 1.0, 0.0})});
  ElasticMotion motion(surface, {four_springs(surface)}, supports, steps_of(TimeScheme::BackwardEuler, 0.02));
  ElasticState state = thrown(surface);
  for (int i = 0; i < 5; ++i) motion.step(state);
  ElasticMotion finer = motion.refined(state);
  ElasticState fine = refined_state(surface, state);
  const LimitSurface coarse_surface(surface.patches(), state.positions);
  const LimitSurface fine_surface(finer.surface().patches(), fine.positions);
  for (const SurfacePlace& place : {SurfacePlace{3, 0.2, 0.9}, {17, 0.5, 0.5}, {39, 0.77, 0.01}}) {
    const SurfacePlace there = place_on_refined(surface.patches(), place);
    EXPECT_LE((coarse_surface.jet(place).point - fine_surface.jet(there).point).norm(), 1e-13);
  }
  const MotionMeasure before = motion.measure(state);
  const MotionMeasure now = finer.measure(fine);
  EXPECT_NEAR(now.force_energy, before.force_energy, 1e-12 * before.force_energy);
  EXPECT_NEAR(now.kinetic_energy, before.kinetic_energy, 1e-2 * before.kinetic_energy);
  // The pins hold where the surface already is, and it goes on from there.
  const StepReport report = finer.step(fine);
  EXPECT_LE(report.support_error, 1e-11);
  motion.step(state);
  const LimitSurface coarse_next(surface.patches(), state.positions);
  const LimitSurface fine_next(finer.surface().patches(), fine.positions);
  const SurfacePlace place{30, 0.5, 0.5};
  const Eigen::Vector3d there = fine_next.jet(place_on_refined(surface.patches(), place)).point;
  EXPECT_LE((coarse_next.jet(place).point - there).norm(), 0.01 * surface.diagonal());
}

TEST(ElasticMotion, CannotRefineDerivativesPinnedInTriangles) {
  const Mesh mesh = icosahedron();
  const ElasticSurface surface(Topology(mesh), test::scheme_of(SchemeKind::Loop), mesh.points);
  const ElasticState state = state_at_rest(surface);
  Supports supports;
  supports.pins.push_back({{3, 0.2, 0.3}, stay_at({0.1, 0.0, 0.0})});
  EXPECT_EQ(refined_supports(surface, supports, state).pins.size(), 1u);
  supports.pins.push_back({{3, 0.2, 0.3}, stay_at({0.1, 0.5, 0.0}), JetPart::Du});
  test::expect_error([&] { refined_supports(surface, supports, state); }, ErrorCode::BadArgument,
                     "pinned in a triangle");
}

/// A cube refined twice has the symmetries of the cube; pressure must not break one of them.
TEST(ElasticMotion, KeepsTheSymmetryOfABalloon) {
  const Mesh mesh = cube();
  const RefinedSurface ball = refine(Topology(mesh), test::kCatmullClark, mesh.points, 2);
  const ElasticSurface surface(ball.topology, test::kCatmullClark, ball.values);
  ElasticMotion motion(surface, {std::make_shared<Pressure>(surface, PressureOptions{.pressure = always(40.0)})});
  ElasticState state = state_at_rest(surface);
  for (int i = 0; i < 10; ++i) motion.step(state);
  EXPECT_GT(state.positions.norm(), 1.05 * surface.rest().norm());
  for (const auto& image :
       {Eigen::Matrix3d(Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal()),
        Eigen::Matrix3d(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ())),
        Eigen::Matrix3d(Eigen::AngleAxisd(2.0 * std::numbers::pi / 3.0, Eigen::Vector3d(1, 1, 1) / std::sqrt(3.0)))}) {
    const Points rest = surface.rest() * image.transpose();
    const Points moved = state.positions * image.transpose();
    for (Eigen::Index v = 0; v < rest.rows(); ++v) {
      Eigen::Index partner = 0;
      (surface.rest().rowwise() - rest.row(v)).rowwise().norm().minCoeff(&partner);
      EXPECT_LE((state.positions.row(partner) - moved.row(v)).norm(), 1e-10);
    }
  }
}

TEST(ElasticMotion, AdvanceKeepsItsError) {
  const ElasticSurface surface = torus_body(RestModel::Linear, 0.5);
  MotionOptions options = steps_of(TimeScheme::SecondOrder, 0.05);
  ElasticMotion motion(surface, {four_springs(surface)}, {}, options);
  ElasticState state = thrown(surface);
  const StepReport report = motion.advance(state, 0.13, 1e-5);
  EXPECT_LE(report.time_error, 1e-5 * surface.diagonal());
  EXPECT_EQ(state.time, 0.13);
  const Points exact = after(surface, steps_of(TimeScheme::SecondOrder, 0.13 / 4096), 4096, thrown(surface));
  EXPECT_LE((state.positions - exact).rowwise().norm().maxCoeff(), 1e-3 * surface.diagonal());
}

TEST(ElasticMotion, HasTheSameBitsOnAnyNumberOfThreadsAndWhenTakenUpAgain) {
  const Mesh mesh = torus(24, 16);
  const ElasticSurface surface(Topology(mesh), test::kCatmullClark, mesh.points);
  const auto run = [&](int threads, bool again) {
    const ThreadLimit limit(threads);
    auto motion = std::make_unique<ElasticMotion>(
        surface, std::vector<std::shared_ptr<const Force>>{four_springs(surface, false)}, Supports{});
    ElasticState state = thrown(surface);
    for (int i = 0; i < 6; ++i) {
      if (again && i == 3) {
        *motion = ElasticMotion(surface, {four_springs(surface, false)});
      }
      motion->step(state);
    }
    return state.positions;
  };
  const Points once = run(1, false);
  EXPECT_EQ(run(3, false), once);
  EXPECT_EQ(run(2, true), once);
}

/// So large that the factor is in single precision. The oracle is one solve in double.
TEST(ElasticMotion, LargeBodiesSolveAsExactlyAsSmallOnes) {
  const Mesh mesh = torus(500, 301);
  ElasticOptions options;
  options.rest = RestModel::Linear;
  const ElasticSurface surface(Topology(mesh), test::kCatmullClark, mesh.points, options);
  const double h = 1.0 / 60.0;
  const auto stepped = [&](int threads) {
    const ThreadLimit limit(threads);
    ElasticMotion motion(surface);
    ElasticState state = thrown(surface);
    const StepReport report = motion.step(state);
    EXPECT_GT(report.solver_iterations, 0) << "the factor is in double precision";
    EXPECT_LE(report.solver_iterations, 20);
    return state;
  };
  const ElasticState start = thrown(surface);
  const ElasticState end = stepped(1);
  const ElasticSurface::Matrix system =
      surface.mass() / (h * h) + surface.damping() / h + surface.stiffness();  // from rest
  Values change;
  CholeskyFactor(system).solve(surface.mass() * start.velocities / h, change);
  EXPECT_GT(change.norm(), 0.1);
  EXPECT_LE((end.positions - start.positions - change).cwiseAbs().maxCoeff(), 1e-11 * surface.diagonal());
  const ElasticState by_two = stepped(2);
  EXPECT_EQ(end.positions, by_two.positions);
  EXPECT_EQ(end.velocities, by_two.velocities);
}

TEST(ElasticMotion, SaysWhatIsWrong) {
  const Mesh mesh = torus(8, 5);
  ElasticOptions weightless;
  weightless.material.density = {0.0};
  weightless.material.damping = {0.0};
  const ElasticSurface surface(Topology(mesh), test::kCatmullClark, mesh.points, weightless);
  ElasticState state = state_at_rest(surface);
  test::expect_error([&] { ElasticMotion(surface).step(state); }, ErrorCode::SingularSystem, "no mass or damping");
  test::expect_error([&] { ElasticMotion(surface).find_equilibrium(state); }, ErrorCode::SingularSystem, "pin it");
  const ElasticSurface body = torus_body(RestModel::Rotating);
  const auto load = [&](double size) {
    return std::make_shared<test::FixedLoad>(Points::Constant(body.rest().rows(), 3, size));
  };
  ElasticMotion unsound(body, {load(std::nan(""))});
  test::expect_error([&] { unsound.step(state); }, ErrorCode::NotFinite, "the force \"fixed load\" is not finite");
  ElasticMotion strong(body, {load(1e300)});
  test::expect_error([&] { strong.step(state); }, ErrorCode::NotFinite, "has run away in the step that ends at");
  EXPECT_EQ(state.positions, Points(mesh.points)) << "a step that fails changes nothing";
  Supports supports;
  supports.points.push_back({99, stay_at({0.0, 0.0, 0.0})});
  test::expect_error([&] { ElasticMotion(body, {}, supports); }, ErrorCode::IndexOutOfRange, "vertex 99");
  supports.points = {{3, stay_at({0.0, 0.0, 0.0})}, {3, stay_at({0.0, 0.0, 0.0})}};
  test::expect_error([&] { ElasticMotion(body, {}, supports); }, ErrorCode::BadArgument, "vertex 3 is fixed twice");
  supports.points = {{3, [](double) { return Eigen::Vector3d(0.0, std::nan(""), 0.0); }}};
  ElasticMotion lost(body, {}, supports);
  test::expect_error([&] { lost.step(state); }, ErrorCode::NotFinite, "the path of vertex 3");
  MotionOptions options;
  options.step = -1.0;
  test::expect_error([&] { ElasticMotion(body, {}, {}, options); }, ErrorCode::BadArgument, "positive number");
  state.velocities.resize(3, 3);
  test::expect_error([&] { ElasticMotion(body).step(state); }, ErrorCode::BadShape, "the state has 3");
}

}  // namespace
}  // namespace batten
