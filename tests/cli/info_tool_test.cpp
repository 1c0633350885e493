/// What info tells of a mesh, and what every verb says of open seams.
#include <nlohmann/json.hpp>

#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using Json = nlohmann::json;

/// A box of 1 by 2 by 3 with colours, texture coordinates, two groups and two materials.
const char* const kBrick =
    "mtllib paints.mtl\n"
    "v 5 5 5 1 0 0\nv 6 5 5 0 1 0\nv 6 7 5 0 0 1\nv 5 7 5 0 0 0\nv 5 5 8 1 1 0\nv 6 5 8 0 1 1\nv 6 7 8 1 0 1\n"
    "v 5 7 8 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "g walls\nusemtl red\nf 1/1 4/2 3/3 2/4\nf 5/1 6/2 7/3 8/4\nusemtl blue\nf 1/1 2/2 6/3 5/4\n"
    "g roof\nusemtl red\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n";

TEST_F(Tool, InfoTellsSizesValuesAndGroups) {
  write("brick.obj", kBrick);
  const Outcome result = run("info brick.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* row :
       {"1 x 2 x 3, from (5, 5, 5) to (6, 7, 8)\n", "22\n", "6, of 1 closed component\n", "1 to 3, mean 2\n",
        "4 at corners\n", "8 at vertices\n", "2: walls, roof\n", "2: red, blue\n"})
    EXPECT_NE(result.out.find(std::string("  ") + row), std::string::npos) << row << result.out;
  const Json report = Json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["box"]["high"], Json({6, 7, 8}));
  EXPECT_NEAR(report["area"].get<double>(), 22.0, 1e-12);
  EXPECT_NEAR(report["volume"].get<double>(), 6.0, 1e-12);
  EXPECT_EQ(report["edge_lengths"]["longest"], 3.0);
  EXPECT_EQ(report["groups"]["usemtl"], Json({"red", "blue"}));
  EXPECT_EQ(report["material_libraries"], Json({"paints.mtl"}));
  EXPECT_EQ(report["attributes"].size(), 2U);
}

TEST_F(Tool, InfoTellsLengthsWhoseSquaresDoublesCannotHold) {
  write("huge.obj", "v 0 0 0\nv 3e200 0 0\nv 0 4e200 0\nf 1 2 3\n");
  const Outcome result = run("info huge.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* row : {"3e+200 to 5e+200, mean 4e+200\n", "too large for doubles; scale the mesh down\n"})
    EXPECT_NE(result.out.find(row), std::string::npos) << row << result.out;
  EXPECT_EQ(result.out.find("inf "), std::string::npos) << result.out;
  EXPECT_EQ(run("morph huge.obj huge.obj --seconds 1e300 -o film.glb").status, 2);
}

TEST_F(Tool, InfoTellsNoVolumeOfAnOpenMesh) {
  const Outcome result = run("info " + kModels + "pipe-joint.obj --report r.json");
  EXPECT_EQ(result.out.find("volume"), std::string::npos) << result.out;
  EXPECT_EQ(Json::parse(text_of(path("r.json")))["closed_components"], 0);
}

TEST_F(Tool, InfoSaysWhenThereWasNothingToSolve) {
  write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nt interpolateboundary 1/0/0 1\n");
  const Outcome result = run("info quad.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find("none needed"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("found again without solving anything, to 0 of the diagonal"), std::string::npos)
      << result.out;
}

/// A cube whose faces have vertices of their own.
const char* const kLooseCube =
    "v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n"
    "v 1 0 0\nv 1 1 0\nv 1 1 1\nv 1 0 1\nv 1 1 0\nv 0 1 0\nv 0 1 1\nv 1 1 1\nv 0 1 0\nv 0 0 0\nv 0 0 1\nv 0 1 1\n"
    "f 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\nf 13 14 15 16\nf 17 18 19 20\nf 21 22 23 24\n";

TEST_F(Tool, EveryVerbThatMakesASurfaceTellsOfOpenSeams) {
  write("loose.obj", kLooseCube);
  const std::string line = "batten: 16 vertices of open edges lie on others: seams stay open; --repair welds them\n";
  const std::string small = " --width 32 --height 32 --samples 1 ";
  for (const std::string command :
       {"interpolate loose.obj -o a.obj", "subdivide loose.obj -o a.obj", "subdivide loose.obj --chord 5% -o a.obj",
        "denoise loose.obj -o a.obj", "sharpen loose.obj -o a.obj", "bands loose.obj -o a.obj",
        "texture loose.obj --levels 1 -o a.ply", "distance loose.obj loose.obj",
        "morph loose.obj loose.obj --at 0.5 -o a.obj"}) {
    const Outcome result = run(command + " --report r.json");
    EXPECT_EQ(result.status, 0) << command << result.err;
    EXPECT_NE(result.err.find(line), std::string::npos) << command << result.err;
    EXPECT_EQ(Json::parse(text_of(path("r.json")))["coincident_boundary_vertices"], 16) << command;
    EXPECT_EQ(run(command + " --quiet").err, "") << command;
  }
  EXPECT_EQ(run("render loose.obj -o a.png" + small).err, line);
  EXPECT_EQ(run("render loose.obj --flat -o a.png" + small).err, "");
  EXPECT_EQ(run("interpolate loose.obj --repair -o a.obj --on-singular alpha").err, "");
  EXPECT_EQ(run("subdivide " + kModels + "pipe-joint.obj -o a.obj").err, "");
  const Outcome info = run("info loose.obj");
  EXPECT_NE(info.out.find("seams stay open"), std::string::npos) << info.out;
}

/// An icosahedron's Loop surface is round enough for its curvature to be positive everywhere.
TEST_F(Tool, InfoWritesTheCurvatureAtTheVertices) {
  ASSERT_EQ(run("subdivide " + kModels + "creature-ball.obj -o ball.obj").status, 0);
  const Outcome result = run("info ball.obj --curvature -o ball.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("mean curvature"), std::string::npos) << result.out;
  const Json report = Json::parse(text_of(path("r.json")));
  const Json& mean = report["mean_curvature"];
  EXPECT_EQ(mean["values"].size(), report["vertices"].get<std::size_t>());
  EXPECT_LE(mean["low"].get<double>(), mean["median"].get<double>());
  EXPECT_EQ(report["gaussian_curvature"]["values"].size(), mean["values"].size());
  EXPECT_NE(text_of(path("ball.ply")).find("property double mean_curvature"), std::string::npos);
  for (const std::string name : {"ball-colours.obj", "ball.glb"}) {
    const Outcome colours = run("info ball.obj --curvature -o " + name);
    EXPECT_EQ(colours.status, 0) << colours.err;
    EXPECT_NE(colours.out.find("the mean curvature, blue for"), std::string::npos) << colours.out;
  }
  EXPECT_NE(text_of(path("ball.glb")).find("_MEAN_CURVATURE"), std::string::npos);
  EXPECT_EQ(run("info ball.obj -o ball.ply").status, 2);
  write("bow.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  EXPECT_EQ(run("info bow.obj --curvature").status, 1);
}

TEST_F(Tool, RenderDrawsTheNumbersOfAFile) {
  const std::string small = " --width 64 --height 48 --samples 1 ";
  ASSERT_EQ(run("info " + kModels + "creature.obj --curvature -o c.ply").status, 0);
  const std::string render = "render " + kModels + "creature.obj -o a.png --values c.ply" + small;
  const Outcome several = run(render);
  EXPECT_EQ(several.status, 1);
  EXPECT_NE(several.err.find("say by --value which numbers to draw; the file has mean_curvature, gaussian_curvature"),
            std::string::npos)
      << several.err;
  const Outcome other = run(render + "--value height");
  EXPECT_NE(other.err.find("there is no value 'height'"), std::string::npos) << other.err;
  EXPECT_EQ(run(render + "--value mean_curvature").status, 0);
  const std::string fitted = text_of(path("a.png"));
  EXPECT_EQ(run(render + "--value mean_curvature --range -1:200").status, 0);
  EXPECT_NE(text_of(path("a.png")), fitted);
  EXPECT_EQ(run(render + "--value gaussian_curvature --flat").status, 0);
  const Outcome another =
      run("render " + kModels + "tripod.obj -o a.png --values c.ply --value mean_curvature" + small);
  EXPECT_EQ(another.status, 1);
  EXPECT_NE(another.err.find("both files must have the same vertices"), std::string::npos) << another.err;
}

TEST_F(Tool, InfoCountsSelfIntersections) {
  // Two triangles that pass through each other, and one apart.
  write("cross.obj",
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 3 3 0.5\nv 9 9 9\nv 8 9 9\nv 9 8 9\n"
        "f 1 2 3\nf 4 5 6\nf 7 8 9\n");
  const Outcome result = run("info cross.obj --report r.json");
  EXPECT_NE(result.out.find("1 pair of triangles passes through each other, the first in faces 0 and 1"),
            std::string::npos)
      << result.out;
  EXPECT_EQ(Json::parse(text_of(path("r.json")))["self_intersections"]["triangle_pairs"], 1);
  EXPECT_EQ(run("info " + kModels + "creature.obj").out.find("intersections"), std::string::npos);
}

/// A cube of 6 by 6 squares a side: its edges are found by their angle.
TEST_F(Tool, EveryVerbThatMakesASurfaceFindsSharpEdges) {
  write("cube.obj", kLooseCube);
  ASSERT_EQ(run("subdivide cube.obj --repair --levels 0 -o whole.obj").status, 0);
  for (const std::string command :
       {"interpolate whole.obj -o a.obj", "subdivide whole.obj -o a.obj", "subdivide whole.obj --chord 5% -o a.obj",
        "denoise whole.obj -o a.obj", "sharpen whole.obj -o a.obj", "bands whole.obj -o a.obj",
        "texture whole.obj --levels 1 -o a.ply", "distance whole.obj whole.obj",
        "morph whole.obj whole.obj --at 0.5 -o a.obj",
        "render whole.obj -o a.png --width 32 --height 32 --samples 1"}) {
    const Outcome result = run(command + " --auto-creases 40 --report r.json");
    ASSERT_EQ(result.status, 0) << command << result.err;
    EXPECT_NE(result.out.find("12 sharp edges of over 40 degrees"), std::string::npos) << command << result.out;
    EXPECT_EQ(Json::parse(text_of(path("r.json")))["features"].size(), 12U) << command;
  }
  ASSERT_EQ(run("subdivide whole.obj --features 40 -o sharp.obj").status, 0);
  EXPECT_NE(text_of(path("sharp.obj")).find("t crease"), std::string::npos);
  ASSERT_EQ(run("subdivide whole.obj --features 100 -o round.obj").status, 0);
  EXPECT_EQ(text_of(path("round.obj")).find("t crease"), std::string::npos);
}

}  // namespace
}  // namespace batten::cli_tests
