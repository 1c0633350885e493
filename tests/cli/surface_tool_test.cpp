/// The tool on limit surfaces: adaptive tessellation, distances.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

TEST_F(Tool, TessellatesToAChordTolerance) {
  const std::string command = "subdivide " + kModels + "creature.obj --chord 0.5% ";
  const Outcome result = run(command + "-o quads.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("all quads"), std::string::npos) << result.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  const double asked = report["chord"]["asked"].get<double>();
  EXPECT_NEAR(asked, 0.005 * bounding_diagonal(read_mesh(kModels + "creature.obj").points), 1e-12);
  EXPECT_LE(report["chord"]["measured"].get<double>(), asked);
  EXPECT_GT(report["chord"]["measured"].get<double>(), 0.1 * asked);
  const Mesh quads = read_mesh(path("quads.ply"));
  EXPECT_EQ(quads.face_vertices.size(), 4 * static_cast<std::size_t>(quads.face_count()));
  EXPECT_EQ(run(command + "--faces triangles -o triangles.ply").status, 0);
  EXPECT_TRUE(all_triangles(read_mesh(path("triangles.ply"))));
  EXPECT_EQ(run(command + "--edge-length 0.2 --angle 15 -o both.ply").status, 0);
  EXPECT_EQ(run(command + "--max-faces 100 -o few.ply").status, 1);
  for (const char* wrong : {"--chord 0", "--chord -1", "--chord 3x", "--chord nan", "--angle 0", "--faces quads"}) {
    EXPECT_EQ(run("subdivide " + kModels + "cube.obj -o x.ply " + wrong).status, 2) << wrong;
  }
}

/// A cube of side 2 with sharp edges is its own surface.
const std::string kSharpCube =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    "t crease 2/1/0 0 1 10\nt crease 2/1/0 1 2 10\nt crease 2/1/0 2 3 10\nt crease 2/1/0 3 0 10\n"
    "t crease 2/1/0 4 5 10\nt crease 2/1/0 5 6 10\nt crease 2/1/0 6 7 10\nt crease 2/1/0 7 4 10\n"
    "t crease 2/1/0 0 4 10\nt crease 2/1/0 1 5 10\nt crease 2/1/0 2 6 10\nt crease 2/1/0 3 7 10\n";

TEST_F(Tool, AdaptiveMeshesKeepTextureCoordinatesAndMaterials) {
  write("square.obj",
        "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 1\nv 0 1 0\nv 1 1 0\nv 2 1 1\n"
        "vt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 1\nvt 0.5 1\nvt 1 1\nvt 0.25 0.25\n"
        "usemtl red\nf 1/1 2/2 5/5 4/4\nusemtl blue\nf 2/7 3/3 6/6 5/5\n");
  const Outcome result = run("subdivide square.obj --chord 1% -o fine.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const Mesh fine = read_mesh(path("fine.obj"));
  ASSERT_EQ(fine.groups.size(), 2U);
  EXPECT_EQ(fine.groups[1].name, "blue");
  EXPECT_EQ(fine.material_libraries, std::vector<std::string>{"paint.mtl"});
  const auto uv = std::find_if(fine.attributes.begin(), fine.attributes.end(),
                               [](const Attribute& a) { return a.name == "uv" && a.per_corner(); });
  ASSERT_NE(uv, fine.attributes.end());
  // Vertex 1 stands on the seam: its red faces have its first texture coordinates, its blue ones the other.
  for (std::size_t c = 0; c < fine.face_vertices.size(); ++c) {
    if (fine.face_vertices[c] != 1) continue;
    const bool red = static_cast<Index>(c) < fine.face_offsets[fine.groups[1].first_face];
    const Eigen::RowVector2d expected = red ? Eigen::RowVector2d(0.5, 0.0) : Eigen::RowVector2d(0.25, 0.25);
    EXPECT_EQ(Eigen::RowVector2d(uv->values.row(uv->corner_rows[c])), expected);
  }
}

TEST_F(Tool, ModifiedButterflyKeepsTheVerticesAndTellsNormals) {
  write("octahedron.obj",
        "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n"
        "f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  const Outcome result =
      run("subdivide octahedron.obj --scheme modified-butterfly --levels 3 --limit -o fine.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("Modified Butterfly"), std::string::npos) << result.out;
  const Mesh coarse = read_mesh(path("octahedron.obj"));
  const Mesh fine = read_mesh(path("fine.ply"));
  EXPECT_EQ(fine.face_count(), 8 * 64);
  EXPECT_LT((fine.points.topRows(6) - coarse.points).cwiseAbs().maxCoeff(), 1e-7);
  const auto normals = std::find_if(fine.attributes.begin(), fine.attributes.end(),
                                    [](const Attribute& attribute) { return attribute.name == "normal"; });
  ASSERT_NE(normals, fine.attributes.end());
  EXPECT_LT((normals->values.topRows(6) - coarse.points).cwiseAbs().maxCoeff(), 1e-6);  // outward
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report.at("scheme").at("kind"), "modified-butterfly");
}

TEST_F(Tool, AdaptiveButterflyMeetsAnAngle) {
  const std::string command = "subdivide " + kModels + "pipe-joint.obj --triangulate --scheme modified-butterfly ";
  const Outcome result = run(command + "--angle 20 --levels 4 -o fine.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_LE(report.at("angle").at("widest").get<double>(), 20.0);
  EXPECT_EQ(report.at("chord").at("measured"), nullptr);
  const Outcome chord = run(command + "--chord 1% -o other.ply");
  EXPECT_EQ(chord.status, 1);
  EXPECT_NE(chord.err.find("take an edge length or an angle"), std::string::npos) << chord.err;
}

TEST_F(Tool, ButterflyAsksForTriangles) {
  const Outcome quads = run("subdivide " + kModels + "tripod.obj --scheme butterfly -o fine.obj");
  EXPECT_EQ(quads.status, 1);
  EXPECT_NE(quads.err.find("--triangulate"), std::string::npos) << quads.err;
  const Outcome split = run("subdivide " + kModels + "tripod.obj --scheme butterfly --triangulate -o fine.usda");
  EXPECT_EQ(split.status, 0) << split.err;
  EXPECT_NE(text_of(path("fine.usda")).find("subdivisionScheme = \"none\""), std::string::npos);
  const Outcome curved =
      run("render " + kModels + "tripod.obj --scheme butterfly --triangulate --color mean -o picture.png");
  EXPECT_EQ(curved.status, 1);
  EXPECT_NE(curved.err.find("no curvature"), std::string::npos) << curved.err;
}

TEST_F(Tool, ComparesFiveSurfacesThroughTheSameVertices) {
  const std::string command = "subdivide " + kModels + "tetrahedron.obj --compare --levels ";
  const Outcome result = run(command + "4 --report r.json --picture p.png --width 640 --before-after");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("interpolated Catmull-Clark"), std::string::npos) << result.out;
  EXPECT_TRUE(fs::exists(path("p.png")));
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  ASSERT_EQ(report["compared"].size(), 5U);
  const auto bending = [&](int i) { return report["compared"][i]["bending"].get<double>(); };
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(report["compared"][i]["failure"], "");
    EXPECT_EQ(report["compared"][i]["vertices_left_out"], 0);
    EXPECT_GT(bending(i), 12.56);  // a closed surface
  }
  EXPECT_GT(bending(0), bending(1));  // the figure 1 of ZSS96: creases, and none
  EXPECT_GT(bending(1), bending(2));
  EXPECT_GT(bending(2), bending(3));  // the fair one
  EXPECT_EQ(report["compared"][2]["method"].get<std::string>().empty(), false);
}

/// Two triangles back to back, one edge a semi-sharp crease: the rows of its ends in Catmull-Clark's system are alike,
/// so that surface is found with Lai's alpha.
TEST_F(Tool, ComparesSurfacesWhereOneTakesAlpha) {
  write("pillow.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\nt crease 2/1/0 0 1 1\n");
  const Outcome result = run("subdivide pillow.obj --compare --levels 1 --report r.json --picture p.png --width 320");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto compared = nlohmann::json::parse(text_of(path("r.json")))["compared"];
  ASSERT_EQ(compared.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(compared[i]["failure"], "") << i;
    EXPECT_TRUE(compared[i].contains("bending")) << i;
  }
  EXPECT_LT(compared[4]["max_error"].get<double>(), 1e-10);
  EXPECT_TRUE(fs::exists(path("p.png")));
}

TEST_F(Tool, ComparesSurfacesWhoseSquaresDoublesCannotHold) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  write("large.obj", "v 1e200 0 -7e199\nv -1e200 0 -7e199\nv 0 1e200 7e199\nv 0 -1e200 7e199\n" + faces);
  write("unit.obj", "v 1 0 -0.7\nv -1 0 -0.7\nv 0 1 0.7\nv 0 -1 0.7\n" + faces);
  std::vector<nlohmann::json> reports;
  for (const std::string name : {"large", "unit"}) {
    const Outcome schemes = run("subdivide " + name + ".obj --compare --levels 2 --report r.json");
    EXPECT_EQ(schemes.status, 0) << schemes.err;
    EXPECT_EQ(schemes.out.find("nan"), std::string::npos) << schemes.out;
    reports.push_back(nlohmann::json::parse(text_of(path("r.json")))["compared"]);
    const Outcome methods = run("interpolate " + name + ".obj --compare-methods");
    EXPECT_EQ(methods.out.find("nan"), std::string::npos) << methods.out;
  }
  for (std::size_t i = 0; i < reports[1].size(); ++i) {
    const double bending = reports[1][i]["bending"].get<double>();
    EXPECT_NEAR(reports[0][i]["bending"].get<double>(), bending, 1e-9 * bending) << i;
    EXPECT_NEAR(reports[0][i]["variation"].get<double>() / reports[1][i]["variation"].get<double>(), 1.0, 1e-9) << i;
  }
}

TEST_F(Tool, ComparesTrianglesOnlyAndWritesNoMesh) {
  const Outcome quads = run("subdivide " + kModels + "tripod.obj --compare");
  EXPECT_EQ(quads.status, 1);
  EXPECT_NE(quads.err.find("--triangulate"), std::string::npos) << quads.err;
  for (const char* wrong : {"-o x.obj", "--scheme loop", "--tension 0.1", "--limit", "--chord 1%"}) {
    EXPECT_EQ(run("subdivide " + kModels + "tetrahedron.obj --compare " + wrong).status, 2) << wrong;
  }
}

TEST_F(Tool, MeasuresDistancesOutsideAndInside) {
  write("cube.obj", kSharpCube);
  write("scan.xyz", "1.5 0 0\n0 0 0.75\n4 5 0\n0 -1 0\n");
  const Outcome result = run("distance scan.xyz cube.obj -o out.ply --report r.json --picture p.png --width 320");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("max         5 at point 2"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("inside      at most 0.25, 1 point"), std::string::npos) << result.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_NEAR(report["rms"].get<double>(), std::sqrt((0.25 + 0.0625 + 25.0) / 4.0), 1e-9);
  EXPECT_NEAR(report["mean"].get<double>(), (0.5 + 0.25 + 5.0) / 4.0, 1e-9);
  EXPECT_NEAR(report["max_inside"].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(report["farthest"][0]["point"], 2);
  int counted = 0;
  for (const auto& count : report["histogram"]["counts"]) counted += count.get<int>();
  EXPECT_EQ(counted, 4);
  const Mesh scan = read_mesh(path("out.ply"));
  ASSERT_EQ(scan.attributes.size(), 1U);
  EXPECT_EQ(scan.attributes[0].name, "distance");
  const Eigen::Vector4d expected(0.5, -0.25, 5.0, 0.0);
  EXPECT_LE((scan.attributes[0].values.col(0) - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(Tool, InterpolatedPointsLieOnTheSurface) {
  ASSERT_EQ(run("interpolate " + kModels + "pipe-joint.obj -o control.obj").status, 0);
  ASSERT_EQ(run("distance " + kModels + "pipe-joint.obj control.obj --report r.json").status, 0);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_LE(report["max"].get<double>(), 2e-10 * report["diagonal"].get<double>());
  EXPECT_GT(report["points"].get<int>(), 100);
}

TEST_F(Tool, PointsOnTheSurfaceAreNeitherOutsideNorInside) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj -o control.obj").status, 0);
  const Outcome result = run("distance " + kModels + "creature.obj control.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("outside     no point\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("inside      no point\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("on it       602 points within "), std::string::npos) << result.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["points_outside"], 0);
  EXPECT_EQ(report["points_inside"], 0);
  EXPECT_EQ(report["points_on_surface"], 602);
}

TEST_F(Tool, AnOpenSurfaceHasNoInside) {
  write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  write("scan.xyz", "0.5 0.5 -1\n0.5 0.5 2\n");
  const Outcome result = run("distance scan.xyz quad.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find("inside"), std::string::npos) << result.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_FALSE(report["signed"].get<bool>());
  EXPECT_NEAR(report["mean"].get<double>(), 1.5, 1e-9);
}

TEST_F(Tool, DistanceSaysWhichFileIsWrong) {
  write("scan.xyz", "0 0 0\n");
  const Outcome swapped = run("distance " + kModels + "cube.obj scan.xyz");
  EXPECT_EQ(swapped.status, 1);
  EXPECT_NE(swapped.err.find("scan.xyz: there are no faces"), std::string::npos) << swapped.err;
  EXPECT_EQ(run("distance scan.xyz " + kModels + "cube.obj -o out.obj").status, 2);
  EXPECT_EQ(run("distance missing.xyz " + kModels + "cube.obj").status, 1);
  write("none.off", "OFF\n0 0 0\n");
  const Outcome empty = run("distance none.off " + kModels + "cube.obj");
  EXPECT_EQ(empty.status, 1);
  EXPECT_NE(empty.err.find("none.off"), std::string::npos) << empty.err;
}

}  // namespace
}  // namespace batten::cli_tests
