#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

using nlohmann::json;

/// $BATTEN_DATA/reference.json: limits of small meshes by an implementation that shares nothing with this one
/// (re-centred brute refinement and eigenvectors, each with its measured error).
class Reference : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("BATTEN_DATA");
    if (folder == nullptr) GTEST_SKIP() << "set BATTEN_DATA to the folder of the test data";
    std::ifstream file(std::string(folder) + "/reference.json");
    data = json::parse(file);
  }
  const json& entry() const { return data.at(GetParam()); }
  json data;
};

Mesh mesh_of(const json& entry) {
  Mesh mesh = test::mesh_of_faces(static_cast<Index>(entry.at("V").size()), entry.at("F").get<test::Faces>());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (int c = 0; c < 3; ++c) mesh.points(v, c) = entry.at("V")[v][c];
  }
  for (const json& crease : entry.at("creases")) mesh.creases.push_back({crease[0], crease[1], kInfiniteSharpness});
  for (const json& corner : entry.at("corners")) mesh.corners.push_back({corner, kInfiniteSharpness});
  return mesh;
}

Scheme scheme_named(const std::string& name) {
  Scheme scheme;
  scheme.kind = name == "cc" ? SchemeKind::CatmullClark : SchemeKind::Loop;
  return scheme;
}

/// The file's own error (up to 1e-11 where brute refinement converges slowly), and our rounding.
double tolerance(const json& entry, const std::string& quantity) {
  return 1e-14 + 10.0 * entry.at("bf_err").at(quantity).get<double>();
}

std::vector<std::string> reference_names() {
  return {"cube",
          "tetra",
          "octa",
          "icosa",
          "prism3",
          "prism5",
          "prism6",
          "torus5x4",
          "tri_torus4x5",
          "dodeca(dual of icosa)",
          "cube_CC1",
          "lshape_edge_only",
          "lshape_corners",
          "grid3x2_edge_only",
          "grid3x2_corners",
          "perturbed_cube_crease_loop",
          "perturbed_cube_two_creases_with_darts",
          "bipyramid7"};
}
std::string plain_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  }
  return name;
}
INSTANTIATE_TEST_SUITE_P(Limit, Reference, ::testing::ValuesIn(reference_names()), plain_name);

TEST_P(Reference, LimitPositionsAreThoseOfTheFile) {
  const Mesh mesh = mesh_of(entry());
  const Topology topology(mesh);
  for (const std::string scheme : {"cc", "loop"}) {
    if (!entry().contains(scheme + "_limit")) continue;
    const Values limit = LimitMatrix(topology, scheme_named(scheme)).apply(mesh.points);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      for (int c = 0; c < 3; ++c) {
        const double expected = entry().at(scheme + "_limit")[v][c];
        EXPECT_NEAR(limit(v, c), expected, tolerance(entry(), scheme + "_limit")) << scheme << " vertex " << v;
      }
    }
  }
}

/// Boundary normals in the file follow OpenSubdiv's masks; where it has none (corners) nothing is compared.
TEST_P(Reference, LimitNormalsAreThoseOfTheFile) {
  const Mesh mesh = mesh_of(entry());
  const Topology topology(mesh);
  for (const std::string scheme : {"cc", "loop"}) {
    if (!entry().contains(scheme + "_normal")) continue;
    const Values normals = limit_normals(topology, scheme_named(scheme), mesh.points, LimitMasks::OpenSubdiv).vertices;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const json& expected = entry().at(scheme + "_normal")[v];
      for (int c = 0; c < 3 && !expected.is_null(); ++c) {
        EXPECT_NEAR(normals(v, c), expected[c].get<double>(), tolerance(entry(), scheme + "_normal"))
            << scheme << " vertex " << v;
      }
    }
  }
}

const Scheme kModified = test::scheme_of(SchemeKind::ModifiedButterfly);

class ButterflyReference : public Reference {};
INSTANTIATE_TEST_SUITE_P(Limit, ButterflyReference,
                         ::testing::Values("tetra", "octa", "icosa", "tri_torus4x5", "bipyramid7"));

TEST_P(ButterflyReference, EdgePointsAreThoseOfTheFile) {
  const Mesh mesh = mesh_of(entry());
  const Topology topology(mesh);
  const Values refined = Refinement(topology, kModified).apply(mesh.points);
  std::map<std::pair<Index, Index>, Index> edges;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    edges[std::minmax(topology.origin(h), topology.destination(h))] = e;
  }
  const json& points = entry().at("butterfly_level1_edge_points");
  EXPECT_EQ(points.size(), edges.size());
  for (const json& point : points) {
    const Index a = point.at("edge")[0];
    const Index b = point.at("edge")[1];
    const Index row = topology.vertex_count() + edges.at(std::minmax(a, b));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(refined(row, c), point.at("p")[c].get<double>(), 1e-14) << a << " " << b;
  }
}

TEST_P(ButterflyReference, NormalsAreThoseOfTheFile) {
  const Mesh mesh = mesh_of(entry());
  const Values normals = limit_normals(Topology(mesh), kModified, mesh.points).vertices;
  const json& expected = entry().at("butterfly_normal_from_level2");
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (int c = 0; c < 3 && !expected[v].is_null(); ++c) {
      EXPECT_NEAR(normals(v, c), expected[v][c].get<double>(), 1e-13) << "vertex " << v;
    }
  }
}

/// The control points of the file have the mesh's points as limits.
TEST_P(Reference, ControlPointsOfTheFileInterpolate) {
  const Mesh mesh = mesh_of(entry());
  const Topology topology(mesh);
  for (const auto& [key, alpha] : std::vector<std::pair<std::string, double>>{
           {"cc_interp", 0.0}, {"cc_interp_minnorm", 0.0}, {"cc_interp_alpha_half", 0.5}, {"loop_interp", 0.0}}) {
    if (!entry().contains(key)) continue;
    Scheme scheme = scheme_named(key.substr(0, key.find('_')));
    scheme.alpha = alpha;
    Values control(mesh.vertex_count(), 3);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      for (int c = 0; c < 3; ++c) control(v, c) = entry().at(key)[v][c];
    }
    const double error = (LimitMatrix(topology, scheme).apply(control) - mesh.points).cwiseAbs().maxCoeff();
    EXPECT_LT(error, 1e-10) << key;  // the file's own: 3e-11 at single-face corners
  }
}

class DartMasks : public Reference {};
INSTANTIATE_TEST_SUITE_P(Limit, DartMasks, ::testing::Values("3", "4", "5", "6", "7", "8"));

/// A ring of quads around vertex 0 with one infinitely sharp edge; edges are the odd vertices, the sharp one first.
TEST_P(DartMasks, AreThoseOfTheFile) {
  const Index n = std::stoi(GetParam());
  test::Faces faces;
  for (Index j = 0; j < n; ++j) faces.push_back({0, 1 + 2 * j, 2 + 2 * j, 1 + 2 * ((j + 1) % n)});
  Mesh mesh = test::mesh_of_faces(2 * n + 1, faces);
  mesh.creases = {{0, 1, kInfiniteSharpness}};
  const Topology topology(mesh);
  const json& mask = data.at("cc_dart_masks").at(GetParam());
  Values weights = Values::Zero(1, 2 * n + 1);
  LimitMatrix(topology, Scheme()).visit_row(0, [&](Index column, double weight) { weights(0, column) += weight; });
  EXPECT_NEAR(weights(0, 0), mask.at("v").get<double>(), 1e-14);
  for (Index j = 0; j < n; ++j) {
    EXPECT_NEAR(weights(0, 1 + 2 * j), mask.at("e")[j].get<double>(), 1e-14) << "e " << j;
    EXPECT_NEAR(weights(0, 2 + 2 * j), mask.at("f")[j].get<double>(), 1e-14) << "f " << j;
  }
}

}  // namespace
}  // namespace batten
