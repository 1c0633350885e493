/// The verb medial: from the files of medial models to surfaces, sheets, models and reports.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/medial/medial_io.h"
#include "batten/medial/medial_surface.h"
#include "batten/refine/refinement.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using MedialTool = Tool;

/// The written control mesh's surface passes through the spokes' ends.
TEST_F(MedialTool, WritesTheSurfaceThroughTheSpokesEnds) {
  for (const char* model : {"bean.srep.json", "fork.json"}) {
    const Outcome result = run("medial " + kModels + model + " -o a.ply --report r.json");
    ASSERT_EQ(result.status, 0) << result.err;
    const MedialBoundary boundary = medial_boundary(read_medial(kModels + model));
    const Mesh written = read_mesh(path("a.ply"));
    const Topology topology(written);
    const Values reached = LimitMatrix(topology, choose_scheme(written)).apply(written.points);
    ASSERT_EQ(reached.rows(), boundary.mesh.points.rows());
    EXPECT_LT((reached - boundary.mesh.points).rowwise().norm().maxCoeff(), 1e-10);
    const auto report = nlohmann::json::parse(text_of(path("r.json")));
    EXPECT_LT(report.at("distance").at("max"), 1e-10);
    EXPECT_EQ(report.at("vertices"), boundary.mesh.vertex_count());
    EXPECT_GT(report.at("angle").at("max"), report.at("angle").at("mean"));
  }
}

TEST_F(MedialTool, TurnsNormalsToTheSpokes) {
  const Outcome result = run("medial " + kModels + "bean.srep.json --normals -o a.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const MedialBoundary boundary = medial_boundary(read_medial(kModels + "bean.srep.json"));
  const Mesh written = read_mesh(path("a.ply"));
  const Topology topology(written);
  const MedialErrors errors = measure_medial_errors(boundary, topology, choose_scheme(written), written.points);
  EXPECT_LT(errors.distance.max, 1e-10);
  EXPECT_LT(errors.angle.max, 1e-10);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report.at("normals").at("turned"), boundary.mesh.vertex_count());
  EXPECT_GT(report.at("normals").at("angle_before").at("max"), 10.0);
  EXPECT_LT(report.at("angle").at("max"), 1e-8);
  EXPECT_NE(result.out.find("before    at most 14.4 degrees"), std::string::npos) << result.out;
}

TEST_F(MedialTool, TableSaysWhatWasMeasured) {
  const std::string out = run("medial " + kModels + "fork.json").out;
  EXPECT_NE(out.find("107 atoms in 4 figures"), std::string::npos) << out;
  EXPECT_NE(out.find("6 spokes end inside"), std::string::npos) << out;
  for (const char* row : {"Blum ", "distance ", "angle ", "shift "}) EXPECT_NE(out.find(row), std::string::npos) << out;
  EXPECT_EQ(out.find("crossing"), std::string::npos) << out;
}

TEST_F(MedialTool, WritesTheModelAndItsSheetFiner) {
  const Outcome same = run("medial " + kModels + "bean.srep.json --model same.srep.json --quiet");
  ASSERT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(text_of(path("same.srep.json")), text_of(kModels + "bean.srep.json"));
  const Outcome fine =
      run("medial " + kModels + "bean.srep.json --model fine.srep.json --sheet sheet.ply --sheet-levels 1");
  ASSERT_EQ(fine.status, 0) << fine.err;
  EXPECT_NE(fine.out.find("261 atoms: 40 lines, 6 steps"), std::string::npos) << fine.out;
  const MedialFigure figure = read_medial(path("fine.srep.json")).figures.front();
  EXPECT_EQ(figure.grid->crest_points, 40);
  EXPECT_EQ(read_mesh(path("sheet.ply")).points, figure.sheet.points);
}

TEST_F(MedialTool, SaysWhatTheModelAndTheSheetLose) {
  const Outcome plain = run("medial " + kModels + "bean.srep.json --model a.json --sheet a.stl --report r.json");
  ASSERT_EQ(plain.status, 0) << plain.err;
  EXPECT_NE(plain.err.find("a.json: lost: the order of the atoms in lines and steps"), std::string::npos) << plain.err;
  EXPECT_NE(plain.err.find("a.stl: lost: polygons"), std::string::npos) << plain.err;
  const auto lost = nlohmann::json::parse(text_of(path("r.json"))).at("lost");
  EXPECT_NE(std::find(lost.begin(), lost.end(), "the order of the atoms in lines and steps"), lost.end());
  EXPECT_EQ(run("medial " + kModels + "slab.json --model b.json").err, "");
}

TEST_F(MedialTool, NamesWhereAFileIsDamaged) {
  std::string text = text_of(kModels + "bean.srep.json");
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i) at = text.find("\"DownSpoke\"", at + 1);  // a line has four points
  write("a.srep.json", text.replace(at, 11, "\"Spoke\""));
  const Outcome result = run("medial a.srep.json -o a.ply");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err, "batten: a.srep.json: line 1, step 1: DownSpoke is missing\n");
  EXPECT_FALSE(fs::exists(path("a.ply")));
  const Outcome slab = run("medial " + kModels + "slab.json --model a.srep.json");
  EXPECT_EQ(slab.status, 1);
  EXPECT_NE(slab.err.find("one figure on an elliptical grid"), std::string::npos) << slab.err;
}

TEST_F(MedialTool, RefusesOptionsWithoutEffect) {
  EXPECT_EQ(run("medial " + kModels + "slab.json --sheet-levels 1").status, 2);
  EXPECT_EQ(run("medial " + kModels + "slab.json --color angle").status, 2);
  EXPECT_EQ(run("medial " + kModels + "slab.json --model a.obj").status, 2);
  EXPECT_EQ(run("medial " + kModels + "slab.json --picture a.png --color zebra").status, 2);
}

TEST_F(MedialTool, RefusesAnSrepOfASheetBeforeAnythingIsWritten) {
  const Outcome result = run("medial " + kModels + "slab.json -o a.obj --model b.srep.json");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("b.srep.json: an .srep.json holds one figure"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(path("a.obj")));
}

}  // namespace
}  // namespace batten::cli_tests
