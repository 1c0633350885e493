#include "batten/surface/curvature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::scheme_of;

/// Every sample mesh by every scheme that takes it, some with random tags.
template <typename Visit>
void for_each_surface(const Visit& visit) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name.find("dihedron") != std::string::npos) continue;  // folded: no normals at valence 2
    for (const unsigned seed : {0U, 1U}) {
      Mesh mesh = test::jittered(sample.mesh, 0.05, 11);
      if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
      for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
        if (kind == SchemeKind::Loop && !all_triangles(mesh)) continue;
        SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
        visit(mesh, scheme_of(kind));
      }
    }
  }
}

TEST(Curvature, RefinedVerticesLieWhereTheirPlacesAre) {
  for_each_surface([](const Mesh& mesh, const Scheme& scheme) {
    const Topology topology(mesh);
    const LimitSurface surface(topology, scheme, mesh.points);
    for (int levels = 0; levels <= 3; ++levels) {
      const RefinedSurface refined = refine(topology, scheme, mesh.points, levels);
      const Scheme last = levels > 0 ? scheme.after_first_step() : scheme;
      const Values limit = LimitMatrix(refined.topology, last).apply(refined.values);
      const Buffer<SurfacePlace> places = vertex_places(surface, refined.topology);
      for (Index v = 0; v < refined.topology.vertex_count(); ++v) {
        if (refined.topology.is_isolated(v)) {
          EXPECT_EQ(places[v].face, -1);
          continue;
        }
        EXPECT_LE((surface.jet(places[v]).point.transpose() - limit.row(v)).norm(), 1e-13)
            << "vertex " << v << " of level " << levels;
      }
    }
  });
}

TEST(Curvature, IsThatOfTheSurfaceAndAMeanWhereItHasNone) {
  for_each_surface([](const Mesh& mesh, const Scheme& scheme) {
    const Topology topology(mesh);
    const LimitSurface surface(topology, scheme, mesh.points);
    const RefinedSurface refined = refine(topology, scheme, mesh.points, 2);
    const Buffer<SurfacePlace> places = vertex_places(surface, refined.topology);
    const Curvature found = limit_curvature(surface, refined.topology);
    for (Index v = 0; v < refined.topology.vertex_count(); ++v) {
      if (refined.topology.is_isolated(v)) {
        EXPECT_TRUE(std::isnan(found.mean[v]));
        continue;
      }
      const PointCurvature exact = curvature_of(surface.jet(places[v]));
      if (!std::isnan(exact.mean)) {
        EXPECT_EQ(found.mean[v], exact.mean);
        EXPECT_EQ(found.gaussian[v], exact.gaussian);
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      double most = -least;
      refined.topology.for_each_outgoing(v, [&](Index h) {
        const double around = curvature_of(surface.jet(places[refined.topology.destination(h)])).mean;
        if (std::isnan(around)) return;
        least = std::min(least, around);
        most = std::max(most, around);
      });
      if (least > most) continue;  // none around either
      EXPECT_GE(found.mean[v], least - 1e-12 * std::abs(least)) << "vertex " << v;
      EXPECT_LE(found.mean[v], most + 1e-12 * std::abs(most)) << "vertex " << v;
    }
  });
}

TEST(Curvature, ConvergesToThatOfATorus) {
  // The surface of a finer and finer torus mesh tends to the torus: 1/r across, and outside 1/(R + r) around.
  double before = 0.0;
  for (const Index n : {16, 32, 64}) {
    const Mesh mesh = torus(2 * n, n, 1.0, 0.4);
    const Topology topology(mesh);
    const Curvature found = limit_curvature(LimitSurface(topology, {}, mesh.points), topology);
    double error = 0.0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double out = std::hypot(mesh.points(v, 0), mesh.points(v, 1));
      const double around = (out - 1.0) / 0.4 / out;
      error = std::max(error, std::abs(found.mean[v] - 0.5 * (around + 1.0 / 0.4)));
      error = std::max(error, std::abs(found.gaussian[v] - around / 0.4));
    }
    if (before > 0.0) {
      EXPECT_GT(before / error, 3.5) << n;
    }
    before = error;
  }
}

TEST(Curvature, RefusesAMeshThatIsNoRefinement) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const LimitSurface surface(topology, {}, mesh.points);
  const Mesh other = torus(5, 5);
  EXPECT_THROW(vertex_places(surface, Topology(other)), Error);
}

}  // namespace
}  // namespace batten
