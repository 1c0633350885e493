/// The tool as a user meets it: exit codes, errors on stderr, files.
#include "cli/tool.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "batten/interpolate/interpolator.h"
#include "batten/io/io.h"

namespace batten::cli_tests {
namespace {

TEST_F(Tool, InterpolatesAndSaysHowExactly) {
  const Outcome result = run("interpolate " + kModels + "pipe-joint.obj -o new/control.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("max error"), std::string::npos);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_LE(report["max_error"].get<double>(), 1e-10 * report["diagonal"].get<double>());
  EXPECT_EQ(report["worst_vertices"].size(), 10U);
  const Mesh input = read_mesh(kModels + "pipe-joint.obj");
  const Mesh control = read_mesh(path("new/control.obj"));
  const Topology topology(control);
  const Values limit = LimitMatrix(topology, choose_scheme(control)).apply(control.points);
  EXPECT_LE((limit - input.points).rowwise().norm().maxCoeff(), 1.01e-10 * bounding_diagonal(input.points));
}

TEST_F(Tool, KeepsCreasesInTheControlMesh) {
  ASSERT_EQ(run("interpolate " + kModels + "bracket.obj -o control.obj --quiet").status, 0);
  const Mesh input = read_mesh(kModels + "bracket.obj");
  const Mesh control = read_mesh(path("control.obj"));
  EXPECT_GT(input.creases.size(), 0U);
  EXPECT_EQ(control.creases.size(), input.creases.size());
  const Topology topology(control);
  const Values limit = LimitMatrix(topology, choose_scheme(control)).apply(control.points);
  EXPECT_LE((limit - input.points).rowwise().norm().maxCoeff(), 1.01e-10 * bounding_diagonal(input.points));
}

TEST_F(Tool, WritesTheOnceRefinedMeshOfAPerturbedCube) {
  write("cube.obj",
        "v -1 -1 -1\nv 1.3 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
        "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  const Outcome result = run("interpolate cube.obj -o control.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("alpha = 1/2"), std::string::npos) << result.out;
  EXPECT_EQ(read_mesh(path("control.obj")).vertex_count(), 26);
  const Outcome refused = run("interpolate cube.obj -o other.obj --on-singular refuse");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("the component of vertex 0"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(path("other.obj")));
}

TEST_F(Tool, PipesFromStandardInputToStandardOutput) {
  const Outcome result = run("interpolate - --input-format obj -o - --output-format obj < " + kModels + "tripod.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  write("piped.obj", result.out);
  EXPECT_EQ(read_mesh(path("piped.obj")).face_count(), read_mesh(kModels + "tripod.obj").face_count());
  EXPECT_NE(result.err.find("max error"), std::string::npos);  // the table does not get into the mesh
}

TEST_F(Tool, SaysWhatAReaderSkips) {
  write("t.obj", "v 0 0 0 2\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string expected = "t.obj: weights w other than 1 are skipped: 1 (the first in line 1)";
  const Outcome result = run("convert t.obj -o t.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "batten: " + expected + "\n");
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json")))["notes"], nlohmann::json::array({expected}));
  EXPECT_EQ(run("convert t.obj -o t.ply --quiet").err, "");
  write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(run("convert plain.obj -o t.ply --report r.json").err, "");
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json")))["notes"], nlohmann::json::array());
}

TEST_F(Tool, SaysWhatTheOutputLoses) {
  const Outcome result = run("convert " + kModels + "bracket.obj -o b.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "batten: b.ply: lost: creases\n");
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json")))["lost"], nlohmann::json::array({"creases"}));
  EXPECT_EQ(run("convert " + kModels + "bracket.obj -o b.ply --quiet").err, "");
  EXPECT_EQ(run("convert " + kModels + "bracket.obj -o b.obj").err, "");
  EXPECT_EQ(run("interpolate " + kModels + "bracket.obj -o - --output-format off")
                .err.find("batten: standard output: lost: creases\n"),
            0U);
  EXPECT_EQ(run("repair " + kModels + "bracket.obj -o b.off --report r.json").err, "batten: b.off: lost: creases\n");
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json")))["lost"], nlohmann::json::array({"creases"}));
}

TEST_F(Tool, SubdividesToTheLimitWithNormals) {
  ASSERT_EQ(run("subdivide " + kModels + "icosahedron.obj --levels 2 --limit -o fine.ply").status, 0);
  const Mesh fine = read_mesh(path("fine.ply"));
  EXPECT_EQ(fine.vertex_count(), 162);
  ASSERT_EQ(fine.attributes.size(), 1U);
  EXPECT_EQ(fine.attributes[0].name, "normal");
  // By symmetry the normal at an icosahedron's vertex points from the centre.
  const Eigen::RowVector3d point = fine.points.row(0);
  // The model has six decimals.
  EXPECT_LT((point.normalized() - fine.attributes[0].values.row(0)).norm(), 1e-6);
}

TEST_F(Tool, RefusesLoopOnQuadsWithTheHint) {
  const Outcome result = run("interpolate " + kModels + "tripod.obj -o x.obj --scheme loop");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("--triangulate"), std::string::npos) << result.err;
  EXPECT_EQ(run("interpolate " + kModels + "tripod.obj -o x.obj --scheme loop --triangulate").status, 0);
}

TEST_F(Tool, WrongUsageIsExitCodeTwo) {
  EXPECT_EQ(run("interpolate").status, 2);
  EXPECT_EQ(run("frobnicate x.obj").status, 2);
  EXPECT_EQ(run("interpolate x.obj --scheme cubic").status, 2);
  EXPECT_EQ(run("--help").status, 0);
}

TEST_F(Tool, ErrorsAreOneLineWithFileAndElement) {
  write("bad.obj", "v 0 0 0\nv 1 0 zero\nf 1 2 3\n");
  write("fin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
  write("points.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  for (const auto& expected :
       {std::pair("points.xyz", "there are no faces"), std::pair("bad.obj", "bad.obj:2"),
        std::pair("fin.obj", "edge (0, 1) has 3 faces"), std::pair("missing.obj", "missing.obj")}) {
    const Outcome result = run(std::string("interpolate ") + expected.first + " -o x.obj");
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find(expected.second), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(path("x.obj")));
  }
}

TEST_F(Tool, AFailureLeavesTheOldOutput) {
  write("old.obj", "# precious\n");
  write("bad.obj", "v 0 0\n");
  EXPECT_EQ(run("interpolate bad.obj -o old.obj").status, 1);
  EXPECT_EQ(text_of(path("old.obj")), "# precious\n");
}

TEST_F(Tool, PlotsTheResidualWhereItWasMeasured) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj --plot new/plot.svg --report r.json").status, 0);
  EXPECT_NE(text_of(path("new/plot.svg")).find("</svg>"), std::string::npos);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  const auto after = report["measured_after"].get<std::vector<int>>();
  ASSERT_EQ(after.size(), report["residual_history"].size());
  EXPECT_EQ(after.front(), 0);
  EXPECT_EQ(after.back(), report["iterations"].get<int>());
  EXPECT_TRUE(std::is_sorted(after.begin(), after.end()));
  EXPECT_EQ(run("interpolate " + kModels + "creature.obj --plot plot.jpg").status, 2);
}

TEST_F(Tool, ComparesTheMethods) {
  const Outcome result =
      run("interpolate " + kModels + "creature.obj --compare-methods --plot methods.svg --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(text_of(path("methods.svg")).find("</svg>"), std::string::npos);
  const auto methods = nlohmann::json::parse(text_of(path("r.json")))["compared_methods"];
  ASSERT_EQ(methods.size(), 4U);
  for (const auto& method : methods) {
    const auto name = method["name"].get<std::string>();
    EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
    EXPECT_TRUE(method["converged"].get<bool>()) << name;
  }
  EXPECT_LT(3 * methods[0]["iterations"].get<int>(), methods[1]["iterations"].get<int>());
  EXPECT_LT(methods[1]["iterations"].get<int>(), methods[2]["iterations"].get<int>());
}

/// Width, height and channels of a PNG; zeros for another file.
std::array<int, 3> png_shape(const std::string& path) {
  const std::string bytes = text_of(path);
  if (bytes.size() < 26 || bytes.compare(1, 3, "PNG") != 0) return {0, 0, 0};
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  return {number(16), number(20), bytes[25] == 6 ? 4 : 3};
}

TEST_F(Tool, PicturesHaveTheSizeThatWasAskedFor) {
  using Shape = std::array<int, 3>;
  const std::string small = " --width 161 --samples 1";
  const std::string control = kModels + "tripod.obj";
  ASSERT_EQ(run("render " + control + " -o a.png --view left --transparent" + small).status, 0);
  EXPECT_EQ(png_shape(path("a.png")), (Shape{161, 120, 4}));
  ASSERT_EQ(run("interpolate " + control + " --picture new/b.png --before-after --color mean" + small).status, 0);
  EXPECT_EQ(png_shape(path("new/b.png")), (Shape{161, 60, 3}));
  ASSERT_EQ(run("subdivide " + control + " --picture c.png --before-after --view 1,-2,0.5" + small).status, 0);
  EXPECT_EQ(png_shape(path("c.png")), (Shape{161, 60, 3}));
  ASSERT_EQ(run("render " + control + " -o d.png --turntable 3 --height 100" + small).status, 0);
  for (const char* name : {"d-000.png", "d-001.png", "d-002.png"})
    EXPECT_EQ(png_shape(path(name)), (Shape{161, 100, 3})) << name;
  EXPECT_FALSE(fs::exists(path("d.png")));
  EXPECT_NE(text_of(path("d-000.png")), text_of(path("d-001.png")));
}

TEST_F(Tool, EveryColourDraws) {
  for (const char* color : {"moved", "mean", "gaussian", "valence", "sharpness", "zebra"}) {
    const Outcome result = run("render " + kModels + "bracket.obj -o " + color +
                               ".png --levels 2 --width 200 --samples 1 --color " + color);
    EXPECT_EQ(result.status, 0) << color << result.err;
    EXPECT_EQ(png_shape(path(std::string(color) + ".png"))[0], 200);
  }
  const std::string flat = "render " + kModels + "bracket.obj -o f.png --flat --width 200 --samples 1 --color ";
  EXPECT_EQ(run(flat + "valence").status, 0);
  const Outcome curved = run(flat + "mean");
  EXPECT_EQ(curved.status, 1);
  EXPECT_NE(curved.err.find("--flat"), std::string::npos) << curved.err;
}

TEST_F(Tool, TexturesGoIntoFilesAndPictures) {
  const std::string marble = "texture " + kModels + "tripod.obj --levels 2 --preset marble ";
  ASSERT_EQ(run(marble + "-o a.ply --report r.json --picture a.png --width 161 --samples 1").status, 0);
  ASSERT_EQ(run(marble + "-o b.ply --threads 1").status, 0);
  EXPECT_EQ(text_of(path("a.ply")), text_of(path("b.ply")));
  const Mesh colored = read_mesh(path("a.ply"));
  const auto color = std::find_if(colored.attributes.begin(), colored.attributes.end(),
                                  [](const Attribute& attribute) { return attribute.name == "color"; });
  ASSERT_NE(color, colored.attributes.end());
  EXPECT_GT(color->values.maxCoeff() - color->values.minCoeff(), 0.3);
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json")))["texture"], "marble");
  // Whoever draws the file sees the colours.
  const std::string picture = " --flat --width 161 --samples 1";
  ASSERT_EQ(run("render a.ply -o drawn.png" + picture).status, 0);
  ASSERT_EQ(run("texture " + kModels + "tripod.obj --levels 2 --seed 2 -o c.ply").status, 0);
  ASSERT_EQ(run("render c.ply -o other.png" + picture).status, 0);
  EXPECT_NE(text_of(path("drawn.png")), text_of(path("other.png")));
}

TEST_F(Tool, DrawsAllTexturesSideBySide) {
  const std::string gallery = "texture " + kModels + "tripod.obj --levels 1 --gallery g.png --samples 1 ";
  ASSERT_EQ(run(gallery + "--width 500 --height 100").status, 0);
  EXPECT_EQ(png_shape(path("g.png")), (std::array<int, 3>{500, 100, 3}));
}

TEST_F(Tool, MorphsFromOneMeshToTheOther) {
  const std::string ends = kModels + "creature.obj " + kModels + "creature-ball.obj ";
  const Outcome result = run("morph " + ends + "-o f.ply --frames 3 --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(read_mesh(path("f-000.ply")).points, read_mesh(kModels + "creature.obj").points);
  EXPECT_EQ(read_mesh(path("f-002.ply")).points, read_mesh(kModels + "creature-ball.obj").points);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  ASSERT_EQ(report["frames"].size(), 3U);
  EXPECT_EQ(report["frames"][2]["rms_to_end"], 0.0);
  EXPECT_GT(report["frames"][1]["rms_to_end"], 0.0);
  ASSERT_EQ(run("morph " + ends + "-o at.ply --at 0.5 --quiet").status, 0);
  EXPECT_EQ(text_of(path("at.ply")), text_of(path("f-001.ply")));
  ASSERT_EQ(run("morph " + ends + "-o s.ply --rho 0.5 --frames 2 --picture s.png --width 200 --samples 1").status, 0);
  EXPECT_EQ(png_shape(path("s.png")), (std::array<int, 3>{200, 75, 3}));
  EXPECT_EQ(run("morph " + ends + "-o m.glb --levels 1").status, 0);
  EXPECT_EQ(text_of(path("m.glb")).compare(0, 4, "glTF"), 0);
}

TEST_F(Tool, SaysWhatAMorphNeeds) {
  const std::string creature = "morph " + kModels + "creature.obj ";
  const Outcome other = run(creature + kModels + "tripod.obj -o m.ply");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("602 vertices"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("--resample"), std::string::npos) << other.err;
  const Outcome far = run(creature + kModels + "torus-knot.obj -o m.ply --resample");
  EXPECT_EQ(far.status, 1);
  EXPECT_NE(far.err.find("from the other surface"), std::string::npos) << far.err;
  EXPECT_EQ(run(creature + kModels + "creature-ball.obj --at 0.5 --frames 3").status, 2);
}

TEST_F(Tool, RefusesColoursAndPresetsThatAreNone) {
  const std::string command = "texture " + kModels + "cube.obj -o x.ply ";
  EXPECT_EQ(run(command + "--preset leather").status, 2);
  const Outcome result = run(command + "--colors ff8800,blue");
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("'blue' is not a colour like ff8800"), std::string::npos) << result.err;
  EXPECT_EQ(run(command + "--flat --levels 2").status, 2);
  EXPECT_FALSE(fs::exists(path("x.ply")));
}

TEST_F(Tool, ErrorNeedsTargets) {
  const std::string picture = "render " + kModels + "tripod.obj -o e.png --width 200 --samples 1 --color error";
  const Outcome without = run(picture);
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.err.find("--targets"), std::string::npos) << without.err;
  EXPECT_EQ(run(picture + " --targets " + kModels + "tripod.obj").status, 0);
  const Outcome other = run(picture + " --targets " + kModels + "creature.obj");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("more targets"), std::string::npos) << other.err;
}

TEST_F(Tool, RefusesViewsThatAreNone) {
  for (const char* view : {"upwards", "1,2", "1,2,3,4", "a,b,c", "0,0,0"})
    EXPECT_NE(run("render " + kModels + "cube.obj -o v.png --view " + view).status, 0) << view;
  EXPECT_FALSE(fs::exists(path("v.png")));
}

TEST_F(Tool, SaysWhenTheToleranceWasNotReached) {
  const Outcome result = run("interpolate " + kModels + "creature.obj -o x.obj --method jacobi --max-iterations 8");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("was not reached"), std::string::npos) << result.err;
}

TEST_F(Tool, RepairsAndSaysEachChange) {
  write("fin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
  const Outcome refused = run("interpolate fin.obj -o x.obj");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("--repair"), std::string::npos) << refused.err;
  const Outcome result = run("repair fin.obj -o mended.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("split 1 edge of more than two faces: (0, 1)"), std::string::npos) << result.out;
  const auto repairs = nlohmann::json::parse(text_of(path("r.json")))["repairs"];
  EXPECT_EQ(repairs["changes"][0]["kind"], "split-edges");
  EXPECT_EQ(repairs["changes"][0]["elements"], nlohmann::json({0, 1}));
  EXPECT_EQ(repairs["vertex_sources"].size(), static_cast<std::size_t>(read_mesh(path("mended.obj")).vertex_count()));
  const Outcome whole = run("interpolate fin.obj -o x.obj --repair --report i.json");
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_NE(whole.out.find("split 1 edge"), std::string::npos) << whole.out;
  EXPECT_EQ(nlohmann::json::parse(text_of(path("i.json")))["repairs"], repairs);
  EXPECT_EQ(run("repair mended.obj -o again.obj").out.find("split"), std::string::npos);
  EXPECT_EQ(text_of(path("again.obj")), text_of(path("mended.obj")));
}

TEST_F(Tool, RepairWeldsAsFarAsAsked) {
  write("seam.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0.001\nv 1 1 0\nv 0 1 0.001\nf 1 2 3\nf 4 5 6\n");
  for (const auto& expected : {std::pair("", 6), std::pair(" --weld 0.01", 4), std::pair(" --no-weld", 6)}) {
    ASSERT_EQ(run(std::string("repair seam.obj -o welded.obj") + expected.first).status, 0);
    EXPECT_EQ(read_mesh(path("welded.obj")).vertex_count(), expected.second) << expected.first;
  }
  EXPECT_EQ(run("repair seam.obj --weld 2").status, 2);
}

TEST_F(Tool, InfoNamesWhatIsWrong) {
  const Outcome good = run("info " + kModels + "torus-knot.obj");
  EXPECT_EQ(good.status, 0);
  EXPECT_NE(good.out.find("genus"), std::string::npos);
  write("fin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
  const Outcome bad = run("info fin.obj --report r.json");
  EXPECT_NE(bad.out.find("1 edge of more than two faces"), std::string::npos) << bad.out;
  EXPECT_NE(bad.out.find("edge (0, 1) has 3 faces"), std::string::npos) << bad.out;
  EXPECT_NE(bad.out.find("--repair would have  split 1 edge"), std::string::npos) << bad.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["problems"][0]["kind"], "non-manifold-edge");
  EXPECT_EQ(report["problems"][0]["count"], 1);
  EXPECT_EQ(report["repair_would"][0]["kind"], "split-edges");
}

TEST_F(Tool, InfoDescribesTheMeshAndChecksItself) {
  ASSERT_EQ(run("info " + kModels + "pipe-joint.obj --report r.json").status, 0);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_TRUE(report["problems"].empty());
  EXPECT_EQ(report["components"][0]["boundary_loops"], 4);
  EXPECT_EQ(report["components"][0]["genus"], 0);
  EXPECT_EQ(report["boundary_edges"], 48);
  EXPECT_EQ(report["interpolation"]["singular_components"], 0);
  EXPECT_LE(report["interpolation"]["relative_error"].get<double>(), 1e-10);
  const Outcome cube = run("info " + kModels + "cube.obj");
  EXPECT_NE(cube.out.find("1 component is singular"), std::string::npos) << cube.out;
}

TEST_F(Tool, ConvertsBetweenAllFormats) {
  ASSERT_EQ(run("convert " + kModels + "icosahedron.obj -o a.ply").status, 0);
  ASSERT_EQ(run("convert a.ply -o b.off").status, 0);
  ASSERT_EQ(run("convert b.off -o c.obj").status, 0);
  EXPECT_EQ(read_mesh(path("c.obj")).points, read_mesh(kModels + "icosahedron.obj").points);
}

TEST_F(Tool, AGlbHoldsTheSurfaceItself) {
  const Outcome result = run("interpolate " + kModels + "pipe-joint.obj -o new/surface.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("the limit surface refined to 3 levels, "), std::string::npos) << result.out;
  EXPECT_EQ(text_of(path("new/surface.glb")).substr(0, 4), "glTF");
}

TEST_F(Tool, ARefinedResultPassesThroughThePoints) {
  ASSERT_EQ(run("interpolate " + kModels + "pipe-joint.obj -o surface.ply --levels 1").status, 0);
  const Mesh input = read_mesh(kModels + "pipe-joint.obj");
  const Mesh surface = read_mesh(path("surface.ply"));
  EXPECT_EQ(surface.face_count(), 4 * input.face_count());
  const Values miss = surface.points.topRows(input.vertex_count()) - input.points;
  EXPECT_LE(miss.rowwise().norm().maxCoeff(), 1.01e-10 * bounding_diagonal(input.points));
}

TEST_F(Tool, UsdaNamesTheSchemeThatWasUsed) {
  ASSERT_EQ(run("interpolate " + kModels + "icosahedron.obj -o a.usda").status, 0);
  ASSERT_EQ(run("interpolate " + kModels + "icosahedron.obj --scheme catmull-clark -o b.usda").status, 0);
  EXPECT_NE(text_of(path("a.usda")).find("subdivisionScheme = \"loop\""), std::string::npos);
  EXPECT_NE(text_of(path("b.usda")).find("subdivisionScheme = \"catmullClark\""), std::string::npos);
  ASSERT_EQ(run("subdivide " + kModels + "icosahedron.obj --limit -o c.usda").status, 0);
  EXPECT_NE(text_of(path("c.usda")).find("subdivisionScheme = \"none\""), std::string::npos);
}

TEST_F(Tool, ColoursOfTheSurfaceAreThoseOfThePoints) {
  Mesh mesh = read_mesh(kModels + "pipe-joint.obj");
  mesh.attributes = {{"color", mesh.points.array().sin().abs(), {}}};
  write_mesh(path("colours.ply"), mesh);
  ASSERT_EQ(run("interpolate colours.ply -o control.ply").status, 0);
  ASSERT_EQ(run("subdivide control.ply --levels 2 --limit -o surface.ply").status, 0);
  const Mesh surface = read_mesh(path("surface.ply"));
  const auto color = std::find_if(surface.attributes.begin(), surface.attributes.end(),
                                  [](const Attribute& attribute) { return attribute.name == "color"; });
  ASSERT_NE(color, surface.attributes.end());
  const Values miss = color->values.topRows(mesh.vertex_count()) - mesh.attributes[0].values;
  // The tolerance is one of the points' diagonal of about 9; colours are solved with the same one.
  EXPECT_LE(miss.cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(Tool, SubdivisionKeepsTextureAndMaterials) {
  write("quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3 4/4\nusemtl red\nf 2/1 5/2 6/3 3/4\n");
  ASSERT_EQ(run("subdivide quad.obj --levels 1 -o fine.obj").status, 0);
  const Mesh fine = read_mesh(path("fine.obj"));
  ASSERT_EQ(fine.attributes.size(), 1U);
  // Four corners, four edges on the one side and four on the other, two centres.
  EXPECT_EQ(fine.attributes[0].values.rows(), 14);
  EXPECT_EQ(fine.groups[0].first_face, 4);
}

TEST(Readme, ItsProgramIsTheExampleThatTheBuildCompiles) {
  const std::string program = text_of(BATTEN_SOURCE_DIR "/examples/interpolate.cpp");
  EXPECT_NE(text_of(BATTEN_SOURCE_DIR "/README.md").find("```cpp\n" + program + "```"), std::string::npos);
}

}  // namespace
}  // namespace batten::cli_tests
