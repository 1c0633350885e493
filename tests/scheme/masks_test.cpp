#include "batten/scheme/masks.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "support/dense.h"

namespace batten {
namespace {

const double kRoot17 = std::sqrt(17.0);
/// A dozen roundings of numbers of order 10.
constexpr double kRounding = 1e-13;

/// A ring as a vector: v, e_0 .. e_{edges-1}, then, for Catmull-Clark, f_0 .. f_{faces-1}. The rows below are written
/// from the rules as they are printed (docs/mathematics.md, Refinement rules), without the library's masks.
struct Ring {
  SchemeKind kind;
  int edges;
  bool closed;
  int faces() const { return closed ? edges : edges - 1; }
  int size() const { return 1 + edges + (kind == SchemeKind::CatmullClark ? faces() : 0); }
  int edge(int j) const { return 1 + (j + edges) % edges; }
  int face(int j) const { return 1 + edges + (j + faces()) % faces(); }
  Eigen::RowVectorXd unit(int i) const { return Eigen::RowVectorXd::Unit(size(), i); }
  Eigen::RowVectorXd centroid(int j) const {
    return 0.25 * (unit(0) + unit(edge(j)) + unit(edge(j + 1)) + unit(face(j)));
  }
};

Eigen::RowVectorXd vertex_row(const Ring& ring) {
  if (!ring.closed) return 0.75 * ring.unit(0) + 0.125 * (ring.unit(1) + ring.unit(ring.edges));
  const double n = ring.edges;
  const double root = 3.0 / 8.0 + std::cos(2.0 * std::numbers::pi / n) / 4.0;
  const double beta = (5.0 / 8.0 - root * root) / n;
  const bool quads = ring.kind == SchemeKind::CatmullClark;
  Eigen::RowVectorXd row = (quads ? (n - 2.0) / n : 1.0 - n * beta) * ring.unit(0);
  for (int j = 0; j < ring.edges; ++j) {
    row += (quads ? 1.0 / (n * n) : beta) * ring.unit(ring.edge(j));
    if (quads) row += 1.0 / (n * n) * ring.centroid(j);
  }
  return row;
}

Eigen::RowVectorXd edge_row(const Ring& ring, int j) {
  if (!ring.closed && (j == 0 || j + 1 == ring.edges)) return 0.5 * (ring.unit(0) + ring.unit(ring.edge(j)));
  if (ring.kind == SchemeKind::CatmullClark) {
    return 0.25 * (ring.unit(0) + ring.unit(ring.edge(j)) + ring.centroid(j - 1) + ring.centroid(j));
  }
  return 3.0 / 8.0 * (ring.unit(0) + ring.unit(ring.edge(j))) +
         1.0 / 8.0 * (ring.unit(ring.edge(j - 1)) + ring.unit(ring.edge(j + 1)));
}

/// Takes a ring to the ring of the same vertex one level down.
Eigen::MatrixXd refinement_matrix(const Ring& ring) {
  Eigen::MatrixXd matrix(ring.size(), ring.size());
  matrix.row(0) = vertex_row(ring);
  for (int j = 0; j < ring.edges; ++j) matrix.row(ring.edge(j)) = edge_row(ring, j);
  if (ring.kind == SchemeKind::Loop) return matrix;
  for (int j = 0; j < ring.faces(); ++j) matrix.row(ring.face(j)) = ring.centroid(j);
  return matrix;
}

Eigen::RowVectorXd as_row(const Ring& ring, const RingMask& mask) {
  Eigen::RowVectorXd row = mask.vertex * ring.unit(0);
  for (int j = 0; j < ring.edges; ++j) row += mask.edges[j] * ring.unit(ring.edge(j));
  if (ring.kind == SchemeKind::Loop) return row;
  for (int j = 0; j < ring.faces(); ++j) row += mask.faces[j] * ring.unit(ring.face(j));
  return row;
}

/// A smooth mask's face weights stand on centroids.
Eigen::RowVectorXd as_row(const Ring& ring, const SmoothMask& mask) {
  Eigen::RowVectorXd row = mask.vertex * ring.unit(0);
  for (int j = 0; j < ring.edges; ++j) {
    row += mask.edge * ring.unit(ring.edge(j));
    if (ring.kind == SchemeKind::CatmullClark) row += mask.face * ring.centroid(j);
  }
  return row;
}

class SmoothVertex : public ::testing::TestWithParam<std::tuple<SchemeKind, int>> {
 protected:
  SchemeKind kind() const { return std::get<0>(GetParam()); }
  int valence() const { return std::get<1>(GetParam()); }
  Ring ring() const { return {kind(), valence(), true}; }
};
std::string ring_name(const ::testing::TestParamInfo<std::tuple<SchemeKind, int>>& info) {
  const bool loop = std::get<0>(info.param) == SchemeKind::Loop;
  return (loop ? "Loop" : "CatmullClark") + std::to_string(std::get<1>(info.param));
}
const auto kBothSchemes = ::testing::Values(SchemeKind::CatmullClark, SchemeKind::Loop);
INSTANTIATE_TEST_SUITE_P(Masks, SmoothVertex, ::testing::Combine(kBothSchemes, ::testing::Range(3, 13)), ring_name);

TEST_P(SmoothVertex, MasksSumToOneAndTangentsToZero) {
  EXPECT_NEAR(as_row(ring(), vertex_mask(kind(), valence())).sum(), 1.0, kRounding);
  EXPECT_NEAR(as_row(ring(), limit_mask(kind(), valence())).sum(), 1.0, kRounding);
  const TangentMasks tangents = smooth_tangents(kind(), valence());
  EXPECT_NEAR(as_row(ring(), tangents.first).sum(), 0.0, kRounding);
  EXPECT_NEAR(as_row(ring(), tangents.second).sum(), 0.0, kRounding);
}

TEST_P(SmoothVertex, VertexMaskIsThePrintedRule) {
  EXPECT_LT((as_row(ring(), vertex_mask(kind(), valence())) - vertex_row(ring())).norm(), kRounding);
}

TEST_P(SmoothVertex, LimitMaskIsALeftEigenvectorOfOne) {
  const Eigen::RowVectorXd mask = as_row(ring(), limit_mask(kind(), valence()));
  EXPECT_LT((mask * refinement_matrix(ring()) - mask).norm(), kRounding);
}

TEST_P(SmoothVertex, TangentMasksAreLeftEigenvectorsOfTheSubdominantEigenvalue) {
  const TangentMasks tangents = smooth_tangents(kind(), valence());
  const double lambda = subdominant_eigenvalue(kind(), valence());
  for (const RingMask& mask : {tangents.first, tangents.second}) {
    const Eigen::RowVectorXd row = as_row(ring(), mask);
    EXPECT_GT(row.norm(), 1.0);
    EXPECT_LT((row * refinement_matrix(ring()) - lambda * row).norm(), kRounding);
  }
}

TEST_P(SmoothVertex, SubdominantEigenvalueIsTheSecondLargest) {
  Eigen::VectorXd sizes = test::eigenvalues(refinement_matrix(ring())).cwiseAbs();
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  EXPECT_NEAR(sizes[0], 1.0, 1e-12);
  EXPECT_NEAR(sizes[1], subdominant_eigenvalue(kind(), valence()), 1e-12);
  EXPECT_NEAR(sizes[2], subdominant_eigenvalue(kind(), valence()), 1e-12);
}

/// On a flat ring that turns counter-clockwise, the first tangent points at e_0 and the cross product upwards.
TEST_P(SmoothVertex, TangentsAreOrientedOutward) {
  const TangentMasks tangents = smooth_tangents(kind(), valence());
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(ring().size(), 2);
  for (int j = 0; j < valence(); ++j) {
    const double angle = 2.0 * std::numbers::pi * j / valence();
    const double half = std::numbers::pi / valence();
    points.row(ring().edge(j)) << std::cos(angle), std::sin(angle);
    if (kind() == SchemeKind::CatmullClark)
      points.row(ring().face(j)) << std::cos(angle + half), std::sin(angle + half);
  }
  const Eigen::RowVector2d first = as_row(ring(), tangents.first) * points;
  const Eigen::RowVector2d second = as_row(ring(), tangents.second) * points;
  EXPECT_GT(first[0] * second[1] - first[1] * second[0], 0.0);
  EXPECT_GT(first[0], 0.0);
  EXPECT_NEAR(first[1], 0.0, kRounding);
}

class Alpha : public SmoothVertex {};
INSTANTIATE_TEST_SUITE_P(Masks, Alpha,
                         ::testing::Combine(::testing::Values(SchemeKind::CatmullClark), ::testing::Range(3, 13)),
                         ring_name);

/// Alpha acts in the first step only: the mask is the ordinary limit of the ring after that step (docs/mathematics.md,
/// Limit positions).
TEST_P(Alpha, LimitMaskIsTheOrdinaryOneAfterOneStepWithAlpha) {
  for (const double alpha : {0.25, 0.5, 1.0}) {
    const double n = valence();
    Eigen::MatrixXd step = refinement_matrix(ring());
    step.row(0) = as_row(ring(), SmoothMask{(n - 2.0 + alpha) / n, (1.0 - alpha) / (n * n), 1.0 / (n * n)});
    const Eigen::RowVectorXd expected = as_row(ring(), limit_mask(kind(), valence())) * step;
    EXPECT_LT((as_row(ring(), limit_mask(kind(), valence(), alpha)) - expected).norm(), kRounding);
    EXPECT_LT((as_row(ring(), vertex_mask(kind(), valence(), alpha)) - step.row(0)).norm(), kRounding);
  }
}

class CreaseVertex : public ::testing::TestWithParam<std::tuple<SchemeKind, int>> {
 protected:
  SchemeKind kind() const { return std::get<0>(GetParam()); }
  int faces() const { return std::get<1>(GetParam()); }
  Ring ring() const { return {kind(), faces() + 1, false}; }
  double lambda() const { return subdominant_eigenvalue(kind(), 2 * faces()); }
  Eigen::RowVectorXd residual(const Eigen::RowVectorXd& row, double eigenvalue) const {
    return row * refinement_matrix(ring()) - eigenvalue * row;
  }
};
INSTANTIATE_TEST_SUITE_P(Masks, CreaseVertex, ::testing::Combine(kBothSchemes, ::testing::Range(1, 9)), ring_name);

TEST_P(CreaseVertex, LimitMaskIsThatOfTheCubicSpline) {
  Eigen::RowVectorXd mask = kCreaseLimitVertex * ring().unit(0);
  mask += kCreaseLimitNeighbour * (ring().unit(1) + ring().unit(ring().edges));
  EXPECT_LT(residual(mask, 1.0).norm(), kRounding);
}

TEST_P(CreaseVertex, TangentsSumToZeroAndTheFirstRunsAlong) {
  for (const auto choice : {CreaseTangents::Exact, CreaseTangents::OpenSubdiv}) {
    const TangentMasks tangents = crease_tangents(kind(), faces(), choice);
    const Eigen::RowVectorXd along = as_row(ring(), tangents.first);
    EXPECT_LT((along / along[1] - (ring().unit(1) - ring().unit(ring().edges))).norm(), kRounding);
    EXPECT_LT(residual(along, 0.5).norm(), kRounding);
    EXPECT_NEAR(as_row(ring(), tangents.second).sum(), 0.0, 1e-12);
  }
}

/// Up to 3 faces (Catmull-Clark) or 5 (Loop) the cross tangent is an eigenvector of the rules refined with; beyond, no
/// plane holds both tangents in the limit, and both choices are OpenSubdiv's.
TEST_P(CreaseVertex, ExactCrossTangentIsALeftEigenvectorWhereOneExists) {
  const RingMask exact = crease_tangents(kind(), faces(), CreaseTangents::Exact).second;
  const RingMask opensubdiv = crease_tangents(kind(), faces(), CreaseTangents::OpenSubdiv).second;
  const bool exists = faces() <= (kind() == SchemeKind::CatmullClark ? 3 : 5);
  if (exists) {
    // With one face, e_0 - v and e_1 - v lie in every plane; the sum of both shrinks by 1/4.
    EXPECT_LT(residual(as_row(ring(), exact), faces() == 1 ? 0.25 : lambda()).norm(), 1e-12);
  } else {
    EXPECT_EQ(as_row(ring(), exact), as_row(ring(), opensubdiv));
  }
}

TEST_P(CreaseVertex, CrossTangentPointsInwardSoThatTheNormalPointsOutward) {
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(ring().size(), 2);
  for (int j = 0; j <= faces(); ++j)
    points.row(ring().edge(j)) << std::cos(std::numbers::pi * j / faces()), std::sin(std::numbers::pi * j / faces());
  if (kind() == SchemeKind::CatmullClark) {
    for (int j = 0; j < faces(); ++j) points.row(ring().face(j)) = points.row(1 + j) + points.row(2 + j);
  }
  if (faces() == 1) points.row(1) << 1.0, 0.1, points.row(2) << -1.0, 0.1;
  for (const auto choice : {CreaseTangents::Exact, CreaseTangents::OpenSubdiv}) {
    const TangentMasks tangents = crease_tangents(kind(), faces(), choice);
    const Eigen::RowVector2d first = as_row(ring(), tangents.first) * points;
    const Eigen::RowVector2d second = as_row(ring(), tangents.second) * points;
    EXPECT_GT(first[0] * second[1] - first[1] * second[0], 0.0);
  }
}

// Tables (docs/mathematics.md, Limit tangents).

TEST(Masks, EigenvaluesOfCatmullClarkAreThoseOfTheTable) {
  const std::vector<std::pair<int, double>> table{{3, 0.4100970508},  {4, 0.5},          {5, 0.5499883545},
                                                  {6, 0.5796823261},  {7, 0.5985102835}, {8, 0.6111165267},
                                                  {10, 0.6263412675}, {12, 0.6347964124}};
  for (const auto& [valence, lambda] : table) {
    EXPECT_NEAR(subdominant_eigenvalue(SchemeKind::CatmullClark, valence), lambda, 5e-11) << valence;  // ten digits
  }
  EXPECT_NEAR(subdominant_eigenvalue(SchemeKind::CatmullClark, 3), (9.0 + kRoot17) / 32.0, kRounding);
}

void expect_proportional(const std::vector<double>& weights, const std::vector<double>& table, double scale) {
  ASSERT_EQ(weights.size(), table.size());
  for (std::size_t i = 0; i < table.size(); ++i) EXPECT_NEAR(weights[i], scale * table[i], kRounding) << i;
}

TEST(Masks, TangentsOfValenceFourAreThoseOfTheTable) {
  const TangentMasks tangents = smooth_tangents(SchemeKind::CatmullClark, 4);
  expect_proportional(tangents.first.edges, {4, 0, -4, 0}, 1.0);
  expect_proportional(tangents.first.faces, {1, -1, -1, 1}, 1.0);
  expect_proportional(tangents.second.edges, {0, 4, 0, -4}, 1.0);
  expect_proportional(tangents.second.faces, {1, 1, -1, -1}, 1.0);
}

/// Thall's c2 with a = -1 - sqrt 17 and b = 2 + 2 sqrt 17 stands on e_2; here it is turned to e_0.
TEST(Masks, TangentOfValenceThreeIsThatOfTheTable) {
  const TangentMasks tangents = smooth_tangents(SchemeKind::CatmullClark, 3);
  const double a = -1.0 - kRoot17;
  const double b = 2.0 + 2.0 * kRoot17;
  expect_proportional(tangents.first.edges, {b, a, a}, tangents.first.edges[0] / b);
  expect_proportional(tangents.first.faces, {2, -4, 2}, tangents.first.edges[0] / b);
}

TEST(Masks, OpenSubdivsCrossTangentsAreThoseOfTheTable) {
  const auto cross = [](SchemeKind kind, int faces) {
    return crease_tangents(kind, faces, CreaseTangents::OpenSubdiv).second;
  };
  for (const auto kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    EXPECT_EQ(cross(kind, 1).vertex, -6.0);
    expect_proportional(cross(kind, 1).edges, {3, 3}, 1.0);
  }
  EXPECT_NEAR(cross(SchemeKind::CatmullClark, 2).vertex, -4.0 / 6.0, kRounding);
  expect_proportional(cross(SchemeKind::CatmullClark, 2).edges, {-1, 4, -1}, 1.0 / 6.0);
  expect_proportional(cross(SchemeKind::CatmullClark, 2).faces, {1, 1}, 1.0 / 6.0);
  EXPECT_EQ(cross(SchemeKind::Loop, 2).vertex, -3.0);
  expect_proportional(cross(SchemeKind::Loop, 2).edges, {0, 3, 0}, 1.0);
  EXPECT_NEAR(cross(SchemeKind::Loop, 3).vertex, -std::sqrt(3.0), kRounding);
  expect_proportional(cross(SchemeKind::Loop, 3).edges, {-0.5, 1, 1, -0.5}, std::sqrt(3.0));
  EXPECT_EQ(cross(SchemeKind::Loop, 4).vertex, 0.0);
}

TEST(Masks, SmoothTriangleRuleWeighsEachSideByItsFace) {
  Scheme scheme;
  EXPECT_EQ(edge_mask(scheme, 2).face, 0.25);  // the rule must be asked for
  scheme.triangle_rule = TriangleRule::Smooth;
  for (const auto& [triangles, face] : std::vector<std::pair<int, double>>{{0, 0.25}, {1, 0.36}, {2, 0.47}}) {
    const EdgeMask mask = edge_mask(scheme, triangles);
    EXPECT_NEAR(mask.face, face, kRounding);
    EXPECT_NEAR(2.0 * mask.end + 2.0 * mask.face, 1.0, kRounding);
  }
  scheme.kind = SchemeKind::Loop;
  EXPECT_EQ(edge_mask(scheme, 2).end, 0.375);
}

/// A vertex of valence 2 keeps the limit of its own refinement: (4; 4, 4; 1, 1)/14.
TEST(Masks, LimitMaskHoldsForValenceTwo) {
  const Ring ring{SchemeKind::CatmullClark, 2, true};
  const Eigen::RowVectorXd mask = as_row(ring, limit_mask(SchemeKind::CatmullClark, 2));
  EXPECT_LT((14.0 * mask - (Eigen::RowVectorXd(5) << 4, 4, 4, 1, 1).finished()).norm(), kRounding);
  EXPECT_LT((mask * refinement_matrix(ring) - mask).norm(), kRounding);
}

}  // namespace
}  // namespace batten
