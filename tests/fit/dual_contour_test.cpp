#include "batten/fit/dual_contour.h"

#include <gtest/gtest.h>

#include <random>

#include "batten/mesh/summary.h"
#include "mesh/manifold.h"

namespace batten {
namespace {

template <typename Value>
ValueGrid filled_grid(Index nodes, const Value& value) {
  const double spacing = 2.0 / (nodes - 1);
  ValueGrid grid = grid_over(Eigen::RowVector3d::Constant(-1.0), Eigen::RowVector3d::Constant(1.0 - 1e-9), spacing);
  for (Index k = 0; k < grid.nodes[2]; ++k) {
    for (Index j = 0; j < grid.nodes[1]; ++j) {
      for (Index i = 0; i < grid.nodes[0]; ++i)
        grid.values[grid.node(i, j, k)] = static_cast<float>(value(grid.place(i, j, k)));
    }
  }
  return grid;
}

/// The mean of a cell's crossings lies inside the sphere by no more than h^2 / r.
TEST(DualContour, OfABallIsASphere) {
  const Mesh mesh = dual_contour(filled_grid(21, [](const Eigen::RowVector3d& p) { return 0.7 - p.norm(); }));
  const test::ManifoldReport report = test::examine(mesh);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.euler, 2);
  EXPECT_NEAR(report.volume, 4.0 / 3.0 * 3.14159265 * 0.343, 0.05);
  for (Index v = 0; v < mesh.vertex_count(); ++v) EXPECT_NEAR(mesh.points.row(v).norm(), 0.7, 0.015);
}

TEST(DualContour, ClosesAtTheBorderOfTheGrid) {
  const Mesh mesh = dual_contour(filled_grid(8, [](const Eigen::RowVector3d& p) { return p(0) + 0.1; }));
  const test::ManifoldReport report = test::examine(mesh);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.boundary_edge_count, 0);
  EXPECT_EQ(report.euler, 2);
}

/// Random numbers have every kind of cell, ambiguous faces on both sides included.
TEST(DualContour, OfRandomNumbersIsAClosedManifold) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, seed % 2 == 0 ? 1.0 : 0.4);
    const Mesh mesh = dual_contour(filled_grid(9, [&](const Eigen::RowVector3d& /*p*/) { return uniform(random); }));
    const test::ManifoldReport report = test::examine(mesh);
    EXPECT_TRUE(report.valid) << report.reason;
    EXPECT_EQ(report.boundary_edge_count, 0);
    EXPECT_GT(report.volume, 0.0);
    EXPECT_NO_THROW(Topology{mesh});
  }
}

TEST(DualContour, OfNothingHasNoFaces) {
  EXPECT_EQ(dual_contour(filled_grid(5, [](const Eigen::RowVector3d& /*p*/) { return -1.0; })).face_count(), 0);
}

}  // namespace
}  // namespace batten
