#include "batten/mesh/measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "batten/mesh/primitives.h"

namespace batten {
namespace {

/// A box of 1 by 2 by 3 from (5, 5, 5).
Mesh brick() {
  Mesh mesh = cube();
  const Eigen::RowVector3d low = mesh.points.colwise().minCoeff();
  const double side = mesh.points.col(0).maxCoeff() - low[0];
  for (Index v = 0; v < 8; ++v) {
    const Eigen::RowVector3d place = (mesh.points.row(v) - low) / side;
    mesh.points.row(v) = Eigen::RowVector3d(5, 5, 5) + place.cwiseProduct(Eigen::RowVector3d(1, 2, 3));
  }
  return mesh;
}

TEST(Measures, OfABrick) {
  const Mesh mesh = brick();
  const Topology topology(mesh);
  EXPECT_EQ(bounding_box(mesh.points).low, Eigen::RowVector3d(5, 5, 5));
  EXPECT_EQ(bounding_box(mesh.points).high, Eigen::RowVector3d(6, 7, 8));
  const EdgeLengths lengths = edge_lengths(topology, mesh.points);
  EXPECT_DOUBLE_EQ(lengths.shortest, 1.0);
  EXPECT_DOUBLE_EQ(lengths.mean, 2.0);
  EXPECT_DOUBLE_EQ(lengths.longest, 3.0);
  EXPECT_DOUBLE_EQ(surface_area(topology, mesh.points), 22.0);
}

TEST(Measures, OfAPolygonWithADent) {
  Mesh mesh;
  mesh.points.resize(5, 3);
  mesh.points << 0, 0, 0, 4, 0, 0, 4, 4, 0, 2, 1, 0, 0, 4, 0;
  mesh.add_face({0, 1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(surface_area(Topology(mesh), mesh.points), 16.0 - 6.0);
}

TEST(Measures, OfNothingAndOfPointsThatAreNone) {
  const Topology empty{Mesh()};
  EXPECT_EQ(edge_lengths(empty, Points(0, 3)).longest, 0.0);
  EXPECT_EQ(surface_area(empty, Points(0, 3)), 0.0);
  EXPECT_EQ(bounding_box(Points(0, 3)).high, Eigen::RowVector3d(0, 0, 0));
  Points points(2, 3);
  points << 1, 2, 3, std::numeric_limits<double>::quiet_NaN(), 9, 9;
  EXPECT_EQ(bounding_box(points).high, Eigen::RowVector3d(1, 2, 3));
}

}  // namespace
}  // namespace batten
