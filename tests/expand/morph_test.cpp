#include "batten/expand/morph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/expand/morph_surface.h"
#include "batten/expand/resample.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/surface_mesh.h"
#include "io/io_test_tools.h"
#include "support/dense.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr MorphOrder kOrders[] = {MorphOrder::LowFirst, MorphOrder::LowLast};

/// Two shapes of one connectivity: closed, open, mixed faces, creased, with a stray vertex.
std::vector<Mesh> shapes() {
  std::vector<Mesh> all{torus(9, 7), grid(6, 5), cube(), test::bipyramid(5), test::annulus(8), torus(9, 7), grid(3, 3)};
  all[5].creases = {{0, 1, 10.0}, {1, 2, 10.0}, {2, 3, 1.5}};
  all[5].corners = {{1, 10.0}};
  all[6].points.conservativeResize(all[6].points.rows() + 1, 3);
  all[6].points.bottomRows(1).setConstant(3.0);
  return all;
}

struct Ends {
  explicit Ends(const Mesh& mesh, const Scheme& scheme = {})
      : topology(mesh), series(topology, scheme), from(mesh.points), to(test::jittered(mesh, 0.3, 4).points) {
    to = to * 1.7;
    to.rowwise() += Eigen::RowVector3d(0.5, -2.0, 1.0);
  }
  Topology topology;
  MeshSeries series;
  Points from;
  Points to;
};

TEST(Morph, EndsExactlyAtBothShapes) {
  for (const Mesh& mesh : shapes()) {
    const Ends ends(mesh);
    for (const MorphOrder order : kOrders) {
      for (const int stages : {0, 1, 4}) {
        const Morph morph(ends.series, ends.from, ends.to, {1, stages, order});
        EXPECT_TRUE(io_tests::same_bits(morph.at(0.0), ends.from));
        EXPECT_TRUE(io_tests::same_bits(morph.at(1.0), ends.to));
        // And runs into them: the weights at the ends give them to rounding, and a moment away the shape is no other.
        EXPECT_LT((morph.at(1e-9) - ends.from).cwiseAbs().maxCoeff(), 1e-7);
        EXPECT_LT((morph.at(1.0 - 1e-9) - ends.to).cwiseAbs().maxCoeff(), 1e-7);
      }
    }
  }
}

TEST(Morph, HasTheFactorOfEachMode) {
  const Mesh mesh = torus(7, 5);
  const Ends ends(mesh);
  const Eigen::MatrixXd matrix = ends.series.limit_matrix().matrix();
  Eigen::VectorXd root(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) root[v] = std::sqrt(ends.series.weight(v));
  const Eigen::MatrixXd symmetric = root.asDiagonal() * matrix * root.cwiseInverse().asDiagonal();
  const test::SymmetricModes modes = test::symmetric_modes(symmetric);
  const MorphOptions options{2, 3, MorphOrder::LowLast};
  for (const Eigen::Index i : {Eigen::Index{0}, Eigen::Index{10}, Eigen::Index{30}, Eigen::Index{34}}) {
    const double a = modes.values[i];
    const Values mode = root.cwiseInverse().asDiagonal() * modes.vectors.col(i);
    const Values zero = Values::Zero(mode.rows(), 1);
    const double gain = 1.0 - std::pow(1.0 - a, 3);
    const auto at = [&](double t) { return Values(Morph(ends.series, mode, zero, options).at(t)); };
    // The knots 1/3 and 2/3, after 1 and 4 smoothings, and the middle between them.
    EXPECT_LT((at(1.0 / 3.0) - 2.0 / 3.0 * gain * mode).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((at(2.0 / 3.0) - 1.0 / 3.0 * std::pow(gain, 4) * mode).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((at(0.5) - 0.25 * (gain + std::pow(gain, 4)) * mode).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(Morph, LowFirstIsLowLastRunBackwards) {
  const Ends ends(grid(6, 5));
  const Morph there(ends.series, ends.from, ends.to, {1, 4, MorphOrder::LowFirst});
  const Morph back(ends.series, ends.to, ends.from, {1, 4, MorphOrder::LowLast});
  for (const double t : {0.1, 0.37, 0.5, 0.9}) {
    EXPECT_LT((there.at(t) - back.at(1.0 - t)).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(Morph, MovesDetailAfterOrBeforeTheOverallShape) {
  const Mesh mesh = grid(30, 30);
  const Topology topology(mesh);
  const MeshSeries series(topology, {});
  Points to = mesh.points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    to(v, 1) += v % 2;                              // detail
    to(v, 2) += std::sin(2.0 * mesh.points(v, 0));  // overall shape
  }
  const auto done = [&](MorphOrder order, int column) {
    const Values middle = Morph(series, mesh.points, to, {1, 4, order}).at(0.5);
    return (middle - mesh.points).col(column).norm() / (to - mesh.points).col(column).norm();
  };
  EXPECT_NEAR(done(MorphOrder::LowFirst, 2), 0.5, 0.01);
  EXPECT_NEAR(done(MorphOrder::LowLast, 2), 0.5, 0.01);
  // Stripes along the grid, and its boundary, keep some.
  EXPECT_LT(done(MorphOrder::LowFirst, 1), 0.4);
  EXPECT_GT(done(MorphOrder::LowLast, 1), 0.6);
}

TEST(Morph, MovesTheCentroidEvenly) {
  const Ends ends(torus(9, 7));
  const Morph morph(ends.series, ends.from, ends.to);
  const Eigen::RowVectorXd start = ends.series.weighted_centroid(ends.from);
  const Eigen::RowVectorXd end = ends.series.weighted_centroid(ends.to);
  for (const double t : {0.25, 0.6}) {
    EXPECT_LT((ends.series.weighted_centroid(morph.at(t)) - (1.0 - t) * start - t * end).norm(), 1e-13);
  }
}

TEST(Morph, IsTheWeightedSumOfItsTargets) {
  const Ends ends(cube());
  for (const MorphOrder order : kOrders) {
    const Morph morph(ends.series, ends.from, ends.to, {1, 3, order});
    for (const double t : {0.0, 0.2, 1.0 / 3.0, 0.9, 1.0}) {
      Values sum = morph.base();
      const std::vector<double> weights = morph.weights(t);
      for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * morph.targets()[i];
      EXPECT_LT((sum - morph.at(t)).cwiseAbs().maxCoeff(), 1e-14);
    }
  }
}

TEST(Morph, HasTheSameBitsForAnyNumberOfThreads) {
  const Ends ends(torus(80, 60));
  const auto middle = [&](int threads) {
    const ThreadLimit limit(threads);
    return Morph(ends.series, ends.from, ends.to).at(0.4);
  };
  EXPECT_TRUE(io_tests::same_bits(middle(1), middle(6)));
}

TEST(Morph, RefusesWhatDoesNotFit) {
  const Ends ends(cube());
  const auto fails = [](const std::function<void()>& body, const char* words) {
    io_tests::expect_error(body, ErrorCode::BadArgument, words);
  };
  fails([&] { Morph(ends.series, ends.from, ends.to, {-1}); }, "m must lie");
  fails([&] { Morph(ends.series, ends.from, ends.to, {1, 11}); }, "stages");
  fails([&] { Morph(ends.series, ends.from, ends.to).at(1.5); }, "[0, 1]");
  fails([&] { Morph(ends.series, ends.from, ends.to).at(std::nan("")); }, "[0, 1]");
  fails([&] { morph_sequence(ends.series, ends.from, ends.to, {1, 1.5}); }, "rho");
  io_tests::expect_error([&] { Morph(ends.series, ends.from.topRows(7), ends.to); }, ErrorCode::BadShape, "");
  io_tests::expect_error([&] { Morph(ends.series, ends.from, ends.to.leftCols(2)); }, ErrorCode::BadShape, "columns");
}

TEST(MorphSequence, HasTheFactorsOfThePaper) {
  const Mesh mesh = torus(7, 5);
  const Ends ends(mesh);
  Values points = ends.from - ends.to;
  const std::vector<Values> sequence = morph_sequence(ends.series, ends.from, ends.to, {2, 0.7, 4, false});
  ASSERT_EQ(sequence.size(), 5U);
  EXPECT_TRUE(io_tests::same_bits(sequence[0], ends.from));
  const Eigen::MatrixXd matrix = ends.series.limit_matrix().matrix();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
  const Eigen::MatrixXd rest = unit - matrix;
  const Eigen::MatrixXd smoothing = unit - rest * rest * rest;
  for (int k = 1; k <= 4; ++k) {
    points = 0.7 * smoothing * points;
    EXPECT_LT((sequence[static_cast<std::size_t>(k)] - ends.to - points).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(MorphSequence, ReachesTheEndForRhoOneWhereCentroidsAreAligned) {
  const Ends ends(test::bipyramid(5));
  const Values aligned = morph_sequence(ends.series, ends.from, ends.to, {1, 1.0, 400, true}).back();
  EXPECT_LT((aligned - ends.to).cwiseAbs().maxCoeff(), 1e-9);
  const Values offset = ends.series.weighted_centroid(ends.from - ends.to);
  const Values stuck = morph_sequence(ends.series, ends.from, ends.to, {1, 1.0, 400, false}).back();
  EXPECT_LT(((stuck - ends.to).rowwise() - Eigen::RowVectorXd(offset.row(0))).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MorphSurface, IsTheSurfaceOfTheMorphAtEveryTime) {
  for (const Mesh& mesh : shapes()) {
    const Ends ends(mesh);
    const Morph morph(ends.series, ends.from, ends.to, {1, 3});
    const MovingSurface animated = morph_surface(ends.topology, {}, mesh, morph, 2, 6, 2.0);
    EXPECT_EQ(animated.targets.times.front(), 0.0);
    EXPECT_EQ(animated.targets.times.back(), 2.0);
    ASSERT_EQ(animated.targets.times.size(), 7U);  // the knots are among the frames
    for (std::size_t k = 0; k < animated.targets.times.size(); ++k) {
      Mesh control = mesh;
      control.points = morph.at(animated.targets.times[k] / 2.0);
      const Mesh surface = surface_mesh(ends.topology, {}, control, 2);
      Points points = animated.mesh.points;
      for (std::size_t i = 0; i < animated.targets.displacements.size(); ++i) {
        points += animated.targets.weights(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) *
                  animated.targets.displacements[i];
      }
      EXPECT_LT((points - surface.points).cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

TEST(MorphSurface, HasExactNormalsAtTheKnots) {
  const Mesh mesh = torus(9, 7);
  const Ends ends(mesh);
  const Morph morph(ends.series, ends.from, ends.to, {1, 3, MorphOrder::LowLast});
  const MovingSurface animated = morph_surface(ends.topology, {}, mesh, morph, 1, 3, 1.0);
  for (std::size_t k = 0; k < animated.targets.times.size(); ++k) {
    Mesh control = mesh;
    control.points = morph.at(animated.targets.times[k]);
    const Values exact = surface_mesh(ends.topology, {}, control, 1).attributes.back().values;
    Values normals = animated.mesh.attributes.back().values;
    for (std::size_t i = 0; i < animated.targets.normals.size(); ++i) {
      normals += animated.targets.weights(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) *
                 animated.targets.normals[i];
    }
    EXPECT_LT((normals - exact).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Resample, GivesASurfaceItselfAgain) {
  // A sphere-like surface and its own refinement: the same surface with other faces.
  const Mesh coarse = icosahedron();
  const Topology target(coarse);
  const Scheme loop{SchemeKind::Loop};
  const RefinedSurface fine = refine(target, loop, coarse.points, 2);
  const Resampled found = resample(fine.topology, loop, fine.values, target, loop, coarse.points);
  EXPECT_LT(found.max_distance, 1e-9);
  EXPECT_LT((found.control - fine.values).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_EQ(found.folded_faces, 0);
}

TEST(Resample, PutsLimitPositionsOnTheOtherSurface) {
  const Mesh source = torus(20, 12, 1.02, 0.41);
  const Mesh target = torus(16, 10);
  const Topology from(source);
  const Topology to(target);
  const Resampled found = resample(from, {}, source.points, to, {}, target.points);
  const Values limit = LimitMatrix(from, {}).apply(found.control);
  const NearestPoints nearest(to, {}, target.points);
  for (Index v = 0; v < source.vertex_count(); ++v) {
    EXPECT_LT(nearest.nearest(Eigen::Vector3d(limit.row(v).transpose())).distance, 1e-8);
  }
  EXPECT_GT(found.mean_distance, 1e-4);
  EXPECT_EQ(found.folded_faces, 0);
}

TEST(Resample, RefusesSurfacesThatAreFarApart) {
  const Mesh mesh = torus(9, 7);
  const Topology topology(mesh);
  Points far = mesh.points;
  far.col(0).array() += 5.0;
  io_tests::expect_error([&] { resample(topology, {}, far, topology, {}, mesh.points); }, ErrorCode::BadArgument,
                         "of its diagonal");
}

}  // namespace
}  // namespace batten
