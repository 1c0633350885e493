/// Flat squares against the closed forms of membranes and plates.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "batten/dynamics/elastic_motion.h"
#include "batten/mesh/primitives.h"
#include "batten/surface/quadrature.h"
#include "support/dense.h"
#include "support/loads.h"
#include "support/schemes.h"

namespace batten {
namespace {

/// A square of side 1 in n by n faces. Without edge rules it has a ring of faces more, which shape its edges only.
ElasticSurface square(Index n, BoundaryRule boundary, double tension, double rigidity) {
  Mesh mesh = grid(boundary == BoundaryRule::None ? n + 2 : n, boundary == BoundaryRule::None ? n + 2 : n);
  const Eigen::RowVectorXd low = mesh.points.colwise().minCoeff();
  const double spacing = (mesh.points.col(0).maxCoeff() - low[0]) / (boundary == BoundaryRule::None ? n + 2 : n);
  mesh.points = (mesh.points.rowwise() - low) / (spacing * n);
  ElasticOptions options;
  options.rest = RestModel::Linear;
  options.material = {{2.0}, {0.0}, {tension}, {rigidity}};
  return ElasticSurface(Topology(mesh), test::scheme_of(SchemeKind::CatmullClark, boundary), mesh.points, options);
}

/// The lowest frequency, 1/s, of motion along one axis whose control points are in the span of `basis`.
double lowest_frequency(const ElasticSurface& surface, const Eigen::MatrixXd& basis) {
  const Eigen::MatrixXd stiffness = basis.transpose() * surface.stiffness() * basis;
  const Eigen::MatrixXd mass = basis.transpose() * surface.mass() * basis;
  return std::sqrt(test::least_eigenvalue(stiffness, mass));
}

/// Pins the edges of square(n, BoundaryRule::None): no height and, where `clamped`, no slope across them.
Supports hold_edges(Index n, bool clamped) {
  Supports supports;
  const auto pin = [&](const SurfacePlace& place, JetPart across) {
    const Eigen::Vector3d at(0.0, 0.0, 0.0);
    supports.pins.push_back({place, stay_at(at)});
    if (clamped) supports.pins.push_back({place, stay_at(at), across});
  };
  const Index row = n + 2;
  for (Index i = 1; i <= n; ++i) {
    for (const double t : {0.0, 0.5, 1.0}) {
      pin({row + i, t, 0.0}, JetPart::Dv);
      pin({n * row + i, t, 1.0}, JetPart::Dv);
      pin({i * row + 1, 0.0, t}, JetPart::Du);
      pin({i * row + n, 1.0, t}, JetPart::Du);
    }
  }
  return supports;
}

/// Of the control points that these pins leave, for one coordinate.
Eigen::MatrixXd left_free(const ElasticSurface& surface, const Supports& supports) {
  const SurfaceWeights weights(surface.patches());
  Eigen::MatrixXd rows(supports.pins.size(), surface.rest().rows());
  for (std::size_t i = 0; i < supports.pins.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) =
        Eigen::MatrixXd(weights.rows({&supports.pins[i].place, 1}, supports.pins[i].part));
  }
  return test::kernel(rows, 1e-10);
}

/// The identity without the columns of boundary vertices.
Eigen::MatrixXd inner_points(const ElasticSurface& surface) {
  const Topology& topology = surface.topology();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(topology.vertex_count(), topology.vertex_count());
  Index count = 0;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (!topology.is_boundary_vertex(v)) basis(v, count++) = 1.0;
  }
  return basis.leftCols(count);
}

/// sqrt(T / density * 2) pi, to the sixth order of cubic splines for problems of second order.
TEST(ElasticPlates, MembraneHasItsFrequency) {
  const double exact = std::numbers::pi * std::sqrt(2.0 * 5.0 / 2.0);
  std::vector<double> errors;
  for (const Index n : {4, 8}) {
    const ElasticSurface surface = square(n, BoundaryRule::EdgeAndCorner, 5.0, 0.0);
    errors.push_back(lowest_frequency(surface, inner_points(surface)) / exact - 1.0);
  }
  EXPECT_LE(errors[1], 1e-6);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 6.0, 0.5);
}

/// 35.9852 sqrt(D / density) of a clamped square, to the fourth order (35.992 from above after Leissa 1973, key L73).
TEST(ElasticPlates, ClampedPlateHasItsFrequency) {
  const double exact = 35.985190 * std::sqrt(3.0 / 2.0);
  std::vector<double> errors;
  for (const Index n : {4, 8}) {
    const ElasticSurface surface = square(n, BoundaryRule::None, 0.0, 3.0);
    errors.push_back(lowest_frequency(surface, left_free(surface, hold_edges(n, true))) / exact - 1.0);
  }
  EXPECT_LE(std::abs(errors[1]), 2e-4);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4.0, 0.5);
}

/// A quadrature of the load q over the surface.
std::shared_ptr<const Force> pressed(const ElasticSurface& surface, double q) {
  const SurfaceQuadrature quadrature = surface_quadrature(surface.patches());
  const Scalars weights = area_weights(LimitSurface(surface.patches(), surface.rest()), quadrature);
  Points load = Points::Zero(weights.size(), 3);
  load.col(2) = q * weights;
  return std::make_shared<test::FixedLoad>(place_rows(surface.patches(), quadrature.places).transposed * load);
}

/// The deflection of the middle under q, times D / q (after Timoshenko and Woinowsky-Krieger 1959, key TW59).
double middle_deflection(Index n, bool clamped) {
  const double q = 1e-3;
  const ElasticSurface surface = square(n, BoundaryRule::None, 0.0, 3.0);
  Supports supports = hold_edges(n, clamped);
  for (Supports::Pin& pin : supports.pins) {
    const Jet jet = LimitSurface(surface.patches(), surface.rest()).jet(pin.place);
    pin.path = stay_at(pin.part == JetPart::Point ? jet.point : pin.part == JetPart::Du ? jet.du : jet.dv);
  }
  ElasticMotion motion(surface, {pressed(surface, q)}, supports);
  ElasticState state = state_at_rest(surface);
  const EquilibriumReport report = motion.find_equilibrium(state);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.residual_force, 1e-8 * q);
  const Index middle = (n / 2 + 1) * (n + 2) + n / 2 + 1;
  return LimitSurface(surface.patches(), state.positions).jet({middle, 0.0, 0.0}).point.z() * 3.0 / q;
}

TEST(ElasticPlates, BendUnderPressureAsTimoshenkoSays) {
  EXPECT_NEAR(middle_deflection(8, true), 0.00126532, 1e-3 * 0.00126532);
  EXPECT_NEAR(middle_deflection(8, false), 0.00406235, 1e-3 * 0.00406235);
}

}  // namespace
}  // namespace batten
