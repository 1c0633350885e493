/// The tool's verbs of the mesh series.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "batten/mesh/measures.h"
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

TEST_F(Tool, DenoiseTagsTheSharpEdgesItFound) {
  const std::string command = "denoise " + kModels + "bracket-scan.obj --auto --features 40 ";
  ASSERT_EQ(run(command + "-o clean.obj --report r.json").status, 0);
  const auto found = nlohmann::json::parse(text_of(path("r.json")))["features"];
  const std::vector<Crease> creases = read_mesh(path("clean.obj")).creases;
  ASSERT_EQ(creases.size(), found.size());
  for (std::size_t i = 0; i < creases.size(); ++i) {
    EXPECT_EQ(std::minmax(creases[i].a, creases[i].b), std::minmax(found[i][0].get<Index>(), found[i][1].get<Index>()));
    EXPECT_GE(creases[i].sharpness, kInfiniteSharpness);
  }
  ASSERT_EQ(run(command + "-o clean.usda").status, 0);
  EXPECT_NE(text_of(path("clean.usda")).find("creaseIndices"), std::string::npos);
  const Outcome scan = run(command + "-o clean.ply");
  EXPECT_NE(scan.err.find("lost: creases"), std::string::npos) << scan.err;
}

TEST_F(Tool, DenoisesByAStrengthInEdgeLengths) {
  ASSERT_EQ(run("denoise " + kModels + "torus-knot.obj --strength 4 -o a.obj --report r.json").status, 0);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["passes"].get<int>(), 19);  // 1/3 of such a wave is lost at each application: (26/27)^19 < 1/2
  ASSERT_EQ(run("denoise " + kModels + "torus-knot.obj --passes 19 -o b.obj").status, 0);
  EXPECT_EQ(text_of(path("a.obj")), text_of(path("b.obj")));
  EXPECT_EQ(run("denoise " + kModels + "torus-knot.obj --passes 3 --auto").status, 2);
  ASSERT_EQ(run("denoise " + kModels + "bracket-scan.obj --auto -o auto.obj").status, 0);
  ASSERT_EQ(run("denoise " + kModels + "bracket-scan.obj -o plain.obj").status, 0);
  EXPECT_EQ(text_of(path("plain.obj")), text_of(path("auto.obj")));
  EXPECT_EQ(run("denoise " + kModels + "torus-knot.obj --strength 1.5").status, 2);
  write("points.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const Outcome points = run("denoise points.xyz -o c.obj");
  EXPECT_EQ(points.status, 1);
  EXPECT_NE(points.err.find("no faces"), std::string::npos) << points.err;
}

/// "noise      0.0123 (0.04 of the mean edge)": the share.
double noise_share(const std::string& text) {
  const std::size_t row = text.find("\nnoise");
  return std::stod(text.substr(text.find('(', row) + 1));
}

TEST_F(Tool, DenoiseComparesTheNoiseWithTheEdgesGiven) {
  // So many passes shrink the edges to a part of their length.
  const Outcome result = run("denoise " + kModels + "torus-knot.obj --passes 400 -o a.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh given = read_mesh(kModels + "torus-knot.obj");
  const Mesh smooth = read_mesh(path("a.obj"));
  const double edge = edge_lengths(Topology(given), given.points).mean;
  ASSERT_LT(edge_lengths(Topology(smooth), smooth.points).mean, 0.9 * edge);
  const double noise = nlohmann::json::parse(text_of(path("r.json")))["noise"].get<double>();
  EXPECT_NEAR(noise_share(result.out), noise / edge, 0.01 * noise / edge);  // three digits are printed
}

TEST_F(Tool, DenoiseSaysNoShareOfEdgesWithoutALength) {
  write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  const Outcome result = run("denoise point.obj -o a.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find("nan"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("of the mean edge"), std::string::npos) << result.out;
}

TEST_F(Tool, SharpensAndWarnsOfFacesThatPassThroughEachOther) {
  const Outcome mild = run("sharpen " + kModels + "creature.obj -o sharp.obj --report r.json");
  ASSERT_EQ(mild.status, 0) << mild.err;
  EXPECT_NE(mild.out.find("no faces pass through each other"), std::string::npos) << mild.out;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["growth"].get<double>(), 4.0);
  EXPECT_GT(report["moved_rms"].get<double>(), 0.01);
  const Outcome wild = run("sharpen " + kModels + "bracket-scan.obj --passes 4 --most-growth 1000 --report w.json");
  EXPECT_NE(wild.out.find("WARNING"), std::string::npos) << wild.out;
  EXPECT_GT(nlohmann::json::parse(text_of(path("w.json")))["intersections_after"]["count"].get<int>(), 0);
  const Outcome wrong = run("sharpen " + kModels + "creature.obj -o x.obj -m 4 -n 3");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("1 <= m <= n"), std::string::npos) << wrong.err;
}

TEST_F(Tool, SplitsAMeshIntoBandsThatAddUpToIt) {
  const Outcome result =
      run("bands " + kModels + "creature.obj --gains 1,2,1 -o m.ply --displacements --plot p.svg --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("band 3"), std::string::npos) << result.out;
  EXPECT_NE(text_of(path("p.svg")).find("<svg"), std::string::npos);
  const Mesh before = read_mesh(kModels + "creature.obj");
  const Mesh mixed = read_mesh(path("m.ply"));
  Points sum = Points::Zero(before.vertex_count(), 3);
  Points second = sum;
  int columns = 0;
  for (const Attribute& attribute : mixed.attributes) {
    for (Eigen::Index c = 0; c < attribute.values.cols(); ++c, ++columns) {
      sum.col(columns % 3) += attribute.values.col(c);
      if (columns / 3 == 1) second.col(columns % 3) = attribute.values.col(c);
    }
  }
  ASSERT_EQ(columns, 9);
  EXPECT_LT((sum - before.points).cwiseAbs().maxCoeff(), 1e-14 * 20.0);
  EXPECT_LT((before.points + second - mixed.points).cwiseAbs().maxCoeff(), 1e-13);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_NEAR(report["bands"][1]["rms"].get<double>(), second.norm() / std::sqrt(before.vertex_count()), 1e-12);
  EXPECT_EQ(run("bands " + kModels + "creature.obj --gains 1,2 --count 3").status, 2);
  EXPECT_EQ(run("bands " + kModels + "creature.obj -o x.obj --gains 1").status, 1);
}

}  // namespace
}  // namespace batten::cli_tests
