#include "batten/solve/tile_builder.h"

#include <gtest/gtest.h>

#include <numeric>

namespace batten {
namespace {

/// Rows from anywhere in a system of twenty million.
TEST(LocalPlaces, CountsRowsInTheOrderInWhichTheyAreMet) {
  constexpr Index kRows = 20000000;
  LocalPlaces places;
  for (int round = 0; round < 2; ++round) {
    places.clear(kRows);
    Buffer<Index> rows;
    for (Index i = 0; i < 20000; ++i)
      rows.push_back(static_cast<Index>((std::int64_t{i} * 1999999973 + round) % kRows));
    for (Index i = 0; i < 20000; ++i) ASSERT_EQ(places.find_or_add(rows[i]), i);
    for (Index i = 19999; i >= 0; --i) ASSERT_EQ(places.find_or_add(rows[i]), i);
    EXPECT_EQ(places.count(), 20000);
    EXPECT_TRUE(places.rows() == rows);
  }
}

TEST(LocalPlaces, SaysWhenThereAreNoMorePlaces) {
  LocalPlaces places;
  places.clear(100000);
  for (Index i = 0; i < LocalPlaces::kMost; ++i) ASSERT_EQ(places.find_or_add(99999 - i), i);
  EXPECT_EQ(places.find_or_add(7), LocalPlaces::kMost);
  EXPECT_EQ(places.count(), LocalPlaces::kMost);
  EXPECT_EQ(places.find_or_add(99999), 0);
  places.clear(100);
  EXPECT_EQ(places.find_or_add(7), 0);
}

}  // namespace
}  // namespace batten
