/// The surface through the spokes' ends, and Thall's metrics on it.
#include "batten/medial/medial_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "batten/limit/limit_matrix.h"
#include "batten/medial/medial_check.h"
#include "batten/medial/medial_io.h"
#include "batten/tessellate/surface_mesh.h"
#include "medial/medial_shapes.h"

namespace batten {
namespace {

void expect_reached(const MedialModel& model, double tolerance) {
  const MedialSurface made = medial_surface(model);
  EXPECT_TRUE(made.surface.converged());
  const double diagonal = bounding_diagonal(made.boundary.mesh.points);
  EXPECT_LT(made.errors.distance.max, tolerance * diagonal);
  // Once more by tessellation: vertex i of the surface's mesh is vertex i of the control mesh, on the limit surface.
  const Mesh fine = surface_mesh(made.surface.topology, made.surface.scheme, made.surface.mesh, 1);
  const Eigen::Index count = made.boundary.mesh.points.rows();
  EXPECT_LT((fine.points.topRows(count) - made.boundary.mesh.points).rowwise().norm().maxCoeff(), tolerance * diagonal);
  EXPECT_GT(test::volume_of(fine), 0.0);
}

TEST(MedialSurface, ReachesEverySpokesEnd) {
  expect_reached(test::slab(2, 2), 1e-10);
  expect_reached(test::slab(5, 9), 1e-10);
  expect_reached(test::ellipse(4, 1), 1e-10);
  expect_reached(test::ellipse(24, 3), 1e-10);
}

TEST(MedialSurface, ReachesEverySpokesEndOfARealSrep) {
  const char* data = std::getenv("BATTEN_DATA");
  if (data == nullptr) GTEST_SKIP() << "set BATTEN_DATA to the folder of test data";
  const MedialModel model = read_medial(std::string(data) + "/medial/bent.srep.json");
  expect_reached(model, 1e-10);
  const MedialSurface made = medial_surface(model);
  const Topology& topology = made.surface.topology;
  EXPECT_EQ(topology.vertex_count() - topology.edge_count() + topology.face_count(), 2);
  for (Index edge = 0; edge < topology.edge_count(); ++edge) EXPECT_FALSE(topology.is_boundary_edge(edge));
  EXPECT_GT(test::volume_of(made.boundary.mesh), 0.0);
}

TEST(MedialSurface, AttributesPassThroughTheirValues) {
  const MedialSurface made = medial_surface(test::ellipse(12, 2));
  const LimitMatrix limit(made.surface.topology, made.surface.scheme);
  ASSERT_EQ(made.surface.mesh.attributes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Values reached = limit.apply(made.surface.mesh.attributes[i].values);
    EXPECT_LT((reached - made.boundary.mesh.attributes[i].values).cwiseAbs().maxCoeff(), 1e-8);
  }
}

/// The atoms of exact normals fit the surface in Blum's sense, as the paper says.
TEST(MedialSurface, TurnedToItsSpokesFitsItsAtoms) {
  MedialSurface made = medial_surface(test::ellipse(12, 2));
  const VertexMeasure before = made.errors.angle;
  const double shift = made.errors.shift.max;
  const TurnReport report = turn_to_spokes(made);
  EXPECT_GT(before.max, 0.01);
  EXPECT_NEAR(report.before_angle.max, before.max, 1e-12);
  EXPECT_LT(made.errors.angle.max, 1e-12);
  EXPECT_LT(made.errors.distance.max, 1e-10);
  EXPECT_LT(made.errors.shift.max, shift);
  // Its attributes still pass through their values.
  const LimitMatrix limit(made.surface.topology, made.surface.scheme);
  for (std::size_t i = 0; i < made.surface.mesh.attributes.size(); ++i) {
    const Values& values = made.boundary.mesh.attributes[i].values;
    const Values reached = limit.apply(made.surface.mesh.attributes[i].values).topRows(values.rows());
    EXPECT_LT((reached - values).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(MedialErrors, FollowARigidMotion) {
  const MedialModel model = test::ellipse(12, 2);
  MedialModel moved = model;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  MedialFigure& figure = moved.figures.front();
  const Eigen::RowVector3d shift(3.0, -4.0, 5.0);
  figure.sheet.points = ((figure.sheet.points * turn.transpose()).rowwise() + shift).eval();
  figure.up = (figure.up * turn.transpose()).eval();
  figure.down = (figure.down * turn.transpose()).eval();
  for (CrestSpoke& crest : figure.crest) {
    crest.origin = turn * crest.origin + shift.transpose();
    crest.spoke = turn * crest.spoke;
  }
  const MedialErrors before = medial_surface(model).errors;
  const MedialErrors after = medial_surface(moved).errors;
  EXPECT_LT((before.angles - after.angles).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(before.shift.max, after.shift.max, 1e-7);
  EXPECT_GT(before.angle.max, 1e-3);
}

/// On a surface that its sheet's plane mirrors, the atom that fits both normals is where they meet. With such atoms
/// nothing is left to measure but the crest.
TEST(MedialErrors, VanishForAtomsThatFitTheSurface) {
  MedialSurface made = medial_surface(test::slab(4, 7));
  MedialBoundary& boundary = made.boundary;
  const Topology& topology = made.surface.topology;
  const Values normals = limit_normals(topology, made.surface.scheme, made.surface.mesh.points).vertices;
  EXPECT_GT(made.errors.shift.max, 1e-4);
  for (const SpokePair& pair : spoke_pairs(boundary)) {
    for (const Index vertex : {pair.up, pair.down}) {
      const double radius = boundary.mesh.points(vertex, 2) / normals(vertex, 2);
      boundary.radii(vertex) = radius;
      boundary.directions.row(vertex) = normals.row(vertex);
      boundary.origins.row(vertex) = boundary.mesh.points.row(vertex) - radius * normals.row(vertex);
    }
  }
  const MedialErrors errors = measure_medial_errors(boundary, topology, made.surface.scheme, made.surface.mesh.points);
  // The surface is mirrored as exactly as it is interpolated: to 1e-10 of a size of 5.
  EXPECT_LT(errors.shift.max, 1e-8);
  for (const SpokePair& pair : spoke_pairs(boundary)) EXPECT_LT(errors.angles(pair.up), 1e-8);
  // Spokes of the right directions that are all too short: the fitted atom is the same, with a scale of 2.
  boundary.radii *= 0.5;
  const MedialErrors halved = measure_medial_errors(boundary, topology, made.surface.scheme, made.surface.mesh.points);
  EXPECT_LT(halved.shift.max, 1e-8);
}

/// A spoke turned by an angle within the atom's plane is off by about that angle more or less.
TEST(MedialErrors, AngleIsThatOfTheSpoke) {
  const MedialSurface made = medial_surface(test::slab(4, 7));
  MedialBoundary turned = made.boundary;
  const Values normals = limit_normals(made.surface.topology, made.surface.scheme, made.surface.mesh.points).vertices;
  const Eigen::Vector3d normal = normals.row(10).transpose();
  turned.directions.row(10) = (Eigen::AngleAxisd(0.3, normal.unitOrthogonal()) * normal).transpose();
  const MedialErrors errors =
      measure_medial_errors(turned, made.surface.topology, made.surface.scheme, made.surface.mesh.points);
  EXPECT_NEAR(errors.angles(10), 0.3, 1e-12);
}

TEST(MedialErrors, FallAsTheAtomsComeCloser) {
  // Atoms in Blum's sense: the finer they sample it, the better the surface's normals fit the spokes in the middle.
  const auto middle_angle = [](Index n) {
    const MedialSurface made = medial_surface(test::slab(4 * n + 1, 8 * n + 1));
    return made.errors.angles((2 * n) * (8 * n + 1) + 4 * n + n);
  };
  EXPECT_LT(middle_angle(4), 0.3 * middle_angle(2));
}

}  // namespace
}  // namespace batten
