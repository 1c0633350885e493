/// One operator, asked by many threads at once, from oneTBB tasks of the caller's own, while it is fresh.
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "batten/expand/mesh_series.h"
#include "batten/interpolate/interpolator.h"
#include "batten/mesh/primitives.h"
#include "batten/nearest/nearest_point.h"
#include "batten/refine/refined_mesh.h"
#include "batten/tessellate/tessellator.h"
#include "parallel/caller_tasks.h"

namespace batten {
namespace {

constexpr int kTasks = 8;

/// Pentagons refined: quads, and vertices of valence 3, 4 and 5.
Mesh refined_dodecahedron(int levels) {
  return refine_mesh(Topology(dodecahedron()), Scheme(), dodecahedron(), levels).mesh;
}

Values answer_of(const Tessellator& tessellator, const Points& points) {
  Values grid(tessellator.vertex_count(), 3);
  Values normals(tessellator.vertex_count(), 3);
  tessellator.limit<double>(points, {grid.data(), static_cast<std::size_t>(grid.size())},
                            {normals.data(), static_cast<std::size_t>(normals.size())});
  grid += normals;
  return grid;
}

Values answer_of(const Interpolator& interpolator, const Points& points) { return interpolator.solve(points).control; }

Values answer_of(const MeshSeries& series, const Points& points) { return series.smooth(points, 2, 4); }

Values answer_of(const NearestPoints& nearest, const Points& points) {
  std::vector<NearestPoint> found(static_cast<std::size_t>(points.rows()));
  const Points queries = 1.1 * points;
  nearest.nearest(queries, found);
  Values places(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) places.row(i) = found[static_cast<std::size_t>(i)].point;
  return places;
}

/// Asks a fresh operator in every task and compares with what one thread alone gets from another.
template <typename Make>
void expect_the_same_from_every_task(const Mesh& mesh, const Make& make) {
  const Topology topology(mesh);
  const auto alone = make(topology, mesh.points);
  const Values expected = answer_of(alone, mesh.points);
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto fresh = make(topology, mesh.points);
    std::atomic<int> different = 0;
    run_in_tasks(kTasks, [&](int) {
      const Values got = answer_of(fresh, mesh.points);
      different += got.rows() == expected.rows() && got == expected ? 0 : 1;
    });
    EXPECT_EQ(different, 0);
  }
}

TEST(SharedOperators, AFreshTessellatorAnswersManyTasksAtOnce) {
  // Enough faces for several blocks in all that the first answer makes and keeps.
  expect_the_same_from_every_task(refined_dodecahedron(5), [](const Topology& topology, const Points&) {
    return Tessellator(topology, Scheme(), 1);
  });
}

TEST(SharedOperators, AnInterpolatorAnswersManyTasksAtOnce) {
  expect_the_same_from_every_task(refined_dodecahedron(3), [](const Topology& topology, const Points&) {
    return Interpolator(topology, Scheme());
  });
}

TEST(SharedOperators, AMeshSeriesAnswersManyTasksAtOnce) {
  expect_the_same_from_every_task(
      refined_dodecahedron(3), [](const Topology& topology, const Points&) { return MeshSeries(topology, Scheme()); });
}

TEST(SharedOperators, NearestPointsAnswerManyTasksAtOnce) {
  expect_the_same_from_every_task(refined_dodecahedron(3), [](const Topology& topology, const Points& points) {
    return NearestPoints(topology, Scheme(), points);
  });
}

}  // namespace
}  // namespace batten
