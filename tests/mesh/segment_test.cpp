#include "batten/mesh/segment.h"

#include <gtest/gtest.h>

namespace batten {
namespace {

const Eigen::Vector3d kStart(1.0, 0.0, 0.0);
const Eigen::Vector3d kEnd(5.0, 0.0, 0.0);

TEST(Segment, TheDistanceIsPerpendicularBesideIt) {
  EXPECT_EQ(distance_to_segment({2.0, 3.0, 4.0}, kStart, kEnd), 5.0);
}

TEST(Segment, TheDistanceBeyondAnEndIsThatToTheEnd) {
  EXPECT_EQ(distance_to_segment({-2.0, 4.0, 0.0}, kStart, kEnd), 5.0);
  EXPECT_EQ(distance_to_segment({8.0, 0.0, 4.0}, kStart, kEnd), 5.0);
}

TEST(Segment, MayBeASinglePoint) { EXPECT_EQ(distance_to_segment({1.0, 3.0, 4.0}, kStart, kStart), 5.0); }

}  // namespace
}  // namespace batten
