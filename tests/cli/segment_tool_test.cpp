/// The verb segment: from a volume of labels to a control mesh, a table, pictures and a report.
#include <cmath>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"
#include "batten/volume/segment_together.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

class SegmentTool : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
#ifndef BATTEN_WITH_VOLUMES
    GTEST_SKIP() << "built without volumes (BATTEN_WITH_VOLUMES)";
#endif
    write("ball.nrrd", ball());
  }

  /// A ball of label 7 and radius 12 mm around (-10, -20, 30) in RAS, voxels of 2 by 2 by 3 mm, in LPS.
  static std::string ball() {
    std::string text =
        "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 20 20 15\n"
        "space directions: (2,0,0) (0,2,0) (0,0,3)\nspace origin: (-9,1,9)\nencoding: ascii\n\n";
    for (int k = 0; k < 15; ++k) {
      for (int j = 0; j < 20; ++j) {
        for (int i = 0; i < 20; ++i) {
          const double x = 2 * i - 19;
          const double y = 2 * j - 19;
          const double z = 3 * k - 21;
          text += x * x + y * y + z * z < 144.0 ? "7 " : "0 ";
        }
      }
    }
    return text;
  }
};

TEST_F(SegmentTool, FindsABallWhereItIs) {
  const Outcome result = run(
      "segment ball.nrrd --label 7 --vertices 100 -o a.obj --report r.json --inside in.nii.gz --parts --overlay s.png");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh mesh = read_mesh(path("a.obj"));
  const Eigen::RowVector3d middle = 0.5 * (mesh.points.colwise().minCoeff() + mesh.points.colwise().maxCoeff());
  EXPECT_LT((middle - Eigen::RowVector3d(-10.0, -20.0, 30.0)).norm(), 1.5) << middle;
  EXPECT_EQ(text_of(path("a.obj")).substr(0, 12), "# SPACE=RAS\n");
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_GT(report.at("dice"), 0.97);
  EXPECT_EQ(report.at("genus"), 0);
  EXPECT_EQ(report.at("self_intersections"), 0);
  EXPECT_NEAR(report.at("volume").get<double>(), report.at("mask_volume").get<double>(), 250.0);
  EXPECT_GT(fs::file_size(path("s.png")), 1000U);
  EXPECT_GT(fs::file_size(path("in.nii.gz")), 100U);
}

TEST_F(SegmentTool, WritesLpsWhereAsked) {
  ASSERT_EQ(run("segment ball.nrrd --vertices 100 -o a.ply").status, 0);
  ASSERT_EQ(run("segment ball.nrrd --vertices 100 -o b.ply --space lps").status, 0);
  Points turned = read_mesh(path("b.ply")).points;
  turned.leftCols(2) *= -1.0;
  EXPECT_EQ(turned, read_mesh(path("a.ply")).points);
  EXPECT_NE(text_of(path("b.ply")).find("comment SPACE=LPS\n"), std::string::npos);
}

TEST_F(SegmentTool, GrowsFromASeedInTheWorldThatIsAsked) {
  ASSERT_EQ(run("segment ball.nrrd --seed=-10,-20,30 --vertices 100 -o a.obj --report r.json").status, 0);
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_NEAR(report.at("volume").get<double>(), 7238.2, 0.1 * 7238.2) << "a ball of 12 mm";
  EXPECT_GT(report.at("region").at("volume"), 4000.0);
  ASSERT_EQ(run("segment ball.nrrd --seed=10,20,30 --space lps --vertices 100 -o b.obj").status, 0);
  const auto middle = [&](const char* name) {
    const Points points = read_mesh(path(name)).points;
    return Eigen::RowVector3d(0.5 * (points.colwise().minCoeff() + points.colwise().maxCoeff()));
  };
  EXPECT_LT((middle("a.obj") - Eigen::RowVector3d(-10, -20, 30)).norm(), 1.5);
  EXPECT_LT((middle("b.obj") - Eigen::RowVector3d(10, 20, 30)).norm(), 1.5);
}

TEST_F(SegmentTool, StartsFromAMesh) {
  ASSERT_EQ(run("segment ball.nrrd --vertices 100 -o a.obj").status, 0);
  const Outcome result = run("segment ball.nrrd --start a.obj -o b.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(read_mesh(path("b.obj")).face_vertices, read_mesh(path("a.obj")).face_vertices);
  EXPECT_NE(run("segment ball.nrrd --start a.obj --space lps -o c.obj").err.find("other world"), std::string::npos);
  EXPECT_EQ(run("segment ball.nrrd --start a.obj --vertices 50 -o c.obj").status, 2);
  EXPECT_EQ(run("segment ball.nrrd --seed=0,0,0 --start a.obj -o c.obj").status, 2);
  EXPECT_EQ(run("segment ball.nrrd --numbers 1,2 -o c.obj").status, 2);
}

TEST_F(SegmentTool, WritesItsRoundsAndAFilm) {
  const Outcome result =
      run("segment ball.nrrd --vertices 100 -o a.obj --frames rounds --film film.glb --report r.json --space lps");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rounds = nlohmann::json::parse(text_of(path("r.json"))).at("rounds").get<int>();
  ASSERT_GT(rounds, 0);
  ASSERT_LT(rounds, 10);
  EXPECT_NE(result.out.find(std::to_string(rounds + 1) + " frames in rounds"), std::string::npos) << result.out;
  const std::string last = path("rounds/round-00" + std::to_string(rounds) + ".obj");
  EXPECT_EQ(read_mesh(last).points, read_mesh(path("a.obj")).points);
  EXPECT_EQ(text_of(last).substr(0, 12), "# SPACE=LPS\n");
  EXPECT_NE(read_mesh(path("rounds/round-000.obj")).points, read_mesh(last).points);
  EXPECT_GT(fs::file_size(path("film.glb")), 10000U);
  EXPECT_EQ(run("segment ball.nrrd --vertices 100 --film alone.glb").status, 0);
  EXPECT_EQ(run("segment ball.nrrd --moments 2 -o b.obj").status, 2) << "moments of which picture?";
}

TEST_F(SegmentTool, ShowsTheWayFromASeedThroughItsEdges) {
  ASSERT_EQ(run("segment ball.nrrd --seed=-10,-20,30 --vertices 100 -o a.obj --frames rounds").status, 0);
  std::vector<Points> shown;
  for (const auto& entry : fs::directory_iterator(path("rounds"))) shown.push_back(read_mesh(entry.path()).points);
  ASSERT_GT(shown.size(), 20U) << "of the region's surface, and of 24 rounds";
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(shown[i], shown[j]) << "no surface is shown twice";
  }
  ASSERT_EQ(run("segment ball.nrrd --start a.obj -o b.obj --frames again").status, 0);
  EXPECT_EQ(read_mesh(path("again/round-000.obj")).points, read_mesh(path("a.obj")).points);
}

TEST_F(SegmentTool, TakesContoursOfALabelAndPointsOf3DSlicer) {
  const Outcome contours =
      run("segment ball.nrrd --mask ball.nrrd --label 7 --slices 2 --vertices 100 -o a.obj --report r.json");
  ASSERT_EQ(contours.status, 0) << contours.err;
  EXPECT_EQ(nlohmann::json::parse(text_of(path("r.json"))).at("slices"), 4) << "of the 7 that the ball has";
  EXPECT_GT(nlohmann::json::parse(text_of(path("r.json"))).at("dice"), 0.93);
  // The same ball by hand, in the other world: half of the points in each kind of file.
  std::string table = "# CoordinateSystem = LPS\n";
  std::string list = R"({"markups": [{"type": "ClosedCurve", "coordinateSystem": "LPS", "controlPoints": [)";
  for (int k = 0; k < 5; ++k) {
    const double z = 4.8 * (k - 2);
    for (int i = 0; i < 24; ++i) {
      const double far = std::sqrt(144.0 - z * z);
      const double x = 10.0 + far * std::cos(i * 0.2618);
      const double y = 20.0 + far * std::sin(i * 0.2618);
      const std::string numbers = std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(30.0 + z);
      if (k % 2 == 0)
        table += "id," + numbers + ",0,0,0,1,1,1,0,F,,\n";
      else
        list += (list.back() == '[' ? "" : ",") + (R"({"position": [)" + numbers + "]}");
    }
  }
  write("some.fcsv", table);
  write("others.mrk.json", list + "]}]}");
  const Outcome result = run(
      "segment ball.nrrd --points some.fcsv --points others.mrk.json --vertices 100 -o b.obj --report s.json --space "
      "ras");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("120 points in 5 slices"), std::string::npos) << result.out;
  const Points points = read_mesh(path("b.obj")).points;
  const Eigen::RowVector3d middle = 0.5 * (points.colwise().minCoeff() + points.colwise().maxCoeff());
  EXPECT_LT((middle - Eigen::RowVector3d(-10.0, -20.0, 30.0)).norm(), 1.0) << middle;
  const auto report = nlohmann::json::parse(text_of(path("s.json")));
  EXPECT_NEAR(report.at("volume").get<double>(), 7238.2, 0.05 * 7238.2) << "a ball of 12 mm";
  write("wrong.fcsv", "a,1,2,3\n");
  EXPECT_NE(run("segment ball.nrrd --points wrong.fcsv -o c.obj").err.find("wrong.fcsv: it does not say its world"),
            std::string::npos);
  EXPECT_EQ(run("segment ball.nrrd --slices 2 -o c.obj").status, 2) << "slices of which mask?";
  EXPECT_EQ(run("segment ball.nrrd --mask ball.nrrd --slices 2 --points some.fcsv -o c.obj").status, 2);
}

/// The limit surfaces of two control meshes as triangles.
std::vector<Mesh> surfaces_of(const std::vector<std::string>& paths) {
  std::vector<Mesh> meshes;
  for (const std::string& path : paths) {
    const Mesh control = read_mesh(path);
    meshes.push_back(triangulated(surface_of_faces(Topology(control), choose_scheme(control), control, 100000)));
  }
  return meshes;
}

TEST_F(SegmentTool, SurfacesTogetherDoNotMeet) {
  std::string halves = ball();
  const std::size_t data = halves.find("\n\n");
  for (std::size_t at = data, voxel = 0; at < halves.size(); ++at) {
    if (halves[at] != '7' && halves[at] != '0') continue;
    if (halves[at] == '7' && voxel % 20 < 10) halves[at] = '3';
    ++voxel;
  }
  write("halves.nrrd", halves);
  const Outcome result =
      run("segment halves.nrrd --label 3,7 --together --vertices 100 -o a.obj --report r.json --inside in.nrrd");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("label 7"), std::string::npos) << result.out;
  EXPECT_TRUE(find_meetings(surfaces_of({path("a-3.obj"), path("a-7.obj")})).empty());
  EXPECT_FALSE(fs::exists(path("a.obj")));
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  ASSERT_EQ(report.at("surfaces").size(), 2U);
  for (const auto& surface : report.at("surfaces")) EXPECT_GT(surface.at("dice"), 0.9);
  EXPECT_LT(read_mesh(path("a-7.obj")).points.col(0).mean(), read_mesh(path("a-3.obj")).points.col(0).mean())
      << "the first index grows to the left";
  EXPECT_NE(run("segment in.nrrd --label 5 -o c.obj").err.find("there are 3, 7"), std::string::npos)
      << "the inside has the labels' numbers";
  EXPECT_EQ(run("segment halves.nrrd --label 3,7 --together --seed=1,2,3 -o b.obj").status, 2);
  EXPECT_EQ(run("segment halves.nrrd --together -o b.obj").status, 2);
  EXPECT_EQ(run("segment halves.nrrd --label 3,7 --together -o - --output-format obj").status, 2) << "two files";
  EXPECT_EQ(run("segment halves.nrrd --label 3 --together -o b.obj").status, 1);
}

TEST_F(SegmentTool, NeighboursOfAnAtlasDoNotMeet) {
  const std::string atlas = "/usr/share/mricron/templates/aal.nii.gz";
  if (!fs::exists(atlas)) GTEST_SKIP() << "needs Debian's mricron-data";
  const Outcome result = run("segment " + atlas + " --label 37,41 --together -o a.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto report = nlohmann::json::parse(text_of(path("r.json")));
  EXPECT_GT(report.at("together").at("first_meetings"), 100) << "hippocampus and amygdala meet where each is alone";
  EXPECT_TRUE(find_meetings(surfaces_of({path("a-37.obj"), path("a-41.obj")})).empty());
  for (const auto& surface : report.at("surfaces")) {
    EXPECT_EQ(surface.at("self_intersections"), 0);
    EXPECT_GT(surface.at("dice"), 0.96);
  }
}

TEST_F(SegmentTool, WritesTheFineSurfaceForProgramsOfMedicine) {
  for (const char* name : {"a.gii", "a.fsb", "a.vtk"}) {
    const Outcome result = run(std::string("segment ball.nrrd --vertices 100 -o ") + name);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("refined to"), std::string::npos) << result.out;
  }
  EXPECT_NE(text_of(path("a.vtk")).find("SPACE=RAS"), std::string::npos);
  EXPECT_NE(run("segment ball.nrrd --space lps -o b.gii").err.find("RAS"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("b.gii")));
}

TEST_F(SegmentTool, SaysWhatIsWrong) {
  EXPECT_EQ(run("segment ball.nrrd").status, 2) << "nothing to write";
  const Outcome absent = run("segment ball.nrrd --label 71 -o a.obj");
  EXPECT_EQ(absent.status, 1);
  EXPECT_NE(absent.err.find("no voxel has the label 71; there are 7"), std::string::npos) << absent.err;
  const Outcome one = run("segment ball.nrrd --label 7,71 -o a.obj");
  EXPECT_EQ(one.status, 1) << "a label that is nowhere is not passed over";
  EXPECT_NE(one.err.find("no voxel has the label 71; there are 7"), std::string::npos) << one.err;
  const Outcome pipe = run("segment ball.nrrd --label 7,71 --together -o - --output-format obj");
  EXPECT_EQ(pipe.status, 2);
  EXPECT_NE(pipe.err.find("standard output takes one"), std::string::npos) << pipe.err;
  EXPECT_NE(run("segment nowhere.nii -o a.obj").err.find("nowhere.nii"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("a.obj")));
}

TEST_F(SegmentTool, SaysVolumesOfSmallUnits) {
  std::string metres = ball();
  const std::string from = "(2,0,0) (0,2,0) (0,0,3)";
  metres.replace(metres.find(from), from.size(), "(0.002,0,0) (0,0.002,0) (0,0,0.003)");
  write("metres.nrrd", metres);
  const Outcome result = run("segment metres.nrrd --vertices 100 -o a.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find(" 0.0 mm"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find(" 0.000 mm"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace batten::cli_tests
