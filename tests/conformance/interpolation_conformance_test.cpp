/// The control mesh, after writing and reading, has a surface by OpenSubdiv that passes through the targets.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "batten/interpolate/interpolator.h"
#include "batten/refine/vertex_blend.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"

namespace batten::test {
namespace {

struct Case {
  std::string model;
  SchemeKind kind;
};

/// Every manifold model under Catmull-Clark, and those of triangles under Loop.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const std::string& name : model_names()) all.push_back({name, SchemeKind::CatmullClark});
  for (const char* name : {"beetle-alt", "fandisk", "nefertiti", "rocker-arm", "spot", "stanford-bunny"}) {
    all.push_back({name, SchemeKind::Loop});
  }
  return all;
}

/// Levels until the last semi-sharp tag has faded, at least one: OpenSubdiv's limits are wrong on a control mesh's
/// polygons.
int levels_of(const Mesh& mesh) {
  double most = 1.0;
  for (const Crease& crease : mesh.creases) {
    if (crease.sharpness < kInfiniteSharpness) most = std::max(most, crease.sharpness);
  }
  for (const Corner& corner : mesh.corners) {
    if (corner.sharpness < kInfiniteSharpness) most = std::max(most, corner.sharpness);
  }
  return static_cast<int>(std::ceil(most));
}

class InterpolatesFor : public testing::TestWithParam<Case> {};

TEST_P(InterpolatesFor, OpenSubdivToo) {
  BATTEN_REQUIRE_DATA();
  Mesh mesh = load_model(GetParam().model);
  Scheme scheme = choose_scheme(mesh);
  scheme.kind = GetParam().kind;
  const Points targets = mesh.points;
  const double diagonal = bounding_diagonal(targets);
  const Topology topology(mesh);
  const Interpolant result = Interpolator(topology, scheme).solve(targets);
  ASSERT_TRUE(result.report.converged()) << result.report.solve.method_name;
  EXPECT_LE(result.report.max_error, 1e-10 * diagonal);
  mesh.points = result.control;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("batten-" + std::to_string(getpid()) + GetParam().model + ".obj"))
          .string();
  write_mesh(path, mesh);
  const Mesh read = read_mesh(path);
  std::filesystem::remove(path);
  const Oracle oracle(read, scheme, levels_of(read));
  const Points limits = oracle.limits().positions;
  Index compared = 0;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    // Where OpenSubdiv's masks are not the limit of its refinement: darts, and valence 2 inside.
    if (topology.is_isolated(v)) continue;
    VertexRing ring;
    const VertexRule rule = vertex_rule_of(oracle.topology(oracle.max_level()), scheme, v, ring);
    if (rule == VertexRule::Dart || (rule == VertexRule::Smooth && ring.edges.size() == 2)) continue;
    ++compared;
    // The tolerance of the solution, and the oracle's rounding.
    ASSERT_LE((limits.row(v) - targets.row(v)).norm(), (1e-10 + 1e-14) * diagonal) << "vertex " << v;
  }
  EXPECT_GT(compared, topology.vertex_count() * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Conformance, InterpolatesFor, testing::ValuesIn(cases()), [](const auto& tested) {
  std::string name = tested.param.model + (tested.param.kind == SchemeKind::Loop ? "_loop" : "_catmull_clark");
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

}  // namespace
}  // namespace batten::test
