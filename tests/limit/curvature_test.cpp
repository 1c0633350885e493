#include "batten/limit/curvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/interpolate/interpolator.h"
#include "batten/mesh/primitives.h"

namespace batten {
namespace {

constexpr double kRadius = 1.0;
constexpr double kTube = 0.4;

/// Each half-edge takes its vertex's normal.
Values at_corners(const Topology& topology, const Values& normals) {
  Values corners(topology.half_edge_count(), 3);
  for (Index h = 0; h < topology.half_edge_count(); ++h) corners.row(h) = normals.row(topology.origin(h));
  return corners;
}

/// A torus's own curvature at its vertices: cos v / (R + r cos v) around the axis, 1/r across.
struct TorusTruth {
  Values normals;
  Eigen::VectorXd mean;
  Eigen::VectorXd gaussian;
};

TorusTruth torus_truth(const Points& points) {
  TorusTruth truth{Values(points.rows(), 3), Eigen::VectorXd(points.rows()), Eigen::VectorXd(points.rows())};
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::RowVector3d p = points.row(i);
    const double out = std::hypot(p.x(), p.y());
    const Eigen::RowVector3d centre(kRadius * p.x() / out, kRadius * p.y() / out, 0.0);
    truth.normals.row(i) = (p - centre).normalized();
    const double around = (out - kRadius) / (p - centre).norm() / out;
    truth.mean[i] = 0.5 * (around + 1.0 / kTube);
    truth.gaussian[i] = around / kTube;
  }
  return truth;
}

double torus_error(Index around, Index across) {
  const Mesh mesh = torus(around, across, kRadius, kTube);
  const Topology topology(mesh);
  const TorusTruth truth = torus_truth(mesh.points);
  const Curvature found = estimate_curvature(topology, mesh.points, at_corners(topology, truth.normals));
  return std::max((found.mean - truth.mean).cwiseAbs().maxCoeff(),
                  (found.gaussian - truth.gaussian).cwiseAbs().maxCoeff());
}

TEST(Curvature, TorusConvergesWithTheSquareOfTheEdges) {
  const double coarse = torus_error(40, 20);
  const double fine = torus_error(80, 40);
  // The share of a turn between neighbours, squared, of the largest number (inside: 1 / (r (R - r))).
  EXPECT_LT(fine, std::pow(2.0 * std::numbers::pi / 80.0, 2.0) / (kTube * (kRadius - kTube)));
  EXPECT_GT(coarse / fine, 3.7);
  EXPECT_LT(coarse / fine, 4.3);
}

TEST(Curvature, SphereIsExactWhateverItsFaces) {
  // dn = dp / r holds for any two points of a sphere.
  for (Mesh mesh : {icosahedron(), dodecahedron(), cube()}) {
    const double radius = mesh.points.row(0).norm();
    const Topology topology(mesh);
    const Values normals = mesh.points / radius;
    const Curvature found = estimate_curvature(topology, mesh.points, at_corners(topology, normals));
    EXPECT_LT((found.mean.array() - 1.0 / radius).abs().maxCoeff(), 1e-12);
    EXPECT_LT((found.gaussian.array() - 1.0 / (radius * radius)).abs().maxCoeff(), 1e-12);
  }
}

TEST(Curvature, PlaneHasNoneAndACylinderOnlyAround) {
  Mesh mesh = grid(24, 6);
  const Topology topology(mesh);
  Values normals = Values::Zero(mesh.vertex_count(), 3);
  normals.col(2).setOnes();
  const Curvature flat = estimate_curvature(topology, mesh.points, at_corners(topology, normals));
  EXPECT_EQ(flat.mean.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(flat.gaussian.cwiseAbs().maxCoeff(), 0.0);
  // x of the grid becomes the angle; faces see the outside.
  constexpr double kCylinder = 2.5;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double angle = mesh.points(v, 0);
    normals.row(v) << std::sin(angle), 0.0, std::cos(angle);
    mesh.points.row(v) << kCylinder * std::sin(angle), mesh.points(v, 1), kCylinder * std::cos(angle);
  }
  const Curvature round = estimate_curvature(topology, mesh.points, at_corners(topology, normals));
  // Chords are shorter than arcs by the 24th part of their angle's square.
  const double tolerance = 0.5 / kCylinder * std::pow(2.0 / 24.0, 2.0);
  EXPECT_LT((round.mean.array() - 0.5 / kCylinder).abs().maxCoeff(), tolerance);
  EXPECT_LT(round.gaussian.cwiseAbs().maxCoeff(), tolerance);
}

TEST(Curvature, InterpolatedTorusHasTheTorusCurvature) {
  Mesh mesh = torus(40, 20, kRadius, kTube);
  mesh.points = interpolate(mesh).points;
  const Topology topology(mesh);
  const Scheme scheme;
  const RefinedSurface fine = refine(topology, scheme, mesh.points, 3);
  const Values points = LimitMatrix(fine.topology, scheme).apply(fine.values);
  const Curvature found =
      estimate_curvature(fine.topology, points, limit_normals(fine.topology, scheme, fine.values).corners);
  const TorusTruth truth = torus_truth(points);
  // A cubic spline through 20 points of a circle is off by about 2 % in its second derivative, h^2 / 12 twice.
  EXPECT_LT((found.mean - truth.mean).cwiseAbs().maxCoeff(), 0.04 / kTube);
  EXPECT_LT((found.gaussian - truth.gaussian).cwiseAbs().maxCoeff(), 0.08 / (kTube * kTube));
}

TEST(Curvature, CreasesKeepTheirSidesApart) {
  // Six flat faces: normals per corner are the faces' own, and nothing is curved.
  const Mesh mesh = cube();
  const Topology topology(mesh);
  Values normals(topology.half_edge_count(), 3);
  for (Index f = 0; f < topology.face_count(); ++f) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) sum += mesh.points.row(topology.origin(h));
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) normals.row(h) = sum.normalized();
  }
  const Curvature found = estimate_curvature(topology, mesh.points, normals);
  EXPECT_EQ(found.mean.cwiseAbs().maxCoeff(), 0.0);
}

TEST(Curvature, NoNormalNoCurvature) {
  Mesh mesh = grid(2, 2);
  mesh.points.conservativeResize(10, 3);
  mesh.points.row(9).setZero();
  const Topology topology(mesh);
  Values normals = Values::Zero(topology.half_edge_count(), 3);
  EXPECT_TRUE(std::isnan(estimate_curvature(topology, mesh.points, normals).mean[0]));
  normals.col(2).setOnes();
  const Curvature found = estimate_curvature(topology, mesh.points, normals);
  EXPECT_EQ(found.mean[4], 0.0);
  EXPECT_TRUE(std::isnan(found.mean[9]));
}

}  // namespace
}  // namespace batten
