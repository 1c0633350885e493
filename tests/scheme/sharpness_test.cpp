#include "batten/scheme/sharpness.h"

#include <gtest/gtest.h>

#include <vector>

namespace batten {
namespace {

using Around = std::vector<float>;

TEST(Sharpness, CountsDownByOneAndStaysInfinite) {
  EXPECT_EQ(subdivided_sharpness(2.5F), 1.5F);
  EXPECT_EQ(subdivided_sharpness(1.0F), 0.0F);
  EXPECT_EQ(subdivided_sharpness(0.3F), 0.0F);
  EXPECT_EQ(subdivided_sharpness(0.0F), 0.0F);
  EXPECT_EQ(subdivided_sharpness(10.0F), kInfiniteSharpness);
  EXPECT_EQ(subdivided_sharpness(1e9F), kInfiniteSharpness);
}

TEST(Sharpness, ChaikinTakesAQuarterFromTheOtherSemiSharpEdges) {
  const Around around{3.0F, 1.0F, 2.0F, 0.0F, 10.0F};  // smooth and infinite edges do not count
  EXPECT_EQ(subdivided_sharpness(3.0F, around, CreaseMethod::Chaikin), 0.75F * 3.0F + 0.25F * 1.5F - 1.0F);
  EXPECT_EQ(subdivided_sharpness(1.0F, around, CreaseMethod::Chaikin), 0.75F + 0.25F * 2.5F - 1.0F);
  EXPECT_EQ(subdivided_sharpness(0.0F, around, CreaseMethod::Chaikin), 0.0F);
  EXPECT_EQ(subdivided_sharpness(10.0F, around, CreaseMethod::Chaikin), kInfiniteSharpness);
}

TEST(Sharpness, ChaikinIsUniformBesideNoOtherSemiSharpEdge) {
  EXPECT_EQ(subdivided_sharpness(2.5F, Around{2.5F, 0.0F, 10.0F}, CreaseMethod::Chaikin), 1.5F);
  EXPECT_EQ(subdivided_sharpness(2.5F, Around{2.5F}, CreaseMethod::Chaikin), 1.5F);
  EXPECT_EQ(subdivided_sharpness(2.5F, Around{2.5F, 1.0F}, CreaseMethod::Uniform), 1.5F);
}

TEST(Sharpness, SharpEdgesDecideTheRule) {
  EXPECT_EQ(vertex_rule(0.0F, Around{0.0F, 0.0F, 0.0F}), VertexRule::Smooth);
  EXPECT_EQ(vertex_rule(0.0F, Around{0.1F, 0.0F, 0.0F}), VertexRule::Dart);
  EXPECT_EQ(vertex_rule(0.0F, Around{0.1F, 10.0F, 0.0F}), VertexRule::Crease);
  EXPECT_EQ(vertex_rule(0.0F, Around{0.1F, 10.0F, 3.0F}), VertexRule::Corner);
  EXPECT_EQ(vertex_rule(0.1F, Around{0.0F, 0.0F, 0.0F}), VertexRule::Corner);
}

TEST(Sharpness, TransitionWeightAveragesWhatRunsOutAndStaysBelowOne) {
  EXPECT_EQ(transition_weight(0.0F, 0.0F, Around{0.5F, 0.25F, 0.0F}, Around{0.0F, 0.0F, 0.0F}), 0.375F);
  EXPECT_EQ(transition_weight(0.75F, 0.0F, Around{0.25F, 2.0F}, Around{0.0F, 1.0F}), 0.5F);
  EXPECT_EQ(transition_weight(0.0F, 0.0F, Around{1.25F, 1.5F}, Around{0.0F, 0.0F}), 1.0F);
  EXPECT_EQ(transition_weight(0.0F, 0.0F, Around{2.0F, 2.0F}, Around{1.0F, 1.0F}), 0.0F);
}

}  // namespace
}  // namespace batten
