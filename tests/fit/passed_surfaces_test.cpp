#include <gtest/gtest.h>

#include "batten/fit/fit_run.h"
#include "batten/fit/start_sphere.h"
#include "batten/mesh/primitives.h"

namespace batten {
namespace {

/// A sphere of 98 control points, and the same with one of them pushed through the opposite side.
struct TwoSurfaces {
  Mesh whole = start_sphere(cube().points, SchemeKind::CatmullClark);
  Points folded = whole.points;
  SurfaceFitter fitter;

  TwoSurfaces() : fitter(Topology(whole), Scheme(), whole.points, {whole.points, whole.points.rowwise().normalized()}) {
    folded.row(0) *= -9.0;
  }
};

TEST(PassedSurfaces, SoundOnesGoBeforeNearerOnes) {
  TwoSurfaces two;
  ASSERT_EQ(two.fitter.unsound_faces(), 0);
  ASSERT_GT(two.fitter.unsound_faces(two.folded), 0);
  PassedSurfaces passed(0);
  EXPECT_EQ(passed.best(two.fitter), nullptr);
  passed.note({two.folded, 0.1});
  passed.note({two.whole.points, 0.3});
  passed.note({2.0 * two.whole.points, 0.2});
  ASSERT_NE(passed.best(two.fitter), nullptr);
  EXPECT_EQ(passed.best(two.fitter)->rms, 0.2);
  passed.note({two.whole.points, 0.15});
  EXPECT_EQ(passed.best(two.fitter)->rms, 0.15);
}

TEST(PassedSurfaces, AllowedFacesCountAsNone) {
  TwoSurfaces two;
  PassedSurfaces passed(two.fitter.unsound_faces(two.folded));
  passed.note({two.whole.points, 0.3});
  passed.note({two.folded, 0.1});
  EXPECT_EQ(passed.best(two.fitter)->rms, 0.1);
}

}  // namespace
}  // namespace batten
