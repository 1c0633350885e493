/// \file Queries, samples of the surface and what must hold of nearest points.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "batten/nearest/nearest_point.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/tessellator.h"
#include "support/shapes.h"

namespace batten::nearest_tests {

/// Points of the drawn surface on a uniform grid.
struct Samples {
  Buffer<double> points;  ///< three numbers each

  Samples(const Topology& topology, const Scheme& scheme, ConstValuesRef control, int levels, bool all_drawn = false) {
    const Tessellator tessellator(topology, scheme, levels);
    points.resize(3 * static_cast<std::size_t>(tessellator.vertex_count()));
    tessellator.limit<double>(control, points);
    if (all_drawn) return;
    Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) *
                        static_cast<std::size_t>(tessellator.face_size()));
    tessellator.faces(faces);
    const Buffer<double> all = std::move(points);
    points = Buffer<double>();
    for (const Index v : faces) points.insert(points.end(), {all[3 * v], all[3 * v + 1], all[3 * v + 2]});
  }
  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(points.size() / 3); }

  double nearest_distance(const Eigen::Vector3d& query) const {
    const auto least = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double squared = std::numeric_limits<double>::infinity();
      for (const double* p = &points[3 * begin]; p != points.data() + 3 * end; p += 3) {
        const double x = p[0] - query[0];
        const double y = p[1] - query[1];
        const double z = p[2] - query[2];
        squared = std::min(squared, x * x + y * y + z * z);
      }
      return squared;
    };
    return std::sqrt(parallel_reduce(
        count(), std::numeric_limits<double>::infinity(), least, [](double a, double b) { return std::min(a, b); },
        1 << 18));
  }
};

/// Queries around the mesh, half of them near its points.
inline Points random_queries(const Mesh& mesh, Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const double diagonal = bounding_diagonal(mesh.points);
  const Eigen::RowVector3d centre = mesh.points.colwise().mean();
  Points queries(count, 3);
  for (Index i = 0; i < count; ++i) {
    const Eigen::RowVector3d shift(normal(random), normal(random), normal(random));
    const auto vertex = static_cast<Index>(random() % static_cast<unsigned>(mesh.vertex_count()));
    queries.row(i) = i % 2 == 0 ? Eigen::RowVector3d(mesh.points.row(vertex) + 0.05 * diagonal * shift)
                                : Eigen::RowVector3d(centre + 0.5 * diagonal * shift);
  }
  return queries;
}

/// What is proved of the dihedron: its two sheets fold along their rim, where the surface has no tangent plane.
inline constexpr double kFoldTolerance = 1e-6;

/// What must hold of any answer: it is a point of the surface at its distance, no sample is nearer, and the proof
/// leaves no more than the tolerance open.
inline void expect_nearest(const Mesh& mesh, const Scheme& scheme, int levels, const Points& queries,
                           double tolerance = 0.0) {
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  const NearestPoints nearest(topology, scheme, mesh.points);
  const Samples samples(topology, scheme, mesh.points, levels);
  std::vector<NearestPoint> found(static_cast<std::size_t>(queries.rows()));
  nearest.nearest(queries, found);
  const double diagonal = bounding_diagonal(mesh.points);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    SCOPED_TRACE(i);
    const Eigen::Vector3d query = queries.row(i).transpose();
    const NearestPoint& answer = found[static_cast<std::size_t>(i)];
    EXPECT_LE((surface.jet(answer.place).point - answer.point).norm(), 1e-10 * diagonal);
    EXPECT_NEAR((query - answer.point).norm(), answer.distance, 1e-14 * (diagonal + query.norm()));
    EXPECT_LE(answer.distance, samples.nearest_distance(query) + nearest.tolerance());
    EXPECT_LE(answer.least_distance, answer.distance);
    EXPECT_LE(answer.distance - answer.least_distance, std::max(1.001 * nearest.tolerance(), tolerance));
  }
}

}  // namespace batten::nearest_tests
