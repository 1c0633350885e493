/// The verb interpolate: what it keeps, and what it says of systems without a solution.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using Json = nlohmann::json;

/// A cube with a dent and colours, textured, in two groups and materials.
const char* const kDentedCube =
    "mtllib paints.mtl\n"
    "v -1 -1 -1 0.1 0.2 0.3\nv 1.3 -1 -1 1 0 0\nv -1 1 -1 0 1 0\nv 1 1 -1 0 0 1\nv -1 -1 1 1 1 0\nv 1 -1 1 0 1 1\n"
    "v -1 1 1 1 0 1\nv 1 1 1 0.5 0.5 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "g first\nusemtl red\nf 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\nf 1/1 2/2 6/3 5/4\n"
    "g second\nusemtl blue\nf 3/1 7/2 8/3 4/4\nf 1/1 5/2 7/3 3/4\nf 2/1 4/2 8/3 6/4\n";

double missed(const Mesh& control, ConstValuesRef values, ConstValuesRef targets) {
  const Topology topology(control);
  const Values limit = LimitMatrix(topology, choose_scheme(control)).apply(values);
  return (limit.topRows(targets.rows()) - targets).rowwise().norm().maxCoeff();
}

const Attribute* find(const Mesh& mesh, const std::string& name) {
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name == name) return &attribute;
  }
  return nullptr;
}

TEST_F(Tool, ADentedCubeKeepsColoursTextureGroupsAndMaterials) {
  write("cube.obj", kDentedCube);
  const Outcome result = run("interpolate cube.obj -o control.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh given = read_mesh(path("cube.obj"));
  const Mesh control = read_mesh(path("control.obj"));
  EXPECT_LE(missed(control, control.points, given.points), 1e-9);
  ASSERT_NE(find(control, "color"), nullptr);
  EXPECT_LE(missed(control, find(control, "color")->values, find(given, "color")->values), 1e-9);
  ASSERT_NE(find(control, "uv"), nullptr);
  EXPECT_EQ(find(control, "uv")->corner_rows.size(), control.face_vertices.size());
  ASSERT_EQ(control.groups.size(), 4U);
  EXPECT_EQ(control.groups[3].name, "blue");
  EXPECT_EQ(control.groups[3].first_face, 12);
  EXPECT_EQ(control.material_libraries, (std::vector<std::string>{"paints.mtl"}));
  const Json report = Json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["singular"][0]["alpha"], 0.5);
  EXPECT_EQ(report["attributes"][0]["name"], "color");
  EXPECT_EQ(report["attributes"][0]["outcome"], "tolerance");
}

TEST_F(Tool, LeastSquaresOnOneComponentLeavesTheExitCodeToTheOthers) {
  Mesh mesh = torus(12, 9);
  const Mesh solid = cube();
  const Index first = mesh.vertex_count();
  mesh.points.conservativeResize(first + 8, 3);
  mesh.points.bottomRows(8) = solid.points.rowwise() + Eigen::RowVector3d(9, 0, 0);
  mesh.points(first, 1) += 0.3;
  for (Index f = 0; f < 6; ++f) {
    for (Index i = 0; i < 4; ++i) mesh.face_vertices.push_back(first + solid.face_vertices[4 * f + i]);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  write_mesh(path("both.obj"), mesh);
  const std::string verb = "interpolate both.obj -o x.obj --report r.json --on-singular least-squares";
  EXPECT_EQ(run(verb).status, 0);
  EXPECT_EQ(Json::parse(text_of(path("r.json")))["outcome"], "least squares");
  const Outcome early = run(verb + " --method jacobi --max-iterations 8");
  EXPECT_EQ(early.status, 1);
  EXPECT_EQ(Json::parse(text_of(path("r.json")))["converged"], false);
  EXPECT_NE(early.err.find("was not reached in"), std::string::npos) << early.err;
}

TEST_F(Tool, TheRescueOfValenceTwoSaysWhatActed) {
  write("pillow.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
  const Outcome result = run("interpolate pillow.obj -o x.obj --scheme catmull-clark");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_GT(read_mesh(path("x.obj")).vertex_count(), 3);
  EXPECT_NE(result.out.find("vertices of valence 2; vertex 0, 3 vertices): alpha = 1 there"), std::string::npos)
      << result.out;
}

TEST_F(Tool, ToleranceBelowRoundingIsSaidToBe) {
  const Outcome result = run("interpolate " + kModels + "pipe-joint.obj -o x.obj --tolerance 1e-17 --report r.json");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("as near as doubles come"), std::string::npos) << result.out;
  EXPECT_EQ(Json::parse(text_of(path("r.json")))["outcome"], "rounding");
}

TEST_F(Tool, NoMethodTakesMoreIterationsThanAllowed) {
  const std::string verb = "interpolate " + kModels + "creature.obj --report r.json --max-iterations ";
  for (const std::string method : {"auto", "conjugate-gradient", "chebyshev", "jacobi", "richardson"}) {
    for (const int most : {1, 5, 13}) {
      run(verb + std::to_string(most) + " --method " + method);
      EXPECT_EQ(Json::parse(text_of(path("r.json")))["iterations"], most) << method;
    }
  }
  // A dart makes the matrix unsymmetric, and BiCGSTAB applies it twice an iteration.
  write("dart.obj", text_of(kModels + "tripod.obj") + "t crease 2/1/0 0 1 2\n");
  run("interpolate dart.obj --report r.json --method conjugate-gradient --max-iterations 5");
  EXPECT_LE(Json::parse(text_of(path("r.json")))["iterations"].get<int>(), 5);
}

TEST_F(Tool, AFairSurfacePassesThroughThePointsWithLessEnergy) {
  const std::string command = "interpolate " + kModels + "coarse-joint.obj --fair ";
  const Outcome result =
      run(command + "-o fair.obj --report r.json --picture p.png --color mean --before-after --width 320");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("of the plain surface"), std::string::npos) << result.out;
  EXPECT_TRUE(fs::exists(path("p.png")));
  const Mesh given = read_mesh(kModels + "coarse-joint.obj");
  const Mesh fair = read_mesh(path("fair.obj"));
  EXPECT_LE(missed(fair, fair.points, given.points), 1e-9);
  const Json report = Json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["fair"]["energy"], "variation");
  EXPECT_LT(4.0 * report["fair"]["fair_energy"].get<double>(), report["fair"]["plain_energy"].get<double>());
  EXPECT_EQ(report["written_vertices"], fair.vertex_count());
  EXPECT_EQ(run(command + "-o soft.obj --report s.json --smoothing 5%").status, 0);
  const Json soft = Json::parse(text_of(path("s.json")));
  EXPECT_GT(soft["max_error"].get<double>(), 1e-6);
  EXPECT_LT(soft["fair"]["fair_energy"], report["fair"]["fair_energy"]);
}

TEST_F(Tool, OptionsOfFairSurfacesNeedTheFlag) {
  const std::string command = "interpolate " + kModels + "pyramid.obj -o x.obj ";
  EXPECT_EQ(run(command + "--energy bending").status, 2);
  EXPECT_EQ(run(command + "--fair --method direct").status, 2);
  EXPECT_EQ(run(command + "--fair --fair-levels 3").status, 2);
}

}  // namespace
}  // namespace batten::cli_tests
