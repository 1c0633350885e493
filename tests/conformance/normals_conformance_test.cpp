/// A mesh whose normals were turned, after writing and reading, has these normals and points by OpenSubdiv too.
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "batten/interpolate/local_normals.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/refine/vertex_blend.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"

namespace batten::test {
namespace {

struct TurnCase {
  std::string model;
  SchemeKind kind;
};

class HasNormals : public testing::TestWithParam<TurnCase> {};

TEST_P(HasNormals, ByOpenSubdivToo) {
  BATTEN_REQUIRE_DATA();
  const Mesh mesh = load_model(GetParam().model);
  const Topology topology(mesh);
  Scheme scheme = choose_scheme(mesh);
  scheme.kind = GetParam().kind;
  InterpolatedMesh surface = interpolate(Interpolator(topology, scheme), mesh);
  const Values wanted = estimated_wanted_normals(topology, mesh.points);
  const TurnReport report = turn_normals(surface, wanted);
  ASSERT_GT(report.counts.turned, topology.vertex_count() * 9 / 10);
  const std::string path =
      (std::filesystem::temp_directory_path() / ("batten-" + std::to_string(getpid()) + "-turned.obj")).string();
  write_mesh(path, surface.mesh);
  const Mesh read = read_mesh(path);
  std::filesystem::remove(path);
  const Oracle oracle(read, surface.scheme, 1);
  const OracleLimit limits = oracle.limits();
  const double diagonal = bounding_diagonal(mesh.points);
  Index compared = 0;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (std::isnan(report.after(v))) continue;
    // The tolerance of the solution, and the oracle's rounding.
    ASSERT_LE((limits.positions.row(v) - mesh.points.row(v)).norm(), (1e-10 + 1e-14) * diagonal) << "vertex " << v;
    // At boundaries and darts OpenSubdiv's tangents are not the limits of its refinement.
    VertexRing ring;
    if (vertex_rule_of(oracle.topology(1), surface.scheme, v, ring) != VertexRule::Smooth) continue;
    ++compared;
    const Eigen::RowVector3d first = limits.first_tangents.row(v);
    const Eigen::RowVector3d second = limits.second_tangents.row(v);
    ASSERT_LE(angle_between(first.cross(second), wanted.row(v)), 1e-8) << "vertex " << v;
  }
  EXPECT_GT(compared, topology.vertex_count() / 2);
}

INSTANTIATE_TEST_SUITE_P(Conformance, HasNormals,
                         testing::Values(TurnCase{"spot", SchemeKind::Loop}, TurnCase{"spot", SchemeKind::CatmullClark},
                                         TurnCase{"bigguy", SchemeKind::CatmullClark},
                                         TurnCase{"suzanne", SchemeKind::CatmullClark}),
                         [](const auto& tested) {
                           return tested.param.model +
                                  (tested.param.kind == SchemeKind::Loop ? "_loop" : "_catmull_clark");
                         });

}  // namespace
}  // namespace batten::test
