#include "batten/refine/spread_numbers.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"

namespace batten {
namespace {

/// A linear function of a flat grid: on edges and in faces of its refinement it is what neighbours' means are.
TEST(SpreadNumbers, AreLinearOverAGridThatWasRefined) {
  const Mesh mesh = grid(4, 3);
  const Topology given(mesh);
  const auto height = [](ConstValuesRef points) -> Scalars { return 2.0 * points.col(0) - points.col(1); };
  Values points = refine_midpoints(given, SchemeKind::CatmullClark, mesh.points);
  const Topology once = Refinement(given, test::kCatmullClark).child();
  EXPECT_LT((spread_numbers(height(mesh.points), once, SchemeKind::CatmullClark, once.vertex_count()) - height(points))
                .cwiseAbs()
                .maxCoeff(),
            1e-14);
  points = refine_midpoints(once, SchemeKind::CatmullClark, points);
  const auto count = static_cast<Index>(points.rows());
  EXPECT_LT((spread_numbers(height(mesh.points), once, SchemeKind::CatmullClark, count) - height(points))
                .cwiseAbs()
                .maxCoeff(),
            1e-14);
}

TEST(SpreadNumbers, GivesAVertexWithoutOneTheMeanOfItsNeighbours) {
  const Topology topology(grid(2, 2));
  Scalars numbers = Scalars::LinSpaced(9, 0.0, 8.0);
  numbers[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(spread_numbers(numbers, topology, SchemeKind::CatmullClark, 9)[4], 4.0);
  EXPECT_TRUE(
      spread_numbers(Scalars::Constant(1, numbers[4]), topology, SchemeKind::CatmullClark, 9).array().isNaN().all());
}

}  // namespace
}  // namespace batten
