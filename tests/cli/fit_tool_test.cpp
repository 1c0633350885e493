/// The verb fit: from points to a control mesh, a table and a report.
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "batten/nearest/surface_distances.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using FitTool = Tool;

/// The points of a torus's surface, as a file without faces.
Mesh torus_points() {
  const Mesh control = torus(16, 8);
  Mesh points;
  points.points = surface_mesh(Topology(control), Scheme(), control, 2).points;
  return points;
}

TEST_F(FitTool, WritesASurfaceAsNearAsTheReportSays) {
  write_mesh(path("points.xyz"), torus_points());
  const Outcome result =
      run("fit " + path("points.xyz") + " --vertices 150 -o a.obj --residuals r.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh written = read_mesh(path("a.obj"));
  const Topology topology(written);
  EXPECT_LE(topology.vertex_count(), 150);
  EXPECT_EQ(topology.vertex_count() - topology.edge_count() + topology.face_count(), 0) << "a torus";
  const SurfaceDistances measured =
      measure_distances(topology, choose_scheme(written), written.points, torus_points().points);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_NEAR(measured.distances.cwiseAbs().maxCoeff(), report.at("points_to_surface").at("max"), 1e-9);
  EXPECT_EQ(report.at("outliers"), 0);
  const Mesh residuals = read_mesh(path("r.ply"));
  ASSERT_EQ(residuals.attributes.size(), 1U);
  EXPECT_LT((residuals.attributes[0].values - measured.distances.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(FitTool, MovesACageAndKeepsItsFaces) {
  const Outcome result = run("fit " + kModels + "creature-horn.obj --init " + kModels + "creature.obj -o a.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(read_mesh(path("a.obj")).face_vertices, read_mesh(kModels + "creature.obj").face_vertices);
  EXPECT_NE(result.out.find("602 vertices, 600 faces"), std::string::npos) << result.out;
}

TEST_F(FitTool, WritesItsRoundsAndAFilm) {
  write_mesh(path("points.xyz"), torus_points());
  const Outcome result = run("fit " + path("points.xyz") +
                             " --init sphere --method dynamic --vertices 98 --frames rounds --film film.glb -o a.obj" +
                             " --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rounds = nlohmann::json::parse(text_of(path("r.json"))).at("rounds").size();
  const std::string count = std::to_string(rounds + 1);
  EXPECT_NE(result.out.find(count + " frames in rounds"), std::string::npos) << result.out;
  ASSERT_LT(rounds, 100U);
  const std::string last =
      path("rounds/round-0" + std::string(rounds < 10 ? "0" : "") + std::to_string(rounds) + ".obj");
  EXPECT_EQ(read_mesh(last).points, read_mesh(path("a.obj")).points);
  EXPECT_EQ(read_mesh(path("rounds/round-000.obj")).vertex_count(), 98);
  EXPECT_EQ(read_mesh(path("film.glb")).face_count(), 96 * 16 * 2) << "four by four, in triangles";
  write_mesh(path("file"), torus_points(), {"xyz"});
  const Outcome wrong = run("fit " + path("points.xyz") + " --vertices 50 --frames file -o b.obj");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("folder"), std::string::npos) << wrong.err;
}

TEST_F(FitTool, TagsAndCountsTheSharpEdgesOfABox) {
  Mesh points;
  const Mesh side = grid(20, 20);
  for (int face = 0; face < 6; ++face) {
    const Index first = points.vertex_count();
    points.points.conservativeResize(first + side.vertex_count(), 3);
    for (Index v = 0; v < side.vertex_count(); ++v) {
      points.points(first + v, face / 2) = face % 2 == 0 ? 1.0 : -1.0;
      points.points(first + v, (face / 2 + 1) % 3) = side.points(v, 0);
      points.points(first + v, (face / 2 + 2) % 3) = side.points(v, 1);
    }
  }
  write_mesh(path("box.xyz"), points);
  const Outcome result = run("fit " + path("box.xyz") + " --scheme loop --vertices 60 -o a.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("sharp edges"), std::string::npos) << result.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_GT(report.at("creases").at("edges"), 12);
  EXPECT_EQ(report.at("creases").at("edges"), read_mesh(path("a.obj")).creases.size());
  ASSERT_EQ(run("fit " + path("box.xyz") + " --scheme loop --vertices 60 --creases none -o a.obj").status, 0);
  EXPECT_TRUE(read_mesh(path("a.obj")).creases.empty());
}

TEST_F(FitTool, RefusesWhatMakesNoSense) {
  write_mesh(path("points.xyz"), torus_points());
  EXPECT_EQ(run("fit " + path("points.xyz")).status, 2) << "nothing to write";
  EXPECT_EQ(run("fit " + path("points.xyz") + " --init sphere --genus 1 -o a.obj").status, 2);
  EXPECT_EQ(run("fit " + path("points.xyz") + " --creases keep -o a.obj").status, 2) << "no file to keep them of";
  EXPECT_EQ(run("fit " + path("points.xyz") + " --init sphere --creases auto -o a.obj").status, 2);
  const Outcome missing = run("fit " + path("points.xyz") + " --init nowhere.obj -o a.obj");
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find("nowhere.obj"), std::string::npos) << missing.err;
}

TEST_F(FitTool, ReadsStandardInput) {
  write_mesh(path("points.xyz"), torus_points());
  const Outcome result =
      run("fit - --input-format xyz --init sphere --vertices 98 --rounds 1 -o - --output-format obj <points.xyz");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find("nan"), std::string::npos);
  write("a.obj", result.out);
  EXPECT_EQ(read_mesh(path("a.obj")).vertex_count(), 98);
}

TEST_F(FitTool, RepairsItsInputAndNamesTheVerbThatRepairsTheStart) {
  // Two tetrahedra on one edge.
  write("edge.obj",
        "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\n"
        "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 5 2\nf 1 2 6\nf 1 6 5\nf 2 5 6\n");
  const Outcome refused = run("fit edge.obj -o a.obj");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("(or let --repair do it)"), std::string::npos) << refused.err;
  EXPECT_EQ(run("fit edge.obj --repair --init sphere --vertices 98 --rounds 1 -o a.obj").status, 0);
  write_mesh(path("points.xyz"), torus_points());
  const Outcome start = run("fit points.xyz --init edge.obj -o b.obj");
  EXPECT_EQ(start.status, 1);
  EXPECT_EQ(start.err.rfind("batten: edge.obj: ", 0), 0U) << start.err;
  EXPECT_NE(start.err.find("(or let batten repair do it)"), std::string::npos) << start.err;
}

TEST_F(FitTool, SaysThatNoSurfaceHasSoFewControlPoints) {
  write_mesh(path("points.xyz"), torus_points());
  const Outcome result = run("fit points.xyz --init sphere --vertices 8 --rounds 1 -o a.obj");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("as few as the 8 control points asked"), std::string::npos) << result.out;
}

TEST_F(FitTool, RefusesPointsAndStartsWithoutASurface) {
  std::string line;
  std::string large;
  for (int i = 0; i < 100; ++i) {
    line += std::to_string(i) + " " + std::to_string(2 * i) + " " + std::to_string(3 * i) + "\n";
    large += std::to_string(i % 7) + "e200 " + std::to_string(i % 5) + "e200 " + std::to_string(i % 3) + "e200\n";
  }
  write("line.xyz", line);
  write("large.xyz", large);
  write("point.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3 4\n");
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const Outcome result = run("fit " + arguments + " -o a.obj");
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(path("a.obj")));
  };
  refused("line.xyz --init sphere", "on one line");
  refused("large.xyz", "too large or too small for doubles; scale the points");
  std::string plane;
  for (int i = 0; i < 400; ++i) plane += std::to_string(i % 20) + " " + std::to_string(i / 20) + " 3\n";
  write("plane.xyz", plane);
  refused("plane.xyz --init sphere --method dynamic", "in one plane");
  write("far.obj", "v 1e6 0 0\nv 1e6 9 0\nv 1e6 9 9\nv 1e6 0 9\nf 1 2 3 4\n");
  refused("plane.xyz --init line.xyz", "line.xyz: there are no faces, only points");
  refused("plane.xyz --init far.obj", "lies 999981 away from the points, farther than either is large");
  refused("line.xyz --init point.obj", "all vertices of the control mesh to start from are at the same place");
}

}  // namespace
}  // namespace batten::cli_tests
