/// Finer sheets through the atoms given.
#include "batten/medial/medial_refinement.h"

#include <gtest/gtest.h>

#include "batten/medial/medial_io.h"
#include "batten/medial/medial_surface.h"
#include "io/io_test_tools.h"
#include "medial/medial_shapes.h"
#include "support/errors.h"

namespace batten {
namespace {

TEST(MedialRefinement, KeepsTheAtomsGiven) {
  const MedialModel slab = test::slab(3, 4);
  const MedialFigure fine = refine_medial(slab, 2).figures.front();
  EXPECT_EQ(fine.atom_count(), 9 * 13);
  EXPECT_EQ(fine.sheet.points.topRows(12), slab.figures.front().sheet.points);
  EXPECT_EQ(fine.up.topRows(12), slab.figures.front().up);
  const MedialModel ellipse = test::ellipse(8, 2);
  const MedialFigure doubled = refine_medial(ellipse, 1).figures.front();
  ASSERT_TRUE(doubled.grid);
  EXPECT_EQ(doubled.grid->crest_points, 16);
  EXPECT_EQ(doubled.grid->steps, 4);
  const SpineGrid& old = *ellipse.figures.front().grid;
  for (Index line = 0; line < 8; ++line) {
    for (Index step = 0; step <= 2; ++step) {
      const Index from = old.atom(line, step);
      const Index to = doubled.grid->atom(2 * line, 2 * step);
      EXPECT_EQ(doubled.down.row(to), ellipse.figures.front().down.row(from));
      EXPECT_EQ(doubled.sheet.points.row(to), ellipse.figures.front().sheet.points.row(from));
    }
  }
}

/// Places on the sheet, and with them spokes, are linear along the lines of the grid inside; interpolated values of a
/// linear function are exact away from the corners of the sheet.
TEST(MedialRefinement, IsExactForAFlatEvenSheet) {
  const MedialFigure fine = refine_medial(test::slab(5, 9), 1).figures.front();
  for (Index atom = 0; atom < fine.atom_count(); ++atom) {
    EXPECT_EQ(fine.sheet.points(atom, 2), 0.0);
    EXPECT_NEAR(fine.coordinates(atom, 0), 2.0 * fine.sheet.points(atom, 0) + 4.0, 1e-8);
  }
  EXPECT_EQ(fine.crest.size(), 48U);
}

/// New spokes are close to those of the radius function, and closer where the atoms are.
TEST(MedialRefinement, ApproachesTheRadiusFunction) {
  const auto worst = [](Index n) {
    const MedialFigure fine = refine_medial(test::slab(n + 1, 2 * n + 1), 1).figures.front();
    MedialFigure exact = fine;
    test::set_flat_spokes(exact, fine.sheet.points.leftCols(2));
    double most = 0.0;
    for (Index atom = 0; atom < fine.atom_count(); ++atom) {
      const Eigen::RowVector3d place = fine.sheet.points.row(atom);
      if (std::abs(place.x()) > 1.01 || std::abs(place.y()) > 0.51) continue;  // the edge converges more slowly
      most = std::max(most, (fine.up.row(atom) - exact.up.row(atom)).norm());
    }
    return most;
  };
  EXPECT_LT(worst(8), 0.25 * worst(4));
}

TEST(MedialRefinement, DoubledGridsAreModelsAgain) {
  const MedialModel fine = refine_medial(test::ellipse(8, 1), 2);
  EXPECT_EQ(fine.figures.front().grid->crest_points, 32);
  const MedialSurface made = medial_surface(fine);
  EXPECT_LT(made.errors.distance.max, 1e-9);
  EXPECT_GT(test::volume_of(made.boundary.mesh), 0.0);
  const io_tests::TemporaryFolder folder;
  write_medial(folder.path("fine.srep.json"), fine);
  EXPECT_EQ(read_medial(folder.path("fine.srep.json")).figures.front().up, fine.figures.front().up);
}

TEST(MedialRefinement, NoLevelIsTheModelItself) {
  const MedialModel model = test::slab(2, 2);
  EXPECT_EQ(refine_medial(model, 0).figures.front().up, model.figures.front().up);
  test::expect_error([&] { refine_medial(model, -1); }, ErrorCode::BadArgument, "levels");
}

TEST(SheetMesh, CarriesSpokesAndRadii) {
  MedialModel model = test::slab(3, 4);
  model.figures.push_back(test::slab(2, 2).figures.front());
  const Mesh sheet = sheet_mesh(model);
  EXPECT_EQ(sheet.vertex_count(), 16);
  EXPECT_EQ(sheet.face_count(), 7);
  ASSERT_EQ(sheet.attributes.size(), 4U);
  EXPECT_EQ(sheet.attributes[0].values.row(13), model.figures.back().up.row(1));
  EXPECT_NEAR(sheet.attributes[2].values(5, 0), model.figures.front().up.row(5).norm(), 1e-15);
}

}  // namespace
}  // namespace batten
