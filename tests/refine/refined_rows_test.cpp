#include "batten/refine/refined_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/mesh/primitives.h"
#include "batten/refine/refined_values.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// The matrix as refine_values() makes it of unit vectors.
Values matrix_by_values(const Topology& topology, const Scheme& scheme) {
  const Index count = topology.vertex_count();
  Values matrix(refined_vertex_count(topology, scheme.kind), count);
  refine_values(topology, scheme, {}, Values::Identity(count, count), matrix.data());
  return matrix;
}

template <typename Visit>
void for_each_tagged_sample(const Visit& visit) {
  test::for_each_sample([&](const Mesh& mesh, Scheme scheme, const std::string& name) {
    visit(Topology(mesh), scheme, name);
    scheme.boundary = BoundaryRule::EdgeAndCorner;
    for (const CreaseMethod method : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
      scheme.crease_method = method;
      visit(Topology(test::with_random_tags(mesh, 11)), scheme, name + ", tagged");
    }
  });
}

TEST(RefinedRows, AreWhatRefinementMakesOfUnitVectors) {
  for_each_tagged_sample([](const Topology& topology, const Scheme& scheme, const std::string& name) {
    const SparseRows rows = refined_rows(topology, scheme);
    Values matrix = Values::Zero(rows.count(), topology.vertex_count());
    for (Index r = 0; r < rows.count(); ++r) {
      for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) matrix(r, rows.columns[e]) = rows.weights[e];
    }
    const double difference = (matrix - matrix_by_values(topology, scheme)).cwiseAbs().maxCoeff();
    // Numbers may be multiplied and added without a rounding in between, weights not. Among quads and under Loop, where
    // ring types are made, all products are by powers of two.
    const bool exact = scheme.kind == SchemeKind::Loop || topology.uniform_face_size() == 4;
    EXPECT_LE(difference, exact ? 0.0 : 2e-16) << name;
  });
}

TEST(RefinedRows, PullbackIsTheTransposedMatrix) {
  for_each_tagged_sample([](const Topology& topology, const Scheme& scheme, const std::string& name) {
    const Values matrix = matrix_by_values(topology, scheme);
    const RefinementPullback pull_back(topology, scheme);
    VertexWeights row;
    Eigen::RowVectorXd weights(matrix.rows());
    for (Index r = 0; r < matrix.rows(); ++r) {
      weights[r] = std::sin(3.0 * r + 1.0);
      row.emplace_back(r, weights[r]);
    }
    Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(matrix.cols());
    Index last = -1;
    for (const auto& [vertex, weight] : pull_back(row)) {
      EXPECT_LT(last, vertex);
      last = vertex;
      sums[vertex] += weight;
    }
    // Rounding of sums of up to 200 numbers below 1.
    EXPECT_LT((sums - weights * matrix).cwiseAbs().maxCoeff(), 1e-13) << name;
  });
}

}  // namespace
}  // namespace batten
