#include "batten/interpolate/attributes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "batten/error.h"
#include "batten/interpolate/interpolated_mesh.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/tessellate/surface_mesh.h"
#include "support/shapes.h"

namespace batten {
namespace {

Mesh colored(Mesh mesh) {
  const Values color = 0.5 + 0.5 * Values::Random(mesh.vertex_count(), 3).array();
  mesh.attributes = {{"color", color, {}}, {"radius", Values::Random(mesh.vertex_count(), 1), {}}};
  return mesh;
}

Mesh prepared(const Mesh& mesh, const Scheme& scheme, AttributeRule rule) {
  return prepare_attributes(Topology(mesh), scheme, mesh, {rule, {}}).mesh;
}

/// At the vertices given, of the diagonal of the values.
double farthest(const Mesh& surface, const Mesh& mesh, std::size_t attribute) {
  const Values& given = mesh.attributes[attribute].values;
  const Values differences = surface.attributes[attribute].values.topRows(given.rows()) - given;
  return differences.rowwise().norm().maxCoeff() / bounding_diagonal(given);
}

/// Closed and open, with creases and corners, under both schemes; the meshes that have such surfaces.
template <typename Visit>
void for_each_solvable(const Visit& visit) {
  test::for_each_sample([&](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    if (name.find("cube") == 0 || name.find("dihedron") == 0) return;  // two-colourable; valence 2
    for (const bool tagged : {false, true}) {
      SCOPED_TRACE(name + (tagged ? ", tagged" : ""));
      Mesh given = colored(mesh);
      if (tagged && mesh.face_count() > 8) {
        const Topology topology(mesh);
        for (Index i = 0; i < 3; ++i) {
          const Index h = topology.edge_half_edge(i);
          given.creases.push_back({topology.origin(h), topology.destination(h), kInfiniteSharpness});
        }
        given.corners = {{mesh.vertex_count() / 2, kInfiniteSharpness}};
      }
      visit(given, scheme);
    }
  });
}

TEST(Attributes, InterpolatedValuesAreExactAtTheVertices) {
  for_each_solvable([](const Mesh& mesh, const Scheme& scheme) {
    const PreparedAttributes solved =
        prepare_attributes(Topology(mesh), scheme, mesh, {AttributeRule::Interpolated, {}});
    ASSERT_EQ(solved.reports.size(), 2U);
    EXPECT_EQ(solved.reports[1].name, "radius");
    EXPECT_TRUE(solved.reports[0].converged() && solved.reports[1].converged());
    EXPECT_EQ(solved.mesh.points, mesh.points);
    for (const int levels : {0, 2}) {
      const Mesh surface = surface_mesh(Topology(mesh), scheme, solved.mesh, levels);
      EXPECT_LE(farthest(surface, mesh, 0), 1e-10);
      EXPECT_LE(farthest(surface, mesh, 1), 1e-10);
    }
  });
}

/// The least and the greatest value that a face's corners have.
std::pair<double, double> range_of(const Mesh& mesh, Index face, const Values& values) {
  double least = values(mesh.face_vertices[mesh.face_offsets[face]], 0);
  double most = least;
  for (Index c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
    least = std::min(least, values(mesh.face_vertices[c], 0));
    most = std::max(most, values(mesh.face_vertices[c], 0));
  }
  return {least, most};
}

TEST(Attributes, MidpointsStayAtTheVerticesAndWithinTheirFaces) {
  for_each_solvable([](const Mesh& mesh, const Scheme& scheme) {
    const Mesh ready = prepared(mesh, scheme, AttributeRule::Midpoint);
    const Values& given = mesh.attributes[1].values;
    for (const bool limit : {false, true}) {
      const Topology topology(mesh);
      const Mesh fine = limit ? surface_mesh(topology, scheme, ready, 2) : refine_mesh(topology, scheme, ready, 2).mesh;
      const Values& values = fine.attributes[1].values;
      EXPECT_EQ(values.topRows(given.rows()), given);
      // Children of a face stand together: as many as it has corners, and four of each.
      Index child = 0;
      for (Index f = 0; f < mesh.face_count(); ++f) {
        const auto [least, most] = range_of(mesh, f, given);
        const Index children = 4 * (scheme.kind == SchemeKind::Loop ? 4 : mesh.face_size(f));
        for (const Index end = child + children; child < end; ++child) {
          const auto [fine_least, fine_most] = range_of(fine, child, values);
          EXPECT_GE(fine_least, least - 1e-15);
          EXPECT_LE(fine_most, most + 1e-15);
        }
      }
      EXPECT_EQ(child, fine.face_count());
    }
  });
}

/// One value a vertex makes them continuous; halving the edges halves the greatest step along one.
TEST(Attributes, StepsOfMidpointsHalveWithTheEdges) {
  const Mesh mesh = prepared(colored(torus(7, 5)), {}, AttributeRule::Midpoint);
  const auto greatest_step = [&](int levels) {
    const Mesh fine = refine_mesh(Topology(mesh), {}, mesh, levels).mesh;
    const Topology topology(fine);
    double greatest = 0.0;
    for (Index e = 0; e < topology.edge_count(); ++e) {
      const Index h = topology.edge_half_edge(e);
      const Values& values = fine.attributes[1].values;
      greatest = std::max(greatest, std::abs(values(topology.origin(h), 0) - values(topology.destination(h), 0)));
    }
    return greatest;
  };
  EXPECT_NEAR(greatest_step(3) / greatest_step(2), 0.5, 1e-12);
}

TEST(Attributes, TheSchemeMovesThem) {
  const Mesh mesh = colored(torus(7, 5));
  const Mesh ready = prepared(mesh, {}, AttributeRule::Scheme);
  const Mesh surface = surface_mesh(Topology(mesh), {}, ready, 1);
  EXPECT_EQ(ready.attributes[0].values, mesh.attributes[0].values);
  EXPECT_GT(farthest(surface, mesh, 0), 0.01);
}

TEST(Attributes, WhereNoSurfaceHasThemTheNearestIsTaken) {
  Mesh mesh = cube();
  Values black_and_white(8, 1);
  for (Index v = 0; v < 8; ++v) black_and_white(v, 0) = mesh.points.row(v).prod() > 0.0 ? 1.0 : 0.0;
  mesh.attributes = {{"heat", black_and_white, {}}};
  AttributeOptions options{AttributeRule::Interpolated, {}};
  const PreparedAttributes solved = prepare_attributes(Topology(mesh), {}, mesh, options);
  EXPECT_EQ(solved.reports[0].outcome, Outcome::LeastSquares);
  EXPECT_NEAR(solved.reports[0].max_error, 0.5, 1e-9);
  options.solve.on_singular = OnSingular::Refuse;
  EXPECT_THROW(prepare_attributes(Topology(mesh), {}, mesh, options), Error);
}

TEST(Attributes, NormalsAndValuesAtCornersStay) {
  Mesh mesh = colored(torus(7, 5));
  mesh.attributes.push_back({"normal", mesh.points, {}});
  mesh.attributes.push_back({"uv", mesh.points.leftCols(2), mesh.face_vertices});
  const PreparedAttributes solved = prepare_attributes(Topology(mesh), {}, mesh, {AttributeRule::Interpolated, {}});
  EXPECT_EQ(solved.reports.size(), 2U);
  for (const std::size_t i : {2U, 3U}) EXPECT_EQ(solved.mesh.attributes[i].values, mesh.attributes[i].values);
}

/// The cube is refined once because of its points; what is not solved for goes along.
TEST(Attributes, InterpolatedPointsTakeOtherValuesAlong) {
  Mesh mesh = cube();
  mesh.points(0, 0) += 0.3;
  mesh = colored(std::move(mesh));
  const Topology topology(mesh);
  const Interpolator interpolator(topology, Scheme());
  const InterpolatedMesh linear = interpolate(interpolator, mesh, AttributeRule::Midpoint);
  ASSERT_TRUE(linear.is_refined);
  EXPECT_EQ(linear.reports.size(), 1U);
  EXPECT_EQ(linear.mesh.attributes[0].values,
            refine_midpoints(topology, SchemeKind::CatmullClark, mesh.attributes[0].values));
  EXPECT_EQ(linear.mesh.attributes[0].carry, CarryRule::Midpoint);
  const InterpolatedMesh smooth = interpolate(interpolator, mesh, AttributeRule::Scheme);
  EXPECT_EQ(smooth.mesh.attributes[0].values, Refinement(topology, {}).apply(mesh.attributes[0].values));
  EXPECT_EQ(smooth.mesh.points, linear.mesh.points);
}

}  // namespace
}  // namespace batten
