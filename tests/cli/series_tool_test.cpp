/// The tool's verbs of the mesh series.
#include <cmath>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

TEST_F(Tool, DenoisesAndSaysWhatItFound) {
  const Outcome result =
      run("denoise " + kModels + "bracket-scan.obj --auto --features 40 -o clean.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("noise"), std::string::npos);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_NEAR(report["noise"].get<double>(), 0.012, 0.0015);  // as models/all_models.cpp made it
  EXPECT_GT(report["features"].size(), 500U);
  const Mesh before = read_mesh(kModels + "bracket-scan.obj");
  const Mesh after = read_mesh(path("clean.obj"));
  const double moved = (after.points - before.points).norm() / std::sqrt(before.vertex_count());
  EXPECT_NEAR(report["moved_rms"].get<double>(), moved, 1e-12);
  EXPECT_EQ(after.face_vertices, before.face_vertices);
}

TEST_F(Tool, DenoisesByAStrengthInEdgeLengths) {
  ASSERT_EQ(run("denoise " + kModels + "torus-knot.obj --strength 4 -o a.obj --report r.json").status, 0);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["passes"].get<int>(), 19);  // 1/3 of such a wave is lost at each application: (26/27)^19 < 1/2
  ASSERT_EQ(run("denoise " + kModels + "torus-knot.obj --passes 19 -o b.obj").status, 0);
  EXPECT_EQ(text_of(path("a.obj")), text_of(path("b.obj")));
  EXPECT_EQ(run("denoise " + kModels + "torus-knot.obj --passes 3 --auto").status, 2);
  EXPECT_EQ(run("denoise " + kModels + "torus-knot.obj --strength 1.5").status, 2);
  write("points.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const Outcome points = run("denoise points.xyz -o c.obj");
  EXPECT_EQ(points.status, 1);
  EXPECT_NE(points.err.find("no faces"), std::string::npos) << points.err;
}

}  // namespace
}  // namespace batten::cli_tests
