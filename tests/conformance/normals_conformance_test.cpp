/// A mesh whose normals were turned, or whose surface is the fairest with its normals, has these normals and points by
/// OpenSubdiv too after writing and reading.
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "batten/interpolate/fair_mesh.h"
#include "batten/interpolate/local_normals.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/refine/vertex_blend.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"

namespace batten::test {
namespace {

struct NormalsCase {
  std::string model;
  SchemeKind kind;
};

/// A model and the normals estimated at its vertices.
class HasNormals : public testing::TestWithParam<NormalsCase> {
 protected:
  void SetUp() override {
    BATTEN_REQUIRE_DATA();
    const std::string& name = GetParam().model;
    mesh = name.rfind("catmark", 0) == 0 ? load_shape(name) : load_model(name);
    topology = Topology(mesh);
    scheme = choose_scheme(mesh);
    scheme.kind = GetParam().kind;
    wanted = estimated_wanted_normals(topology, mesh.points);
  }

  /// control: of the surface that passes through the vertices. has_normal(v): whether its normal is the wanted one.
  template <typename HasNormal>
  void expect_by_opensubdiv(const Mesh& control, const Scheme& of_control, const HasNormal& has_normal) const {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("batten-" + std::to_string(getpid()) + "-normals.obj")).string();
    write_mesh(path, control);
    const Mesh read = read_mesh(path);
    std::filesystem::remove(path);
    const Oracle oracle(read, of_control, 1);
    const OracleLimit limits = oracle.limits();
    const double diagonal = bounding_diagonal(mesh.points);
    Index compared = 0;
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (!has_normal(v)) continue;
      // The tolerance of the solution, and the oracle's rounding.
      ASSERT_LE((limits.positions.row(v) - mesh.points.row(v)).norm(), (1e-10 + 1e-14) * diagonal) << "vertex " << v;
      // At boundaries and darts OpenSubdiv's tangents are not the limits of its refinement.
      VertexRing ring;
      if (vertex_rule_of(oracle.topology(1), of_control, v, ring) != VertexRule::Smooth) continue;
      ++compared;
      const Eigen::RowVector3d first = limits.first_tangents.row(v);
      const Eigen::RowVector3d second = limits.second_tangents.row(v);
      ASSERT_LE(angle_between(first.cross(second), wanted.row(v)), 1e-8) << "vertex " << v;
    }
    EXPECT_GT(compared, topology.vertex_count() / 2);
  }

  Mesh mesh;
  Topology topology{Mesh()};
  Scheme scheme;
  Values wanted;
};

TEST_P(HasNormals, ThatWereTurned) {
  InterpolatedMesh surface = interpolate(Interpolator(topology, scheme), mesh);
  const TurnReport report = turn_normals(surface, wanted);
  ASSERT_GT(report.counts.turned, topology.vertex_count() * 9 / 10);
  expect_by_opensubdiv(surface.mesh, surface.scheme, [&](Index v) { return !std::isnan(report.after(v)); });
}

class FairHasNormals : public HasNormals {};

TEST_P(FairHasNormals, OfTheFairestSurface) {
  FairOptions options;
  options.energy = ShapeEnergyKind::Bending;  // fewer iterations
  options.rounds = 1;
  options.normals = wanted;
  const FairMesh fair = interpolate_fairly(topology, scheme, mesh, AttributeRule::Midpoint, options);
  ASSERT_GT(fair.report.normal_count, topology.vertex_count() * 9 / 10);
  EXPECT_LE(fair.report.max_angle, 1e-8);
  expect_by_opensubdiv(fair.mesh, fair.scheme, [](Index) { return true; });
}

std::string case_name(const testing::TestParamInfo<NormalsCase>& tested) {
  return tested.param.model + (tested.param.kind == SchemeKind::Loop ? "_loop" : "_catmull_clark");
}

INSTANTIATE_TEST_SUITE_P(Conformance, HasNormals,
                         testing::Values(NormalsCase{"spot", SchemeKind::Loop},
                                         NormalsCase{"spot", SchemeKind::CatmullClark},
                                         NormalsCase{"bigguy", SchemeKind::CatmullClark},
                                         NormalsCase{"suzanne", SchemeKind::CatmullClark}),
                         case_name);

INSTANTIATE_TEST_SUITE_P(Conformance, FairHasNormals,
                         testing::Values(NormalsCase{"spot", SchemeKind::Loop},
                                         NormalsCase{"catmark_torus", SchemeKind::CatmullClark}),
                         case_name);

}  // namespace
}  // namespace batten::test
