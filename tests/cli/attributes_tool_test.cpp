/// What the tool does with values at vertices and corners.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

/// A bent grid of four quads with colours at the vertices and texture coordinates at the corners; the second row of
/// faces has a texture of its own.
const char* const kSheet =
    "v 0 0 0 1 0 0\nv 1 0 1 0 1 0\nv 2 0 0 0 0 1\nv 0 1 1 1 1 0\nv 1 1 2 0 1 1\nv 2 1 1 1 0 1\nv 0 2 0 1 1 1\n"
    "v 1 2 1 0 0 0\nv 2 2 0 0.5 0.25 1\n"
    "vt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 0.5\nvt 0.6 0.5\nvt 1 0.5\nvt 0 2.5\nvt 0.5 2.7\nvt 1 2.5\nvt 0 3\nvt 0.5 3\n"
    "vt 1 3\n"
    "f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\nf 4/7 5/8 8/11 7/10\nf 5/8 6/9 9/12 8/11\n";

class CarriedValues : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("sheet.obj", kSheet);
  }
  Mesh result_of(const std::string& arguments) {
    const Outcome result = run(arguments + " -o out.obj");
    EXPECT_EQ(result.status, 0) << result.err;
    return read_mesh(path("out.obj"));
  }
  static const Attribute& named(const Mesh& mesh, const std::string& name) {
    return *std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                         [&](const Attribute& attribute) { return attribute.name == name; });
  }
  /// The texture coordinates of the first corner of the first face that has the vertex.
  static Eigen::RowVector2d texture_at(const Mesh& mesh, Index vertex) {
    const auto corner = std::find(mesh.face_vertices.begin(), mesh.face_vertices.end(), vertex);
    const Attribute& uv = named(mesh, "uv");
    return uv.values.row(uv.corner_rows[corner - mesh.face_vertices.begin()]);
  }
  void expect_refused(const std::string& command, const std::string& part) {
    const Outcome result = run(command);
    EXPECT_EQ(result.status, 2) << command << "\n" << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << command << "\n" << result.err;
  }
};

TEST_F(CarriedValues, TheFaceVaryingRuleIsTheOptionsOrTheFiles) {
  EXPECT_EQ(texture_at(result_of("subdivide sheet.obj"), 0), Eigen::RowVector2d(0, 0));
  const Mesh smooth = result_of("subdivide sheet.obj --face-varying none --report r.json");
  EXPECT_EQ(smooth.face_varying, FaceVaryingRule::None);
  // A corner of the boundary curve: (0.5, 0) / 8 + (0, 0.5) / 8.
  EXPECT_EQ(texture_at(smooth, 0), Eigen::RowVector2d(0.0625, 0.0625));
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json")))["scheme"]["face_varying"], "none");
  write("tagged.obj", std::string(kSheet) + "t facevaryinginterpolateboundary 1/0/0 1\n");
  const Mesh tagged = result_of("subdivide tagged.obj");
  EXPECT_EQ(tagged.face_varying, FaceVaryingRule::CornersOnly);
  EXPECT_EQ(texture_at(tagged, 0), Eigen::RowVector2d(0, 0));
  // On the boundary, between corners: 6/8 (0.5, 0) and an eighth of each neighbour; at the seam the curve is smooth.
  EXPECT_EQ(texture_at(tagged, 1), Eigen::RowVector2d(0.5, 0.0));
  EXPECT_NEAR(texture_at(tagged, 4)[0], 0.75 * 0.6 + 0.125, 1e-15);
  EXPECT_NEAR(texture_at(result_of("subdivide tagged.obj --face-varying boundaries"), 4)[0], 0.6, 1e-15);
  EXPECT_NEAR(texture_at(result_of("subdivide tagged.obj --limit"), 4)[0], (4.0 * 0.6 + 1.0) / 6.0, 1e-15);
  EXPECT_NEAR(texture_at(result_of("subdivide tagged.obj --chord 1%"), 4)[0], (4.0 * 0.6 + 1.0) / 6.0, 1e-15);
  EXPECT_NEAR(texture_at(result_of("interpolate tagged.obj --levels 1"), 4)[0], (4.0 * 0.6 + 1.0) / 6.0, 1e-15);
}

TEST_F(CarriedValues, AFormatWithoutTheRuleSaysSo) {
  const Outcome ply = run("subdivide sheet.obj --face-varying corners-only -o out.ply");
  EXPECT_NE(ply.err.find("lost: face-varying rule"), std::string::npos) << ply.err;
  EXPECT_EQ(run("subdivide sheet.obj -o out.ply").err, "");
  EXPECT_EQ(run("subdivide sheet.obj --face-varying all -o out.ply").err, "");
  const Outcome usda = run("subdivide sheet.obj --face-varying corners-plus1 -o out.usda");
  EXPECT_EQ(usda.err, "");
  EXPECT_NE(text_of(path("out.usda")).find("faceVaryingLinearInterpolation = \"cornersPlus1\""), std::string::npos);
}

TEST_F(CarriedValues, AttributesAreCarriedAsAskedFor) {
  const Values given = named(read_mesh(path("sheet.obj")), "color").values;
  const auto missed = [&](const std::string& arguments) {
    return (named(result_of(arguments), "color").values.topRows(9) - given).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(missed("subdivide sheet.obj --limit"), 0.1);
  EXPECT_GT(missed("subdivide sheet.obj --limit --attributes scheme"), 0.1);
  for (const std::string how : {"--limit", "--chord 1%", "--limit --levels 3"}) {
    EXPECT_EQ(missed("subdivide sheet.obj --attributes midpoint " + how), 0.0) << how;
    EXPECT_LE(missed("subdivide sheet.obj --attributes interpolated " + how), 1e-10) << how;
  }
  EXPECT_EQ(missed("subdivide sheet.obj --attributes midpoint"), 0.0);
  EXPECT_LE(missed("interpolate sheet.obj --levels 1"), 1e-10);
  EXPECT_EQ(missed("interpolate sheet.obj --levels 1 --attributes midpoint"), 0.0);
  EXPECT_EQ(missed("interpolate sheet.obj --attributes midpoint"), 0.0);
  EXPECT_GT(missed("interpolate sheet.obj --levels 1 --attributes scheme"), 0.1);
}

TEST_F(CarriedValues, WhatWasSolvedForIsTold) {
  const Outcome result = run("subdivide sheet.obj --attributes interpolated --report r.json -o out.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("color"), std::string::npos) << result.out;
  const nlohmann::json report = nlohmann::json::parse(text_of(path("r.json")));
  ASSERT_EQ(report["attributes"].size(), 1U);
  EXPECT_EQ(report["attributes"][0]["name"], "color");
  EXPECT_TRUE(report["attributes"][0]["converged"]);
  EXPECT_LE(report["attributes"][0]["max_error"], 1e-9);
}

TEST_F(CarriedValues, PicturesShowTheDifference) {
  const std::string ring = "render " + kModels + "ring.obj --width 120 --samples 1 --levels 3 ";
  const auto picture = [&](const std::string& options) {
    const Outcome result = run(ring + options + " -o a.png");
    EXPECT_EQ(result.status, 0) << result.err;
    return text_of(path("a.png"));
  };
  EXPECT_NE(picture("--attributes midpoint"), picture("--attributes interpolated"));
  EXPECT_EQ(picture("--attributes scheme"), picture(""));
  EXPECT_NE(picture("--color checker"), picture(""));
  EXPECT_NE(picture("--color checker"), picture("--color checker --face-varying none"));
  EXPECT_EQ(picture("--color checker"), picture("--color checker --face-varying all"));
  const Outcome without = run("render " + kModels + "cube.obj --color checker -o a.png");
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.err.find("the mesh has none; choose another --color"), std::string::npos) << without.err;
}

TEST_F(CarriedValues, OptionsWithoutAnEffectAreRefused) {
  const std::string cube = kModels + "cube.obj ";
  expect_refused("subdivide sheet.obj --attributes midpiont", "(did you mean midpoint?)");
  expect_refused("subdivide sheet.obj --face-varying corner-only", "(did you mean corners-only?)");
  expect_refused("subdivide " + cube + "--attributes midpoint -o a.obj", "which has no values at its vertices");
  expect_refused("interpolate " + cube + "--attributes scheme -o a.obj", "which has no values at its vertices");
  expect_refused("subdivide " + cube + "--face-varying none -o a.obj", "--face-varying does nothing for " + kModels);
  expect_refused("subdivide sheet.obj --triangulate --scheme butterfly --face-varying none -o a.obj",
                 "--face-varying does nothing with Butterfly, only with Catmull-Clark and Loop");
  expect_refused("subdivide sheet.obj --compare --attributes midpoint", "--attributes");
  expect_refused("render sheet.obj --face-varying none -o a.png", "does nothing without --color checker");
  expect_refused("render sheet.obj --color checker --range 0:1 -o a.png", "--range does nothing with --color checker");
}

}  // namespace
}  // namespace batten::cli_tests
