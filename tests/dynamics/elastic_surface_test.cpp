#include "batten/dynamics/elastic_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "batten/energy/shape_energy.h"
#include "batten/energy/surface_energy.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/threads.h"
#include "batten/refine/refinement.h"
#include "batten/surface/quadrature.h"
#include "support/errors.h"
#include "support/schemes.h"
#include "support/shapes.h"
#include "support/values.h"

namespace batten {
namespace {

constexpr RestModel kRestModels[] = {RestModel::Rotating, RestModel::Linear, RestModel::Point};
constexpr ElasticMeasure kMeasures[] = {ElasticMeasure::Lengths, ElasticMeasure::Parameters};

ElasticOptions options_of(RestModel rest, ElasticMeasure measure) {
  ElasticOptions options;
  options.rest = rest;
  options.measure = measure;
  options.material.rigidity = {3.0};
  return options;
}

/// Calls visit(surface, name) for bodies of all models, measures and kinds of faces.
template <typename Visit>
void for_each_body(const Visit& visit) {
  const std::pair<const char*, Mesh> meshes[] = {{"torus", torus(6, 4)},
                                                 {"dodecahedron", dodecahedron()},
                                                 {"grid", grid(3, 3)},
                                                 {"icosahedron", icosahedron()},
                                                 {"cube", cube()}};
  for (const auto& [name, mesh] : meshes) {
    for (const RestModel rest : kRestModels) {
      for (const ElasticMeasure measure : kMeasures) {
        visit(ElasticSurface(Topology(mesh), choose_scheme(mesh), mesh.points, options_of(rest, measure)),
              std::string(name) + ", model " + std::to_string(static_cast<int>(rest)) + ", measure " +
                  std::to_string(static_cast<int>(measure)));
      }
    }
  }
}

Points moved(const Points& points, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -2) / 3.0).toRotationMatrix();
  return (points * turn.transpose()).rowwise() + Eigen::RowVector3d(3.0, -1.0, 2.0);
}

Points bent(const Points& points) {
  return points + 0.2 * Points(test::random_values(static_cast<Index>(points.rows()), 3));
}

TEST(ElasticSurface, ForceIsMinusTheGradientOfItsEnergy) {
  for_each_body([](const ElasticSurface& surface, const std::string& name) {
    const Points at = bent(moved(surface.rest(), 1.0));
    const Points direction = test::random_values(static_cast<Index>(at.rows()), 3);
    // A central difference of fourth order: the rounding of the energies is all that is left.
    const double h = 1e-3;
    const auto energy = [&](double s) { return surface.energy(at + s * h * direction); };
    const double slope = (8.0 * (energy(1.0) - energy(-1.0)) - (energy(2.0) - energy(-2.0))) / (12.0 * h);
    const double scale = surface.force(at).norm() * direction.norm();
    EXPECT_NEAR(surface.force(at).cwiseProduct(direction).sum(), -slope, 1e-8 * scale) << name;
  });
}

TEST(ElasticSurface, RotatingBodiesMoveAndTurnFreely) {
  for_each_body([](const ElasticSurface& surface, const std::string& name) {
    if (surface.options().rest != RestModel::Rotating) return;
    const double most = surface.energy(2.0 * surface.rest());
    for (const double angle : {0.0, 0.7, 3.0}) {
      const Points at = moved(surface.rest(), angle);
      EXPECT_NEAR(surface.energy(at), 0.0, 1e-13 * most) << name;
      EXPECT_LE(surface.force(at).norm(), 1e-13 * surface.force(2.0 * surface.rest()).norm()) << name;
    }
    const Points at = bent(surface.rest());
    EXPECT_NEAR(surface.energy(moved(at, 2.0)), surface.energy(at), 1e-12 * most) << name;
  });
}

TEST(ElasticSurface, TurningFreelyNeverCostsMoreThanStandingStill) {
  const Mesh mesh = torus(6, 4);
  for (const ElasticMeasure measure : kMeasures) {
    const ElasticSurface rotating(Topology(mesh), test::kCatmullClark, mesh.points,
                                  options_of(RestModel::Rotating, measure));
    const ElasticSurface linear(Topology(mesh), test::kCatmullClark, mesh.points,
                                options_of(RestModel::Linear, measure));
    for (const double angle : {0.0, 0.1, 1.0}) {
      const Points at = bent(moved(mesh.points, angle));
      EXPECT_LE(rotating.energy(at), linear.energy(at));
      EXPECT_GE(rotating.energy(at), 0.0);
    }
  }
}

TEST(ElasticSurface, LinearAndPointHaveTheEnergiesOfTheirMatrices) {
  const Mesh mesh = torus(6, 4);
  EnergyOptions energy_options;
  energy_options.tension = {100.0};
  energy_options.rigidity = {3.0};
  const SurfaceEnergy energy(Topology(mesh), test::kCatmullClark, energy_options);
  const Points at = bent(mesh.points);
  const ElasticSurface point(Topology(mesh), test::kCatmullClark, mesh.points,
                             options_of(RestModel::Point, ElasticMeasure::Parameters));
  const ElasticSurface linear(Topology(mesh), test::kCatmullClark, mesh.points,
                              options_of(RestModel::Linear, ElasticMeasure::Parameters));
  const double whole = energy.energy(EnergyKind::Stiffness, at);
  EXPECT_NEAR(point.energy(at), whole, 1e-13 * whole);
  EXPECT_NEAR(linear.energy(at), energy.energy(EnergyKind::Stiffness, at - mesh.points), 1e-13 * whole);
}

/// 1/2 (tension * 2 area + rigidity * integral of k1^2 + k2^2) is that of the shape in its own lengths.
TEST(ElasticSurface, LengthsGiveAreaTimesTension) {
  const Mesh mesh = torus(8, 6);
  ElasticOptions options = options_of(RestModel::Point, ElasticMeasure::Lengths);
  options.material.rigidity = {0.0};
  const ElasticSurface surface(Topology(mesh), test::kCatmullClark, mesh.points, options);
  const LimitSurface limit(surface.patches(), mesh.points);
  const double area = area_weights(limit, surface_quadrature(surface.patches())).sum();
  EXPECT_NEAR(surface.energy(mesh.points), options.material.tension[0] * area,
              1e-4 * options.material.tension[0] * area);
  EXPECT_NEAR(surface.mass().sum(), area, 1e-4 * area);
}

TEST(ElasticSurface, EachFaceHasItsOwnCoefficients) {
  const Mesh mesh = grid(4, 2);
  ElasticOptions options = options_of(RestModel::Linear, ElasticMeasure::Lengths);
  options.material.density = {1.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  options.material.tension.assign(8, 5.0);
  const Scheme corners = test::scheme_of(SchemeKind::CatmullClark, BoundaryRule::EdgeAndCorner);
  const ElasticSurface surface(Topology(mesh), corners, mesh.points, options);
  options.material.density = {1.0};
  const ElasticSurface even(Topology(mesh), corners, mesh.points, options);
  EXPECT_NEAR(surface.mass().sum() / 9.0, even.mass().sum() / 8.0, 1e-14);
  options.material.tension = {5.0};
  const ElasticSurface single(Topology(mesh), corners, mesh.points, options);
  EXPECT_NEAR((single.stiffness() - even.stiffness()).norm(), 0.0, 1e-13 * single.stiffness().norm());
}

/// The thin plate beside extraordinary vertices depends on the level (MATH: its integral does not exist), and where
/// faces turn, smaller ones do so more freely.
TEST(ElasticSurface, RefiningKeepsMassAndEnergy) {
  for_each_body([](const ElasticSurface& surface, const std::string& name) {
    const bool regular = name.starts_with("torus") || name.starts_with("grid");
    const ElasticSurface child = surface.refined();
    const Points at = bent(surface.rest());
    const ElasticState state = refined_state(surface, {1.5, at, 2.0 * at});
    EXPECT_EQ(state.time, 1.5);
    const double most = surface.energy(2.0 * at);
    const double kinetic = surface.kinetic_energy(2.0 * at);
    const bool exact = surface.options().measure == ElasticMeasure::Parameters;
    EXPECT_NEAR(child.kinetic_energy(state.velocities), kinetic, (exact ? 1e-13 : 0.02) * kinetic) << name;
    if (surface.options().rest == RestModel::Rotating) {
      EXPECT_LE(child.energy(state.positions), surface.energy(at) * (1.0 + 1e-3)) << name;
    } else if (exact && (regular || surface.patches().has_first_step())) {
      EXPECT_NEAR(child.energy(state.positions), surface.energy(at), 1e-12 * most) << name;
    }
  });
}

TEST(ElasticSurface, RefiningKeepsTheCoefficientsOfFaces) {
  const Mesh mesh = torus(6, 4);
  ElasticOptions options;
  options.material.density.assign(24, 0.0);
  for (std::size_t f = 0; f < 24; ++f) options.material.density[f] = 1.0 + static_cast<double>(f);
  const ElasticSurface surface(Topology(mesh), test::kCatmullClark, mesh.points, options);
  const ElasticSurface child = surface.refined();
  const std::vector<double>& finer = child.options().material.density;
  ASSERT_EQ(finer.size(), 96u);
  for (std::size_t f = 0; f < 96; ++f) EXPECT_EQ(finer[f], options.material.density[f / 4]) << f;
}

TEST(ElasticSurface, HasTheSameBitsOnAnyNumberOfThreads) {
  const Mesh mesh = torus(20, 12);
  const Points at = bent(mesh.points);
  const auto result = [&](int threads) {
    const ThreadLimit limit(threads);
    const ElasticSurface surface(Topology(mesh), test::kCatmullClark, mesh.points);
    return std::make_pair(surface.energy(at), surface.force(at));
  };
  EXPECT_EQ(result(1), result(4));
}

TEST(ElasticSurface, RefusesWhatIsNoBody) {
  const Mesh mesh = torus(6, 4);
  const Topology topology(mesh);
  const auto build = [&](const ElasticOptions& options) {
    return ElasticSurface(topology, test::kCatmullClark, mesh.points, options);
  };
  ElasticOptions options;
  options.material.tension = {-1.0};
  test::expect_error([&] { build(options); }, ErrorCode::BadArgument, "the tension of face 0 is negative");
  options.material.tension = {1.0, 2.0};
  test::expect_error([&] { build(options); }, ErrorCode::BadShape, "2 values of the tension, but the mesh has 24");
  options.material.tension = {std::nan("")};
  test::expect_error([&] { build(options); }, ErrorCode::NotFinite, "tension of face 0");
  options = {};
  options.cutoff_levels = 4;
  test::expect_error([&] { build(options); }, ErrorCode::BadArgument, "cut-off");
  test::expect_error([&] { ElasticSurface(topology, test::kCatmullClark, mesh.points.topRows(3)); },
                     ErrorCode::BadShape, "rest points");
  const Mesh triangles = icosahedron();
  test::expect_error(
      [&] { ElasticSurface(Topology(triangles), test::scheme_of(SchemeKind::ModifiedButterfly), triangles.points); },
      ErrorCode::BadArgument, "Butterflies");
}

}  // namespace
}  // namespace batten
