#include "batten/fit/surface_film.h"

#include <gtest/gtest.h>

#include "batten/fit/fit_surface.h"
#include "batten/mesh/primitives.h"
#include "batten/tessellate/surface_mesh.h"
#include "fit/clouds.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::CloudMaker;

/// A fit from 98 to 386 control points, and its film.
FitResult filmed(SurfaceFilm& film) {
  FitOptions options;
  options.start = FitStart::Sphere;
  options.vertices = 386;
  options.rounds = 3;
  options.watch = [&](const SurfaceFrame& frame) { film.add(frame); };
  return fit_surface({CloudMaker().torus(500, 1.0, 0.7), Points(0, 3)}, options);
}

TEST(SurfaceFilm, HasTheStartEachRoundAndTheResult) {
  SurfaceFilm film;
  const FitResult fit = filmed(film);
  EXPECT_EQ(film.size(), static_cast<Index>(fit.report.rounds.size()) + 2);
  EXPECT_EQ(film.frame(0).topology.vertex_count(), 98);
  for (std::size_t i = 0; i < fit.report.rounds.size(); ++i)
    EXPECT_EQ(film.frame(static_cast<Index>(i) + 1).topology.vertex_count(), fit.report.rounds[i].vertices);
  EXPECT_EQ(film.frame(film.size() - 1).control, fit.mesh.points);
}

/// Vertex i of a control mesh is vertex i of its refinement, and the surface is the same: so is its place.
TEST(SurfaceFilm, KeepsTheSurfaceOnTheLastMesh) {
  SurfaceFilm film;
  const FitResult fit = filmed(film);
  const SurfaceFrame& first = film.frame(0);
  const Mesh coarse = surface_mesh(first.topology, first.scheme, frame_mesh(first), 0);
  Mesh on_last = fit.mesh;
  on_last.points = film.on_last_mesh(0);
  const Mesh fine = surface_mesh(fit.topology, fit.scheme, on_last, 0);
  EXPECT_LT((fine.points.topRows(98) - coarse.points).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(SurfaceFilm, MovesFromTheFirstFrameToTheLast) {
  SurfaceFilm film;
  const FitResult fit = filmed(film);
  const MovingSurface moving = film.moving(10.0, 1);
  const auto shapes = static_cast<std::size_t>(film.size() - 1);
  ASSERT_EQ(moving.targets.displacements.size(), shapes);
  EXPECT_NEAR(moving.targets.times.back(), 0.1 * static_cast<double>(shapes), 1e-12);
  const Mesh end = surface_mesh(fit.topology, fit.scheme, fit.mesh, 1);
  EXPECT_LT((moving.mesh.points + moving.targets.displacements.back() - end.points).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(SurfaceFilm, BeginsAnewWithAnotherMesh) {
  SurfaceFilm film;
  const Mesh one = torus(8, 6);
  const Mesh other = torus(6, 8);
  film.add({Topology(one), Scheme(), one.points});
  film.add({Topology(one), Scheme(), one.points});
  EXPECT_EQ(film.size(), 2);
  film.add({Topology(other), Scheme(), other.points});
  EXPECT_EQ(film.size(), 1);
  EXPECT_EQ(film.on_last_mesh(0), other.points);
  test::expect_error([] { SurfaceFilm().moving(10.0, 1); }, ErrorCode::BadArgument, "frame");
  test::expect_error([&] { film.moving(0.0, 1); }, ErrorCode::BadArgument, "second");
}

}  // namespace
}  // namespace batten
