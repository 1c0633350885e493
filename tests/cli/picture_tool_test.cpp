/// Which way is up, and what a picture leaves out.
#include <algorithm>

#include "batten/io/io.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using PictureTool = Tool;

const std::string kSmall = " --width 120 --samples 1";

TEST_F(PictureTool, LinesThatWouldHideTheSurfaceAreLeftOutAndThatIsSaidOnce) {
  ASSERT_EQ(run("subdivide " + kModels + "creature.obj --levels 3 -o fine.obj -q").status, 0);
  const std::string command = "render fine.obj -o a.png --flat --control --turntable 2 --width 200";
  const Outcome result = run(command);
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err.find("batten: a.png: the lines are not drawn: they would cover "), 0U) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(run(command + " --quiet").err, "");
  EXPECT_EQ(run("render " + kModels + "cube.obj -o b.png --control" + kSmall).err, "");
}

TEST_F(PictureTool, GlbAndUsdStandUpright) {
  const std::string creature = kModels + "creature.obj";  // stands on its feet with z up
  const auto height = [&](const std::string& name) {
    const Mesh mesh = read_mesh(path(name));
    return mesh.points.col(1).maxCoeff() - mesh.points.col(1).minCoeff();
  };
  const auto given = read_mesh(creature);
  const Eigen::RowVector3d size = given.points.colwise().maxCoeff() - given.points.colwise().minCoeff();
  ASSERT_EQ(run("convert " + creature + " -o a.glb").status, 0);
  EXPECT_NEAR(height("a.glb"), size[2], 1e-6);
  ASSERT_EQ(run("convert " + creature + " -o b.glb --up x").status, 0);
  EXPECT_NEAR(height("b.glb"), size[0], 1e-6);
  ASSERT_EQ(run("convert " + creature + " -o c.glb --up -y").status, 0);
  EXPECT_NEAR(height("c.glb"), size[1], 1e-6);
  for (const char* axis : {"y", "z"}) {
    ASSERT_EQ(run("subdivide " + creature + " -o d.usda --up " + axis).status, 0);
    const std::string line = std::string("upAxis = \"") + (*axis == 'y' ? "Y" : "Z") + "\"";
    EXPECT_NE(text_of(path("d.usda")).find(line), std::string::npos);
  }
  ASSERT_EQ(run("repair " + creature + " -o e.usda").status, 0);
  EXPECT_NE(text_of(path("e.usda")).find("upAxis = \"Z\""), std::string::npos);
}

TEST_F(PictureTool, EveryVerbTakesTheSameAxis) {
  const std::string tripod = kModels + "tripod.obj";
  ASSERT_EQ(run("render " + tripod + " -o guess.png --flat" + kSmall).status, 0);
  ASSERT_EQ(run("render " + tripod + " -o z.png --flat --up z" + kSmall).status, 0);
  ASSERT_EQ(run("render " + tripod + " -o x.png --flat --up x" + kSmall).status, 0);
  ASSERT_EQ(run("subdivide " + tripod + " --levels 0 --picture s.png" + kSmall).status, 0);
  EXPECT_EQ(text_of(path("guess.png")), text_of(path("z.png")));
  EXPECT_EQ(text_of(path("guess.png")), text_of(path("s.png")));
  EXPECT_NE(text_of(path("guess.png")), text_of(path("x.png")));
}

TEST_F(PictureTool, AnAxisWithoutAnEffectIsRefused) {
  const std::string tripod = kModels + "tripod.obj";
  for (const std::string rest : {"-o a.obj --up z", "-o a.glb --up w"}) {
    const Outcome result = run("convert " + tripod + " " + rest);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("--up"), std::string::npos) << result.err;
  }
  EXPECT_EQ(run("interpolate " + tripod + " --report r.json --up y").status, 2);
}

}  // namespace
}  // namespace batten::cli_tests
