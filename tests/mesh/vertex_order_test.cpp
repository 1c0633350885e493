/// Vertices in the order of a band.
#include "batten/mesh/vertex_order.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "batten/mesh/primitives.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// From a corner of a grid whose faces are squares the distance is the larger of two differences.
TEST(VertexOrder, GoesOutwardsFromTheFirst) {
  const Buffer<Index> order = breadth_first_vertices(Topology(grid(5, 4)));
  ASSERT_EQ(order.size(), 30U);
  EXPECT_EQ(order[0], 0);
  const auto distance = [](Index v) { return std::max(v % 6, v / 6); };
  for (std::size_t i = 1; i < order.size(); ++i) EXPECT_LE(distance(order[i - 1]), distance(order[i])) << i;
}

TEST(VertexOrder, TakesEachVertexOnceInEachComponent) {
  Mesh mesh = test::mesh_of_faces(9, {{5, 6, 7}, {0, 2, 8}});  // 1, 3 and 4 have no face
  const Buffer<Index> order = breadth_first_vertices(Topology(mesh));
  Buffer<Index> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (Index v = 0; v < 9; ++v) EXPECT_EQ(sorted[v], v);
  EXPECT_EQ((Buffer<Index>(order.begin(), order.begin() + 3)), (Buffer<Index>{0, 2, 8}));
  EXPECT_EQ((Buffer<Index>(order.end() - 4, order.end() - 1)), (Buffer<Index>{4, 5, 6}));
}

}  // namespace
}  // namespace batten
