#include "batten/expand/surface_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/mesh/vertex_fields.h"
#include "batten/surface/curvature.h"
#include "support/shapes.h"
#include "support/surface_mesh.h"

namespace batten {
namespace {

/// From a level's vertices to the next one's, in Refinement's order: by edge, then, for Catmull-Clark, by face.
template <typename EdgeValue, typename FaceValue>
Scalars child_field(const Topology& topology, SchemeKind kind, const Scalars& field, const EdgeValue& edge_value,
                    const FaceValue& face_value) {
  const Index faces = kind == SchemeKind::CatmullClark ? topology.face_count() : 0;
  Scalars child(field.size() + topology.edge_count() + faces);
  child.head(field.size()) = field;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    child[field.size() + e] = edge_value(e, topology.origin(h), topology.destination(h));
  }
  for (Index f = 0; f < faces; ++f) child[field.size() + topology.edge_count() + f] = face_value(f);
  return child;
}

/// New vertices have the mean of their edge or face.
Scalars mean_step(const Topology& topology, SchemeKind kind, const Scalars& field) {
  return child_field(
      topology, kind, field, [&](Index /*edge*/, Index a, Index b) { return 0.5 * (field[a] + field[b]); },
      [&](Index f) {
        double sum = 0.0;
        for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) sum += field[topology.origin(h)];
        return sum / topology.face_size(f);
      });
}

/// In the first two steps new vertices off the creases have zero.
Scalars crease_step(const Topology& topology, SchemeKind kind, const Scalars& field, int level, Index even_count) {
  return child_field(
      topology, kind, field,
      [&](Index edge, Index a, Index b) {
        if (level == 0) return crease_sharpness(topology, edge);
        const bool along = std::min(a, b) < even_count && field[a] > 0.0 && field[b] > 0.0;
        return along ? 0.5 * (field[a] + field[b]) : 0.0;
      },
      [](Index /*face*/) { return 0.0; });
}

Scalars stepped_field(const Topology& topology, const Scheme& scheme, Scalars field, int levels, bool creases) {
  Topology current = topology;
  Scheme step_scheme = scheme;
  for (int level = 0; level < levels; ++level) {
    field = creases && level < 2 ? crease_step(current, scheme.kind, field, level, topology.vertex_count())
                                 : mean_step(current, scheme.kind, field);
    current = Refinement(current, step_scheme).child();
    step_scheme = scheme.after_first_step();
  }
  return field;
}

double largest_difference(const Scalars& ours, const Scalars& theirs, const Buffer<Index>& partner) {
  double largest = 0.0;
  for (Index v = 0; v < ours.size(); ++v) {
    const double expected = theirs[partner[v]];
    if (std::isnan(ours[v]) != std::isnan(expected)) return std::numeric_limits<double>::infinity();
    if (!std::isnan(expected)) largest = std::max(largest, std::abs(ours[v] - expected));
  }
  return largest;
}

/// Beside those that are no numbers: at the vertices of a cube there is no curvature.
double largest_number(const Scalars& field) {
  double largest = 0.0;
  for (const double value : field) {
    if (!std::isnan(value)) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

TEST(SurfaceField, IsLinearOverFacesButForCreases) {
  test::for_each_sample([](const Mesh& sample, const Scheme& scheme, const std::string& name) {
    const Mesh mesh = test::with_random_tags(sample, 3);
    const Topology topology(mesh);
    for (const int levels : {1, 2, 3}) {
      SCOPED_TRACE(name + ", " + std::to_string(levels) + " levels");
      const Buffer<Index> partner = test::refined_partners(topology, scheme, levels);
      const FieldSurface surface{topology, scheme, mesh.points};
      for (const SurfaceField field : {SurfaceField::Valence, SurfaceField::Moved, SurfaceField::Sharpness}) {
        const Scalars expected =
            stepped_field(topology, scheme, vertex_field(surface, field), levels, field == SurfaceField::Sharpness);
        EXPECT_LE(largest_difference(surface_field(surface, field, levels), expected, partner), 1e-12);
      }
    }
  });
}

TEST(SurfaceField, HasTheSurfacesCurvature) {
  for (const Mesh& mesh : {test::jittered(torus(7, 5), 0.02, 4), test::jittered(cube(), 0.05, 7)}) {
    const Topology topology(mesh);
    const Scheme scheme;
    const LimitSurface surface(topology, scheme, mesh.points);
    for (const int levels : {0, 3}) {
      const Topology refined = refine(topology, scheme, mesh.points, levels).topology;
      const Curvature expected = limit_curvature(surface, refined);
      Buffer<Index> partner;
      if (levels > 0) partner = test::refined_partners(topology, scheme, levels);
      for (Index v = 0; levels == 0 && v < topology.vertex_count(); ++v) partner.push_back(v);
      const FieldSurface given{topology, scheme, mesh.points};
      const double most = std::max(largest_number(expected.mean), largest_number(expected.gaussian));
      EXPECT_LE(largest_difference(surface_field(given, SurfaceField::MeanCurvature, levels), expected.mean, partner),
                1e-9 * most);
      EXPECT_LE(
          largest_difference(surface_field(given, SurfaceField::GaussianCurvature, levels), expected.gaussian, partner),
          1e-9 * most);
    }
  }
}

TEST(SurfaceField, NumbersAtVerticesStayThereAndAreLinearBetween) {
  const Mesh mesh = grid(2, 2);
  const Topology topology(mesh);
  const FieldSurface surface{topology, Scheme(), mesh.points};
  const Scalars numbers = 3.0 * mesh.points.col(0) - mesh.points.col(1);
  EXPECT_TRUE((spread_field(surface, numbers, 0).array() == numbers.array()).all());
  const Scalars fine = spread_field(surface, numbers, 2);
  EXPECT_EQ(fine.size(), 9 * 9);
  EXPECT_LE((fine.head(9) - numbers).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(fine.mean(), numbers.mean(), 1e-12);
  EXPECT_THROW(spread_field(surface, Scalars::Zero(8), 1), Error);
}

TEST(SurfaceField, MissesItsTargetsByTheDistance) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const Scheme scheme;
  const Values limit = LimitMatrix(topology, scheme).apply(mesh.points);
  Points targets = limit.topRows(3);
  targets(1, 2) += 0.25;
  const Scalars missed = vertex_field({topology, scheme, mesh.points, &targets}, SurfaceField::Missed);
  EXPECT_NEAR(missed[1], 0.25, 1e-15);
  EXPECT_EQ(missed.sum(), missed[1]);
  const Points many = Points::Zero(9, 3);
  EXPECT_THROW(vertex_field({topology, scheme, mesh.points, &many}, SurfaceField::Missed), Error);
  EXPECT_THROW(vertex_field({topology, scheme, mesh.points}, SurfaceField::Missed), Error);
}

TEST(FillFromNeighbours, TakesTheMeanOfThoseThatHaveANumber) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  Scalars field(5);
  field << none, 1.0, none, 3.0, none;
  fill_from_neighbours(4, {0, 1, 2, 3}, field);
  EXPECT_EQ(field[0], 2.0);
  EXPECT_EQ(field[2], 2.0);
  EXPECT_TRUE(std::isnan(field[4]));
}

}  // namespace
}  // namespace batten
