#include "batten/expand/mesh_series.h"

#include <gtest/gtest.h>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "support/dense.h"
#include "support/shapes.h"

namespace batten {
namespace {

SeriesOptions cotangent(const Mesh& mesh) {
  SeriesOptions options;
  options.matrix = SeriesMatrix::Cotangent;
  options.shape = mesh.points;
  return options;
}

double largest(const Values& values) { return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0; }

/// A as a dense matrix, by applying it to the unit vectors.
Values dense(const MeshSeries& series) {
  const Index count = series.topology().vertex_count();
  return series.apply(Values::Identity(count, count));
}

/// Every sample with the limit matrix of its schemes, and with cotangents.
template <typename Visit>
void for_each_series(const Visit& visit) {
  test::for_each_sample([&](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(mesh);
    for (const SeriesOptions& options : {SeriesOptions(), cotangent(mesh)}) {
      SCOPED_TRACE(name + (options.matrix == SeriesMatrix::Limit ? "" : ", cotangents"));
      visit(mesh, MeshSeries(topology, scheme, options));
    }
  });
}

TEST(MeshSeries, TakesTheLimitMatrixOfTheScheme) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    if (name.find("dihedron") != std::string::npos) return;  // valence 2: another alpha
    const Topology topology(mesh);
    const MeshSeries series(topology, scheme);
    EXPECT_LT(largest(dense(series) - LimitMatrix(topology, scheme).matrix().toDense()), 1e-14);
  });
}

TEST(MeshSeries, WritesIntoTheCallersMemory) {
  for_each_series([](const Mesh& mesh, const MeshSeries& series) {
    Values wide = Values::Constant(mesh.vertex_count(), 5, 7.0);
    const auto same = [&](const Values& expected) {
      return (wide.middleCols(1, 3).array() == expected.array()).all() && (wide.col(0).array() == 7.0).all() &&
             (wide.col(4).array() == 7.0).all();
    };
    series.polynomial_into(mesh.points, wide.middleCols(1, 3), {0.5, 2.0, -1.0}, 2);
    EXPECT_TRUE(same(series.polynomial(mesh.points, {0.5, 2.0, -1.0}, 2)));
    series.apply_into(mesh.points, wide.middleCols(1, 3));
    EXPECT_TRUE(same(series.apply(mesh.points)));
    series.remainder_into(mesh.points, wide.middleCols(1, 3), 3);
    EXPECT_TRUE(same(series.remainder(mesh.points, 3)));
    series.term_into(mesh.points, wide.middleCols(1, 3), 2);
    EXPECT_TRUE(same(series.term(mesh.points, 2)));
    series.partial_sum_into(mesh.points, wide.middleCols(1, 3), 4);
    EXPECT_TRUE(same(series.partial_sum(mesh.points, 4)));
    series.smooth_into(mesh.points, wide.middleCols(1, 3), 1, 5);
    EXPECT_TRUE(same(series.smooth(mesh.points, 1, 5)));
    Values wrong(mesh.vertex_count(), 2);
    EXPECT_THROW(series.apply_into(mesh.points, wrong), Error);
  });
}

TEST(MeshSeries, TermsAndWhatTheyLeaveAddUpToTheValues) {
  for_each_series([](const Mesh& mesh, const MeshSeries& series) {
    Values sum = Values::Zero(mesh.vertex_count(), 3);
    for (int i = 0; i < 12; ++i) {
      sum += series.term(mesh.points, i);
      EXPECT_LT(largest(sum - series.partial_sum(mesh.points, i)), 1e-13);
      EXPECT_LT(largest(sum + series.remainder(mesh.points, i + 1) - mesh.points), 1e-13);
    }
  });
}

/// The identity behind the series: (sum_{i <= n} G^i) A = E - G^(n+1), by Lai and Cheng's recursion (7).
TEST(MeshSeries, TelescopesAsTheIterationOfInterpolationDoes) {
  for_each_series([](const Mesh& mesh, const MeshSeries& series) {
    const Values limit = series.apply(mesh.points);
    Values control = limit;
    for (int n = 0; n < 9; ++n) {
      EXPECT_LT(largest(control - series.partial_sum(mesh.points, n)), 1e-13);
      control += limit - series.apply(control);
    }
  });
}

TEST(MeshSeries, HasItsSpectrumBetweenZeroAndOne) {
  for_each_series([](const Mesh& /*mesh*/, const MeshSeries& series) {
    const Eigen::VectorXcd spectrum = test::eigenvalues(dense(series));
    EXPECT_GT(spectrum.real().minCoeff(), -1e-14);
    EXPECT_LT(spectrum.real().maxCoeff(), 1.0 + 1e-13);
    EXPECT_LT(spectrum.imag().cwiseAbs().maxCoeff(), 1e-7);  // defective ones split by the root of the rounding
  });
}

/// Gains against a dense eigendecomposition: of each mode v with A v = a v, smoothing leaves (1 - (1 - a)^(m+1))^k.
TEST(MeshSeries, SmoothsEachModeByItsGain) {
  for (const Mesh& mesh : {test::jittered(torus(9, 7), 0.05, 3), test::random_hull(50, 5), dodecahedron()}) {
    const Topology topology(mesh);
    for (const SeriesOptions& options : {SeriesOptions(), cotangent(mesh)}) {
      const MeshSeries series(topology, choose_scheme(mesh), options);
      const Index count = mesh.vertex_count();
      Eigen::VectorXd root(count);
      for (Index v = 0; v < count; ++v) root[v] = std::sqrt(series.weight(v));
      const Eigen::MatrixXd symmetric = root.asDiagonal() * dense(series) * root.cwiseInverse().asDiagonal();
      ASSERT_LT(largest(symmetric - symmetric.transpose()), 1e-13);
      const test::SymmetricModes solved = test::symmetric_modes(symmetric);
      const Eigen::ArrayXd a = solved.values;
      const Values modes = root.cwiseInverse().asDiagonal() * solved.vectors;
      for (const int m : {0, 1, 2, 5}) {
        const Eigen::ArrayXd gain = (1.0 - (1.0 - a).pow(m + 1)).pow(4);
        EXPECT_LT(largest(series.smooth(modes, m, 4) - modes * gain.matrix().asDiagonal()), 1e-13);
      }
      // Any polynomial, here one that sharpens: G + G^2 + G^3.
      const Eigen::ArrayXd g = 1.0 - a;
      const Eigen::ArrayXd gain = 1.0 + g + g.square() + g.cube();
      EXPECT_LT(largest(series.polynomial(modes, {1.0, 1.0, 1.0, 1.0}) - modes * gain.matrix().asDiagonal()), 1e-13);
    }
  }
}

/// docs/mathematics.md, The mesh series: the limit of ever more passes is the weighted centroid, not the mean.
TEST(MeshSeries, ComesToTheWeightedCentroid) {
  for (const Mesh& mesh : {test::bipyramid(24), test::random_hull(20, 2)}) {
    const Topology topology(mesh);
    for (const SeriesOptions& options : {SeriesOptions(), cotangent(mesh)}) {
      const MeshSeries series(topology, choose_scheme(mesh), options);
      const Eigen::RowVectorXd centroid = series.weighted_centroid(mesh.points);
      EXPECT_LT(largest(series.smooth(mesh.points, 0, 20000).rowwise() - centroid), 1e-9);
    }
  }
}

TEST(MeshSeries, KeepsWhatItIsToldToKeep) {
  const Mesh mesh = test::jittered(grid(9, 8), 0.1, 1);
  const Topology topology(mesh);
  SeriesOptions options;
  options.kept.assign(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) options.kept[v] = topology.is_boundary_vertex(v) || v == 44 ? 1 : 0;
  for (const bool cotangents : {false, true}) {
    options.matrix = cotangents ? SeriesMatrix::Cotangent : SeriesMatrix::Limit;
    options.shape = mesh.points;
    const MeshSeries series(topology, {}, options);
    const Values smooth = series.smooth(mesh.points, 2, 30);
    double moved = 0.0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double distance = (smooth.row(v) - mesh.points.row(v)).norm();
      if (series.is_kept(v)) {
        EXPECT_EQ(distance, 0.0);
      } else {
        moved = std::max(moved, distance);
      }
    }
    EXPECT_GT(moved, 0.05);
  }
}

/// A crease is a curve that does not depend on the sides; a straight one stays straight.
TEST(MeshSeries, SmoothsCreasesAlongThemselves) {
  Mesh mesh = grid(8, 8);
  for (Index i = 0; i < 8; ++i) mesh.creases.push_back({4 * 9 + i, 4 * 9 + i + 1, 10.0});
  for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.points(v, 2) = -0.8 * std::abs(mesh.points(v, 1));
  const Topology topology(mesh);
  for (const SeriesOptions& options : {SeriesOptions(), cotangent(mesh)}) {
    const Values smooth = MeshSeries(topology, {}, options).smooth(mesh.points, 1, 25);
    for (Index i = 0; i <= 8; ++i) EXPECT_EQ(smooth(4 * 9 + i, 2), 0.0);
    EXPECT_LT(smooth(2 * 9 + 4, 2), -0.3);
  }
}

/// On a plane every point is the cotangents' average of its neighbours, whatever the triangles; valence's is not.
TEST(MeshSeries, CotangentsLeaveAFlatMeshAlone) {
  Mesh mesh = test::jittered(grid(10, 10), 0.06, 4);
  mesh.points.col(2).setZero();
  const Topology topology(mesh);
  SeriesOptions options = cotangent(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v) options.kept.push_back(topology.is_boundary_vertex(v) ? 1 : 0);
  EXPECT_LT(largest(MeshSeries(topology, {}, options).smooth(mesh.points, 0, 10) - mesh.points), 1e-13);
  options.matrix = SeriesMatrix::Limit;
  EXPECT_GT(largest(MeshSeries(topology, {}, options).smooth(mesh.points, 0, 10) - mesh.points), 0.02);
}

/// Rows of large faces do not go into tiles; the same polynomials come from whole sweeps.
TEST(MeshSeries, TakesHugeFaces) {
  test::Faces faces(1);
  const Index n = 400;
  for (Index v = 0; v < n; ++v) {
    faces[0].push_back(n - 1 - v);
    faces.push_back({v, (v + 1) % n, n});
  }
  Mesh cone = test::mesh_of_faces(n + 1, faces);
  const Topology topology(cone);
  const MeshSeries series(topology, {});
  const Values a = series.limit_matrix().matrix().toDense();
  Values expected = cone.points;
  for (int i = 0; i < 3; ++i) expected = Values(expected - a * expected);
  EXPECT_LT(largest(series.remainder(cone.points, 3) - expected), 1e-13);
  EXPECT_LT(largest(series.smooth(cone.points, 2, 1) - (cone.points - expected)), 1e-13);
}

TEST(MeshSeries, EnergiesAreThoseOfTheTerms) {
  const Mesh mesh = test::jittered(torus(12, 8), 0.1, 9);
  const Topology topology(mesh);
  const MeshSeries series(topology, {});
  const std::vector<double> energies = series.energies(mesh.points, 4);
  ASSERT_EQ(energies.size(), 4U);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(energies[i], series.term(mesh.points, i).squaredNorm() / mesh.vertex_count(), 1e-14);
}

TEST(MeshSeries, ThreadsDoNotChangeABit) {
  const Mesh mesh = test::jittered(torus(150, 100), 0.001, 9);
  const Topology topology(mesh);
  for (const SeriesOptions& options : {SeriesOptions(), cotangent(mesh)}) {
    const Values all = MeshSeries(topology, {}, options).smooth(mesh.points, 2, 4);
    const ThreadLimit limit(1);
    const Values one = MeshSeries(topology, {}, options).smooth(mesh.points, 2, 4);
    EXPECT_TRUE((all.array() == one.array()).all());
  }
}

TEST(MeshSeries, RefusesWhatDoesNotFit) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const auto code_of = [](const auto& work) {
    try {
      work();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::NotAvailable;
  };
  SeriesOptions options;
  options.kept.assign(3, 0);
  EXPECT_EQ(code_of([&] { const MeshSeries series(topology, {}, options); }), ErrorCode::BadShape);
  options = {};
  options.matrix = SeriesMatrix::Cotangent;
  EXPECT_EQ(code_of([&] { const MeshSeries series(topology, {}, options); }), ErrorCode::BadShape);
  options.shape = mesh.points;
  options.shape(3, 1) = std::nan("");
  EXPECT_EQ(code_of([&] { const MeshSeries series(topology, {}, options); }), ErrorCode::NotFinite);
  Scheme butterfly;
  butterfly.kind = SchemeKind::ModifiedButterfly;
  const Topology triangles(icosahedron());
  EXPECT_EQ(code_of([&] { const MeshSeries none(triangles, butterfly); }), ErrorCode::BadArgument);
  const MeshSeries series(topology, {});
  EXPECT_EQ(code_of([&] { series.apply(Values::Zero(7, 3)); }), ErrorCode::BadShape);
  EXPECT_EQ(code_of([&] { series.apply(options.shape); }), ErrorCode::NotFinite);
  EXPECT_EQ(code_of([&] { series.smooth(mesh.points, -1, 1); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([&] { series.smooth(mesh.points, 1, -1); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([&] { series.term(mesh.points, -1); }), ErrorCode::BadArgument);
}

}  // namespace
}  // namespace batten
