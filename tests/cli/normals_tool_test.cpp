/// The option --normals of the verb interpolate.
#include <nlohmann/json.hpp>

#include "batten/interpolate/local_normals.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using NormalsTool = Tool;
using Report = nlohmann::json;

/// The greatest angle in radians between directions and the limit normals of the file's first vertices.
double off_by(const std::string& file, ConstValuesRef directions) {
  const Mesh written = read_mesh(file);
  const Values normals = limit_normals(Topology(written), choose_scheme(written), written.points).vertices;
  double most = 0.0;
  for (Index v = 0; v < static_cast<Index>(directions.rows()); ++v)
    most = std::max(most, angle_between(normals.row(v), directions.row(v)));
  return most;
}

/// How far the file's surface passes by the points.
double off_points(const std::string& file, ConstValuesRef points) {
  const Mesh written = read_mesh(file);
  const Values limits = LimitMatrix(Topology(written), choose_scheme(written)).apply(written.points);
  return (limits.topRows(points.rows()) - points).rowwise().norm().maxCoeff();
}

/// A torus with normals that lean by some degrees, in two files of its own.
Mesh leaning_torus() {
  Mesh mesh = torus(9, 7);
  mesh.attributes.push_back({"normal", estimated_wanted_normals(Topology(mesh), mesh.points), {}});
  mesh.attributes[0].values.col(2).array() += 0.2;
  mesh.attributes[0].values.rowwise().normalize();
  return mesh;
}

TEST_F(NormalsTool, TakesThemFromTheMeshAnotherFileOrEstimates) {
  const Mesh mesh = leaning_torus();
  Mesh bare = mesh;
  bare.attributes.clear();
  write_mesh(path("normals.ply"), mesh);
  write_mesh(path("bare.obj"), bare);
  const Values leaning = mesh.attributes[0].values;
  const Values estimated = estimated_wanted_normals(Topology(bare), bare.points);
  const auto expect_turned = [&](const std::string& arguments, const Values& directions) {
    const Outcome result = run("interpolate " + arguments + " -o out.obj --report r.json");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_LT(off_by(path("out.obj"), directions), 1e-10) << arguments;
    EXPECT_LT(off_points(path("out.obj"), mesh.points), 1e-9) << arguments;
    const Report report = Report::parse(text_of(path("r.json")));
    // By symmetry those of the outer equator are right from the start.
    EXPECT_EQ(report.at("normals").at("turned").get<int>() + report.at("normals").at("kept").get<int>(), 63);
    EXPECT_EQ(report.at("written_faces"), 16 * 63);
    EXPECT_NE(result.out.find("refined    twice, so that normals can turn: 63 vertices became 1,008"),
              std::string::npos)
        << result.out;
  };
  expect_turned("normals.ply --normals mesh", leaning);
  expect_turned("bare.obj --normals normals.ply", leaning);
  expect_turned("bare.obj --normals estimate", estimated);
}

TEST_F(NormalsTool, ReachesThemThroughARefinedComponent) {
  const Outcome result = run("interpolate " + kModels + "cube.obj --normals estimate -o out.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh cube = read_mesh(kModels + "cube.obj");
  EXPECT_LT(off_by(path("out.obj"), estimated_wanted_normals(Topology(cube), cube.points)), 1e-10);
}

TEST_F(NormalsTool, LeavesTheMeshAsItIsWithinTheTolerance) {
  const std::string mesh = "interpolate " + kModels + "pipe-joint.obj -o ";
  ASSERT_EQ(run(mesh + "plain.obj").status, 0);
  const Outcome result = run(mesh + "kept.obj --normals estimate --normal-tolerance 10 --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(text_of(path("kept.obj")), text_of(path("plain.obj")));
  EXPECT_NE(result.out.find("angle      at most 4.45 degrees"), std::string::npos) << result.out;
  EXPECT_EQ(Report::parse(text_of(path("r.json"))).at("normals").at("kept"), 264);
}

TEST_F(NormalsTool, KeepsRipplesOnRequest) {
  const std::string start = "interpolate " + kModels + "pipe-joint.obj --normals estimate ";
  ASSERT_EQ(run(start + "-o relaxed.obj").status, 0);
  const Outcome result = run(start + "-o rigid.obj --keep-ripples --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Report report = Report::parse(text_of(path("r.json")));
  EXPECT_EQ(report.at("normals").at("energy").at("iterations"), 0);
  EXPECT_LT(report.at("normals").at("angle_after").at("max"), 1e-10);
  EXPECT_EQ(result.out.find("bending"), std::string::npos) << result.out;
  EXPECT_NE(text_of(path("rigid.obj")), text_of(path("relaxed.obj")));
}

TEST_F(NormalsTool, TellsWhatItLeavesAndWhatPointsInward) {
  Mesh mesh = leaning_torus();
  mesh.attributes[0].values *= -1.0;
  mesh.attributes[0].values.row(3).setZero();
  for (Index i = 0; i < 9; ++i) mesh.creases.push_back({7 * i, 7 * ((i + 1) % 9), 10.0});
  write_mesh(path("mesh.obj"), mesh);
  const Outcome result = run("interpolate mesh.obj --normals mesh -o out.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("53 turned, 0 right from the start, 1 not given"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("9 at creases"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("53 normals were off by more than 90 degrees"), std::string::npos) << result.out;
}

TEST_F(NormalsTool, SaysWhatIsWrong) {
  write_mesh(path("torus.obj"), torus(9, 7));
  write_mesh(path("other.obj"), leaning_torus());
  const auto error = [&](const std::string& arguments, int status) {
    const Outcome result = run("interpolate " + arguments + " -o out.obj");
    EXPECT_EQ(result.status, status) << arguments << result.err;
    return result.err;
  };
  EXPECT_NE(error("torus.obj --normals mesh", 1).find("torus.obj: has no normals"), std::string::npos);
  EXPECT_NE(error("torus.obj --normals torus.obj", 1).find("torus.obj: has no normals"), std::string::npos);
  EXPECT_NE(error(kModels + "cube.obj --normals other.obj", 1).find("other.obj: has 63 vertices"), std::string::npos);
  EXPECT_NE(error("torus.obj --normals none.obj", 1).find("none.obj"), std::string::npos);
  EXPECT_NE(error("torus.obj --normal-tolerance 1", 2).find("--normals"), std::string::npos);
  EXPECT_NE(error("torus.obj --normals estimate --normal-tolerance 200", 2).find("200"), std::string::npos);
  EXPECT_NE(error("torus.obj --picture a.png --color normals", 2).find("--normals"), std::string::npos);
  EXPECT_NE(error("torus.obj --triangulate --scheme butterfly --normals estimate", 1).find("Butterfly"),
            std::string::npos);
}

TEST_F(NormalsTool, DrawsAnglesAndBothSurfaces) {
  const std::string start = "interpolate " + kModels + "pipe-joint.obj --normals estimate --width 300 --picture ";
  for (const char* rest : {"a.png --color normals", "a.png --color normals --before-after",
                           "a.png --color mean --before-after", "a.png --before-after", "a.png"}) {
    fs::remove(path("a.png"));
    const Outcome result = run(start + rest);
    if (result.err.find("this build has no pictures") != std::string::npos) GTEST_SKIP() << result.err;
    EXPECT_EQ(result.status, 0) << rest << result.err;
    EXPECT_TRUE(fs::exists(path("a.png"))) << rest;
  }
}

TEST_F(NormalsTool, TheFairestSurfaceHasTheNormalsWanted) {
  const Outcome result =
      run("interpolate " + kModels + "icosahedron.obj --fair --normals estimate -o a.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("12 wanted"), std::string::npos) << result.out;
  const auto fair = nlohmann::json::parse(text_of(path("r.json"))).at("fair");
  EXPECT_EQ(fair.at("normals"), 12);
  EXPECT_LT(fair.at("max_angle"), 1e-8);
  const Mesh written = read_mesh(path("a.obj"));
  const Values normals = limit_normals(Topology(written), choose_scheme(written), written.points).vertices;
  const Mesh given = read_mesh(kModels + "icosahedron.obj");
  for (Index v = 0; v < 12; ++v) EXPECT_GT(normals.row(v).dot(given.points.row(v).normalized()), 1.0 - 1e-12) << v;
  EXPECT_EQ(run("interpolate " + kModels + "icosahedron.obj --fair --normals estimate --fair-levels 1 -o b.obj").status,
            1);
}

}  // namespace
}  // namespace batten::cli_tests
