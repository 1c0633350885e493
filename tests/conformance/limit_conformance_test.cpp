#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/vertex_blend.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"
#include "support/shapes.h"

namespace batten::test {
namespace {

/// As for refinement: the same weights, summed in another order.
constexpr double kTolerance = 1e-12;
/// In units of the tangents' own rounding, 2e-14 measured.
constexpr double kNormalTolerance = 1e-13;

/// A tag that still fades around the vertex: there OpenSubdiv takes the rule of the moment, which is no limit.
bool still_fades(const Topology& topology, Index vertex) {
  bool fades = is_semi_sharp(topology.vertex_sharpness(vertex));
  VertexRing ring;
  gather_ring(topology, vertex, ring);
  for (const float sharpness : ring.sharpness) fades = fades || is_semi_sharp(sharpness);
  return fades;
}

VertexRule rule_at(const Topology& topology, const Scheme& scheme, Index vertex) {
  VertexRing ring;
  return vertex_rule_of(topology, scheme, vertex, ring);
}

/// Interior vertices of two faces: OpenSubdiv returns the vertex.
bool has_valence_two(const Topology& topology, Index vertex) {
  return !topology.is_boundary_vertex(vertex) && topology.vertex_face_count(vertex) == 2;
}

/// A dart of two faces: OpenSubdiv returns the vertex, our option gives the smooth mask.
/// Levels until every tag has faded, but no more than `most`.
int fading_levels(const Topology& topology, const Scheme& scheme, ConstValuesRef points, int most) {
  int levels = 0;
  for (; levels < most; ++levels) {
    const Topology& now = refine(topology, scheme, points, levels).topology;
    bool fades = false;
    for (Index v = 0; v < now.vertex_count() && !fades; ++v) fades = !now.is_isolated(v) && still_fades(now, v);
    if (!fades) break;
  }
  return levels;
}

struct Comparison {
  Index compared = 0;
  Index left_out = 0;
  double worst = 0.0;
};

/// Both on OpenSubdiv's points of one level, whose faces suit the scheme, with OpenSubdiv's masks.
Comparison compare_positions_on_level(const Oracle& oracle, const Scheme& scheme) {
  const int level = oracle.max_level();
  const Topology& topology = oracle.topology(level);
  LimitOptions options;
  options.masks = LimitMasks::OpenSubdiv;
  const Values ours = LimitMatrix(topology, scheme, options).apply(oracle.positions(level));
  const Points theirs = oracle.limits().positions;
  Comparison result;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (!topology.is_isolated(v) && still_fades(topology, v)) {
      ++result.left_out;
      continue;
    }
    ++result.compared;
    result.worst = std::max(result.worst, (ours.row(v) - theirs.row(v)).norm());
  }
  return result;
}

/// Our limits of the control mesh, exact, and OpenSubdiv's of its refined mesh, at the vertices of the control mesh.
/// Left out: what still fades there; interior vertices of valence 2 and darts, where its masks are not its limits.
Comparison compare_positions_of_control_mesh(const Mesh& mesh, const Oracle& oracle, const Scheme& scheme) {
  const Topology& control = oracle.topology(0);
  const Topology& fine = oracle.topology(oracle.max_level());
  const Values ours = LimitMatrix(control, scheme).apply(mesh.points);
  const Points theirs = oracle.limits().positions;
  Comparison result;
  for (Index v = 0; v < control.vertex_count(); ++v) {
    if (!control.is_isolated(v)) {
      const bool dart = rule_at(fine, scheme, v) == VertexRule::Dart;
      if (still_fades(fine, v) || dart || has_valence_two(control, v)) {
        ++result.left_out;
        continue;
      }
    }
    ++result.compared;
    result.worst = std::max(result.worst, (ours.row(v) - theirs.row(v)).norm());
  }
  return result;
}

/// The difference of unit normals, scaled to the rounding of the tangents: those are differences of coordinates, and
/// the normal is the less certain the shorter they are and the less they differ in direction. Corners are left out
/// (OpenSubdiv takes the first two edges, we the sides of each sector) but for those of one face.
Comparison compare_normals_on_level(const Oracle& oracle, const Scheme& scheme, double diagonal) {
  const int level = oracle.max_level();
  const Topology& topology = oracle.topology(level);
  const LimitNormals ours = limit_normals(topology, scheme, oracle.positions(level), LimitMasks::OpenSubdiv);
  const OracleLimit limit = oracle.limits();
  Comparison result;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    const Eigen::RowVector3d first = limit.first_tangents.row(v);
    const Eigen::RowVector3d second = limit.second_tangents.row(v);
    const Eigen::RowVector3d cross = first.cross(second);
    const double certainty = cross.norm() / std::max(first.norm(), second.norm()) / diagonal;
    const bool corner = rule_at(topology, scheme, v) == VertexRule::Corner && topology.vertex_face_count(v) > 1;
    if (still_fades(topology, v) || corner || !(certainty > 1e-9)) {
      ++result.left_out;
      continue;
    }
    double nearest = 2.0;
    topology.for_each_outgoing(v, [&](Index h) {
      const double distance = (ours.corners.row(h) - cross.normalized()).norm();
      const double turned = (ours.corners.row(h) + cross.normalized()).norm();
      // Two edges have no order: at valence 2 OpenSubdiv's normal may point inward.
      nearest = std::min(nearest, has_valence_two(topology, v) ? std::min(distance, turned) : distance);
    });
    ++result.compared;
    result.worst = std::max(result.worst, nearest * certainty);
  }
  return result;
}

void expect_same_limits(const Mesh& mesh, const Scheme& scheme, int most_levels) {
  const double diagonal = bounding_diagonal(mesh.points);
  const Oracle once(mesh, scheme, 1);
  const Comparison on_level = compare_positions_on_level(once, scheme);
  EXPECT_LE(on_level.worst, kTolerance * diagonal) << "positions on level 1";
  EXPECT_GT(on_level.compared, 0);
  const Comparison normals = compare_normals_on_level(once, scheme, diagonal);
  EXPECT_LE(normals.worst, kNormalTolerance) << "normals on level 1";
  const int levels = std::max(1, fading_levels(once.topology(0), scheme, mesh.points, most_levels));
  const Oracle faded(mesh, scheme, levels);
  const Comparison of_control = compare_positions_of_control_mesh(mesh, faded, scheme);
  EXPECT_LE(of_control.worst, kTolerance * diagonal) << "positions of the control mesh, after " << levels << " levels";
  ::testing::Test::RecordProperty("compared", std::to_string(of_control.compared));
  ::testing::Test::RecordProperty("left_out", std::to_string(of_control.left_out));
}

class LimitShapes : public ShapeTest {};
INSTANTIATE_TEST_SUITE_P(Conformance, LimitShapes, ::testing::ValuesIn(shape_names()), test_name);

TEST_P(LimitShapes, HaveOpenSubdivsLimits) { expect_same_limits(mesh, scheme, 4); }

TEST_P(LimitShapes, HaveOpenSubdivsLimitsUnderEveryBoundaryRule) {
  for_each_boundary_rule([&](const Scheme& each) { expect_same_limits(mesh, each, 2); });
}

TEST_P(LimitShapes, HaveOpenSubdivsLimitsWithTheSmoothTriangleRule) {
  take_smooth_triangles();
  expect_same_limits(mesh, scheme, 2);
}

/// Four levels end every tag but those of 4 and more, which are left out; large shapes get two.
TEST_P(LimitShapes, HaveOpenSubdivsLimitsWithRandomTags) {
  scheme.crease_method = CreaseMethod::Uniform;
  expect_same_limits(with_random_tags(mesh, 1), scheme, mesh.face_count() > 200 ? 2 : 4);
}

/// An oracle where OpenSubdiv is none: A P is the same from every level of refinement.
TEST_P(LimitShapes, AreReachedFromEveryLevel) {
  const Topology topology(mesh);
  const Values limit = LimitMatrix(topology, scheme).apply(mesh.points);
  for (int level = 1; level <= 3; ++level) {
    const RefinedSurface fine = refine(topology, scheme, mesh.points, level);
    const Values same = LimitMatrix(fine.topology, scheme).apply(fine.values).topRows(mesh.vertex_count());
    EXPECT_LE((same - limit).rowwise().norm().maxCoeff(), kTolerance * bounding_diagonal(mesh.points)) << level;
  }
}

class LimitModels : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Conformance, LimitModels, ::testing::ValuesIn(model_names()), test_name);

TEST_P(LimitModels, HaveOpenSubdivsLimits) {
  BATTEN_REQUIRE_DATA();
  const Mesh mesh = load_model(GetParam());
  Scheme scheme;
  scheme.boundary = mesh.boundary.value_or(scheme.boundary);
  expect_same_limits(mesh, scheme, 2);
  if (!all_triangles(mesh)) return;
  scheme.kind = SchemeKind::Loop;
  expect_same_limits(mesh, scheme, 2);
}

}  // namespace
}  // namespace batten::test
