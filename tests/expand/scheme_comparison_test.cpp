#include "batten/expand/scheme_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/interpolate/method_comparison.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/unit_scale.h"
#include "support/shapes.h"

namespace batten {
namespace {

TEST(CompareSchemes, MeasuresSurfacesOfAnySize) {
  const Mesh mesh = test::jittered(icosahedron(), 0.05, 7);
  const Topology topology(mesh);
  const std::vector<ComparedSurface> unit = compare_schemes(topology, {}, mesh.points, 2);
  ASSERT_EQ(unit.size(), 5U);
  for (const int exponent : {660, -660}) {
    const double size = std::ldexp(1.0, exponent);
    const std::vector<ComparedSurface> sized = compare_schemes(topology, {}, size * mesh.points, 2);
    for (std::size_t i = 0; i < unit.size(); ++i) {
      SCOPED_TRACE(unit[i].name);
      EXPECT_EQ(unit[i].failure, "");
      EXPECT_EQ(sized[i].failure, "");
      // Scales by other powers of two than 1 round alike.
      EXPECT_NEAR(sized[i].fairness.bending, unit[i].fairness.bending, 1e-9 * unit[i].fairness.bending);
      EXPECT_NEAR(sized[i].fairness.variation, unit[i].fairness.variation, 1e-9 * unit[i].fairness.variation);
      EXPECT_NEAR(sized[i].mean[0] * size, unit[i].mean[0], 1e-9 * std::abs(unit[i].mean[0]));
      EXPECT_LE((sized[i].mesh.points / size - unit[i].mesh.points).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LE(sized[i].max_error, 1e-9 * size);
    }
  }
}

TEST(CompareSchemes, RefusesOtherFacesThanTriangles) {
  const Mesh mesh = cube();
  EXPECT_THROW(compare_schemes(Topology(mesh), {}, mesh.points, 1), Error);
}

TEST(CompareMethods, SolveForPointsOfAnySize) {
  const Mesh mesh = test::jittered(icosahedron(), 0.05, 7);
  const Topology topology(mesh);
  Scheme loop;
  loop.kind = SchemeKind::Loop;
  for (const int exponent : {0, 660}) {
    const double size = std::ldexp(1.0, exponent);
    const Values targets = size * mesh.points;
    const double diagonal = bounding_diagonal(targets);
    EXPECT_TRUE(std::isfinite(diagonal));
    for (const MethodResult& result : compare_methods(topology, loop, {}, targets)) {
      SCOPED_TRACE(result.name);
      EXPECT_EQ(result.failure, "");
      EXPECT_TRUE(result.report.converged);
      EXPECT_LE(result.max_error / diagonal, 1e-10);
    }
  }
}

TEST(UnitScale, IsOneButWhereSquaresLeaveTheDoubles) {
  const Points unit = Points::Constant(2, 3, 1.0);
  EXPECT_EQ(unit_scale(unit), 1.0);
  EXPECT_EQ(unit_scale(1e50 * unit), 1.0);
  EXPECT_EQ(unit_scale(0.0 * unit), 1.0);
  for (const double size : {1e200, 1e-200, 1e308, 5e-324}) {
    const double scale = unit_scale(size * unit);
    EXPECT_EQ(std::ilogb(scale * size) == 0 || size < 1e-300, true) << size;
    EXPECT_EQ(scale * size / scale, size);
  }
  EXPECT_EQ(unit_scale(Points::Constant(1, 3, std::numeric_limits<double>::infinity())), 1.0);
}

TEST(BoundingDiagonal, IsFiniteWhereItsSquareIsNot) {
  Points points = Points::Zero(2, 3);
  points.row(1) << 3e200, 4e200, 0.0;
  EXPECT_DOUBLE_EQ(bounding_diagonal(points), 5e200);
  points.row(1) << 3e-200, 4e-200, 0.0;
  EXPECT_DOUBLE_EQ(bounding_diagonal(points), 5e-200);
}

}  // namespace
}  // namespace batten
