/// Figures that hinges join.
#include <gtest/gtest.h>

#include "batten/medial/medial_surface.h"
#include "medial/medial_shapes.h"
#include "mesh/manifold.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::expect_error;

/// Two slabs of 3 by 5 atoms, the second beside the end of the first.
MedialModel two_slabs() {
  MedialModel model = test::slab(3, 5);
  MedialFigure second = test::slab(3, 5).figures.front();
  second.sheet.points.col(0).array() += 5.5;
  for (CrestSpoke& crest : second.crest) crest.origin.x() += 5.5;
  model.figures.push_back(std::move(second));
  return model;
}

const std::vector<Index> kEnd{4, 9, 14};
const std::vector<Index> kStart{0, 5, 10};

void expect_one_ball(const MedialModel& model, Index vertices) {
  const MedialBoundary boundary = medial_boundary(model);
  EXPECT_EQ(boundary.mesh.vertex_count(), vertices);
  const test::ManifoldReport report = test::examine(boundary.mesh);
  ASSERT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.boundary_loop_count, 0);
  EXPECT_EQ(report.component_count, 1);
  EXPECT_EQ(report.euler, 2);
  EXPECT_GT(report.volume, 0.0);
  const MedialSurface made = medial_surface(model);
  EXPECT_LT(made.errors.distance.max, 1e-10 * bounding_diagonal(boundary.mesh.points));
}

TEST(Hinge, JoinsTwoEdges) {
  MedialModel model = two_slabs();
  EXPECT_EQ(medial_boundary(model).mesh.vertex_count(), 84);
  model.hinges.push_back({{1, kStart, {}, SpokeSide::Up}, {0, kEnd, {}, SpokeSide::Up}});
  // The crest in the middle of each edge is no longer on the surface.
  expect_one_ball(model, 82);
  const MedialBoundary boundary = medial_boundary(model);
  const Mesh& mesh = boundary.mesh;
  for (Index face = 0; face < mesh.face_count(); ++face) EXPECT_EQ(mesh.face_size(face), 4);
  // Two openings of eight vertices that mirror each other: the ring comes last, and its faces lead straight across.
  for (Index face = mesh.face_count() - 8; face < mesh.face_count(); ++face) {
    const Index* corners = mesh.face_vertices.data() + mesh.face_offsets[face];
    EXPECT_LT((mesh.points.row(corners[1]) - mesh.points.row(corners[2])).tail(2).norm(), 1e-12);
    EXPECT_LT((mesh.points.row(corners[3]) - mesh.points.row(corners[0])).tail(2).norm(), 1e-12);
  }
}

TEST(Hinge, JoinsAnEdgeToFacesOfTheSheet) {
  MedialModel model = two_slabs();
  // The four faces around atom 6 of the first slab, on its upper side; atom 6 ends inside.
  model.hinges.push_back({{1, kStart, {}, SpokeSide::Up}, {0, {}, {0, 1, 4, 5}, SpokeSide::Up}});
  expect_one_ball(model, 84 - 1 - 1);
}

TEST(Hinge, JoinsOpeningsOfDifferentSizesByTriangles) {
  MedialModel model = two_slabs();
  model.hinges.push_back({{1, kStart, {}, SpokeSide::Up}, {0, {}, {0, 1, 2}, SpokeSide::Down}});
  expect_one_ball(model, 83);
  model.hinges.front().parent.faces = {0};
  expect_one_ball(model, 83);
}

TEST(Hinge, NamesWhatItCannotOpen) {
  const auto expect = [](const HingePlace& child, const HingePlace& parent, const std::string& part) {
    MedialModel model = two_slabs();
    model.hinges.push_back({child, parent});
    expect_error([&] { medial_boundary(model); }, ErrorCode::BadArgument, part);
  };
  const HingePlace sound{0, kEnd, {}, SpokeSide::Up};
  expect({1, {0, 10}, {}, SpokeSide::Up}, sound, "hinge 0: its atoms are not neighbours");
  expect({1, {0, 1}, {0}, SpokeSide::Up}, sound, "hinge 0: give either");
  expect({1, {}, {}, SpokeSide::Up}, sound, "hinge 0: give either");
  expect({1, {}, {99}, SpokeSide::Up}, sound, "hinge 0: its atoms are not");
  expect({1, {}, {0, 3}, SpokeSide::Up}, sound, "hinge 0: its place is not one piece");
  expect({0, kEnd, {}, SpokeSide::Up}, sound, "hinge 0: another hinge opens the same place");
  MedialModel model = two_slabs();
  model.hinges.push_back({sound, {7, kEnd, {}, SpokeSide::Up}});
  expect_error([&] { medial_boundary(model); }, ErrorCode::IndexOutOfRange, "no figure 7");
}

}  // namespace
}  // namespace batten
