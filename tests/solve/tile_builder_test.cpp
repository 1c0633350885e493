#include "batten/solve/tile_builder.h"

#include <gtest/gtest.h>

#include <numeric>

namespace batten {
namespace {

/// Rows from anywhere in a system of two thousand million, many more than were expected.
TEST(LocalPlaces, CountsRowsInTheOrderInWhichTheyAreMet) {
  LocalPlaces places;
  for (int round = 0; round < 2; ++round) {
    places.clear(100);
    Buffer<Index> rows;
    for (Index i = 0; i < 20000; ++i)
      rows.push_back(static_cast<Index>((std::int64_t{i} * 1999999973 + round) % 2147483647));
    for (Index i = 0; i < 20000; ++i) ASSERT_EQ(places.find_or_add(rows[i]), i);
    for (Index i = 19999; i >= 0; --i) ASSERT_EQ(places.find_or_add(rows[i]), i);
    EXPECT_EQ(places.count(), 20000);
    EXPECT_TRUE(places.rows() == rows);
  }
}

}  // namespace
}  // namespace batten
