/// The mesh of spoke ends, and what the checks say of the spokes.
#include "batten/medial/medial_boundary.h"

#include <gtest/gtest.h>

#include "batten/medial/medial_check.h"
#include "medial/medial_shapes.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::expect_error;

/// V - E + F of a closed mesh.
Index euler_number(const Topology& topology) {
  return topology.vertex_count() - topology.edge_count() + topology.face_count();
}

bool is_closed(const Topology& topology) {
  for (Index edge = 0; edge < topology.edge_count(); ++edge) {
    if (topology.is_boundary_edge(edge)) return false;
  }
  return true;
}

void expect_closed_ball(const MedialModel& model) {
  const MedialBoundary boundary = medial_boundary(model);
  const Topology topology(boundary.mesh);
  EXPECT_TRUE(is_closed(topology));
  EXPECT_EQ(euler_number(topology), 2);
  EXPECT_GT(test::volume_of(boundary.mesh), 0.0);
}

TEST(MedialBoundary, IsClosedOfGenusZeroAndOutward) {
  expect_closed_ball(test::slab(4, 6));
  expect_closed_ball(test::slab(2, 2));
  expect_closed_ball(test::ellipse(12, 2));
  expect_closed_ball(test::ellipse(4, 1));
}

TEST(MedialBoundary, IsOutwardWhicheverWayTheSheetTurns) {
  MedialModel model = test::ellipse(12, 2);
  MedialFigure& figure = model.figures.front();
  std::swap(figure.up, figure.down);
  expect_closed_ball(model);
}

TEST(MedialBoundary, VerticesAreTheEndsOfTheSpokes) {
  const MedialModel model = test::slab(3, 4);
  const MedialFigure& figure = model.figures.front();
  const MedialBoundary boundary = medial_boundary(model);
  ASSERT_EQ(boundary.mesh.vertex_count(), 12 + 12 + 10);
  for (Index atom = 0; atom < 12; ++atom) {
    EXPECT_EQ(boundary.mesh.points.row(atom), figure.sheet.points.row(atom) + figure.up.row(atom));
    EXPECT_EQ(boundary.mesh.points.row(12 + atom), figure.sheet.points.row(atom) + figure.down.row(atom));
    EXPECT_EQ(boundary.ends[static_cast<std::size_t>(12 + atom)].side, SpokeSide::Down);
  }
  for (Index i = 0; i < 10; ++i) {
    const CrestSpoke& crest = figure.crest[static_cast<std::size_t>(i)];
    EXPECT_EQ(boundary.mesh.points.row(24 + i), (crest.origin + crest.spoke).transpose());
  }
}

TEST(MedialBoundary, CarriesPlacesSidesAndRadii) {
  const MedialModel model = test::ellipse(8, 2);
  const SpineGrid grid = *model.figures.front().grid;
  const MedialBoundary boundary = medial_boundary(model);
  const Values& medial = boundary.mesh.attributes.front().values;
  EXPECT_EQ(boundary.mesh.attributes.front().name, "medial");
  // Lines 1 and 7 start at the second point of the spine, on its two sides; line 4 goes on from its end.
  EXPECT_EQ(medial.row(grid.atom(1, 0)), Eigen::RowVector3d(1.0, 0.0, 1.0));
  EXPECT_EQ(medial.row(grid.atom(7, 2)), Eigen::RowVector3d(1.0, -2.0, 1.0));
  EXPECT_EQ(medial.row(grid.atom(4, 2) + grid.atom_count()), Eigen::RowVector3d(6.0, 0.0, -1.0));
  EXPECT_EQ(boundary.mesh.attributes.back().name, "radius");
  EXPECT_EQ(boundary.mesh.attributes.back().values.col(0), boundary.radii);
}

TEST(MedialBoundary, SeveralFiguresAreSeveralComponents) {
  MedialModel model = test::slab(3, 4);
  model.figures.push_back(test::slab(3, 3).figures.front());
  model.figures.back().name = "second";
  model.figures.back().sheet.points.col(2).array() += 3.0;
  for (CrestSpoke& crest : model.figures.back().crest) crest.origin.z() += 3.0;
  const MedialBoundary boundary = medial_boundary(model);
  EXPECT_EQ(connected_components(Topology(boundary.mesh)).count, 2);
  ASSERT_EQ(boundary.mesh.groups.size(), 1U);
  EXPECT_EQ(boundary.mesh.groups.front().name, "second");
}

TEST(MedialBoundary, RefusesWhatIsNoModel) {
  MedialModel no_length = test::ellipse(8, 2);
  no_length.figures.front().up.row(no_length.figures.front().grid->atom(3, 1)).setZero();
  expect_error([&] { medial_boundary(no_length); }, ErrorCode::BadArgument,
               "line 3, step 1: the length of the up spoke");
  MedialModel no_crest = test::slab(3, 3);
  no_crest.figures.front().crest.pop_back();
  expect_error([&] { medial_boundary(no_crest); }, ErrorCode::BadArgument, "atom 8: is on the boundary");
  MedialModel inner_crest = test::slab(3, 3);
  inner_crest.figures.front().crest.push_back({4, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()});
  expect_error([&] { medial_boundary(inner_crest); }, ErrorCode::BadArgument, "atom 4");
  MedialModel nan = test::slab(3, 3);
  nan.figures.front().down(2, 1) = std::nan("");
  expect_error([&] { medial_boundary(nan); }, ErrorCode::NotFinite, "atom 2");
  MedialModel short_up = test::slab(3, 3);
  short_up.figures.front().up.conservativeResize(8, 3);
  expect_error([&] { medial_boundary(short_up); }, ErrorCode::BadShape, "spokes up");
}

/// The tilt of spokes in Blum's sense falls with the square of the spacing; spokes that lean stay tilted.
TEST(SpokeCheck, TiltFallsWithTheSquareOfTheSpacing) {
  const auto interior_tilt = [](Index n) {
    MedialBoundary boundary = medial_boundary(test::slab(n + 1, 2 * n + 1));
    return check_spokes(boundary).mean_tilt;
  };
  // The strips along the crest are as wide at any spacing, and their share of the edges falls with the spacing only.
  const double coarse = interior_tilt(8);
  const double fine = interior_tilt(16);
  EXPECT_LT(fine, 0.6 * coarse);
  MedialModel leaning = test::slab(9, 17);
  leaning.figures.front().up.col(0).array() += 0.2;
  EXPECT_GT(check_spokes(medial_boundary(leaning)).max_tilt, 0.2);
}

TEST(SpokeCheck, FindsUnequalLengths) {
  MedialModel model = test::slab(3, 3);
  EXPECT_LT(check_spokes(medial_boundary(model)).max_length_difference, 1e-15);
  model.figures.front().up.row(4) *= 3.0;
  const SpokeCheck check = check_spokes(medial_boundary(model));
  EXPECT_NEAR(check.max_length_difference, 1.0, 1e-12);
  EXPECT_EQ(check.length_vertex, 4);
  EXPECT_NEAR(check.mean_length_difference, 1.0 / 9.0, 1e-12);
}

TEST(SpokeCheck, FindsSpokesThatPassEachOther) {
  MedialModel model = test::slab(3, 5);
  EXPECT_TRUE(check_spokes(medial_boundary(model)).crossings.empty());
  // Atoms 6 and 7 are one apart along x; these spokes end on each other's side.
  model.figures.front().down.row(6) << 0.9, 0.0, -0.5;
  model.figures.front().down.row(7) << -0.9, 0.0, -0.5;
  const SpokeCheck check = check_spokes(medial_boundary(model));
  ASSERT_EQ(check.crossings.size(), 1U);
  EXPECT_EQ(check.crossings.front().first, 15 + 6);
  EXPECT_EQ(check.crossings.front().second, 15 + 7);
}

}  // namespace
}  // namespace batten
