/// The verb simulate: frames, animations, reports, states, and what is said of wrong scenes.
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "batten/io/io.h"
#include "cli/process.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

class SimulateTool : public Tool {
 protected:
  /// A sheet of five points a side that hangs at its edge; further members may be given.
  void write_scene(const std::string& time, const std::string& more = "") const {
    write_mesh(path("sheet.obj"), read_mesh(kModels + "lifted-grid.obj"));
    write("s.json", R"({"mesh": "sheet.obj", "supports": [{"type": "hold", "vertices": "boundary"}],
                        "forces": [{"type": "gravity"}], "time": {)" +
                        time + "}" + more + "}");
  }
  nlohmann::json report() const { return nlohmann::json::parse(text_of(path("r.json"))); }
};

TEST_F(SimulateTool, WritesAFileAFrame) {
  write_scene(R"("seconds": 0.5, "step": 0.05)", R"(, "output": {"frames_per_second": 10})");
  const Outcome result = run("simulate s.json -o f.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  for (int i = 0; i <= 5; ++i) {
    EXPECT_EQ(read_mesh(path("f-00" + std::to_string(i) + ".obj")).vertex_count(), 81);
    EXPECT_NEAR(report().at("frames").at(i).at("time"), 0.1 * i, 1e-12);
  }
  EXPECT_FALSE(fs::exists(path("f-006.obj")));
  EXPECT_EQ(report().at("frames").size(), 6U);
  EXPECT_NE(result.out.find("written   6 files"), std::string::npos) << result.out;
  // It hangs lower and lower.
  EXPECT_LT(read_mesh(path("f-003.obj")).points.col(2).minCoeff(),
            read_mesh(path("f-001.obj")).points.col(2).minCoeff());
}

TEST_F(SimulateTool, ReportsEveryStep) {
  write_scene(R"("seconds": 0.5, "step": 0.05)");
  ASSERT_EQ(run("simulate s.json --report r.json --plot p.svg --quiet").status, 0);
  const nlohmann::json json = report();
  ASSERT_EQ(json.at("steps").size(), 10U);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(json.at("steps").at(i).at("time"), 0.05 * (i + 1), 1e-12);
  EXPECT_LT(json.at("steps").at(9).at("support_error"), 1e-12);
  EXPECT_LT(json.at("steps").at(9).at("force_energy"), json.at("steps").at(0).at("force_energy"));
  EXPECT_FALSE(json.at("interrupted"));
  EXPECT_NE(text_of(path("p.svg")).find("<svg"), std::string::npos);
}

TEST_F(SimulateTool, WritesAnAnimation) {
  write_scene(R"("seconds": 0.5, "step": 0.05)", R"(, "output": {"frames_per_second": 10, "levels": 1})");
  const Outcome result = run("simulate s.json -o f.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("an animation of 0.5 seconds in 6 frames, 289 vertices, 256 faces"), std::string::npos)
      << result.out;
  const std::string glb = text_of(path("f.glb"));
  const auto json = nlohmann::json::parse(glb.substr(20, glb.find('\0', 20) - 20), nullptr, false);
  EXPECT_NE(glb.find("\"animations\""), std::string::npos);
  if (!json.is_discarded()) {
    EXPECT_EQ(json.at("meshes").at(0).at("primitives").at(0).at("targets").size(), 5U);
  }
}

TEST_F(SimulateTool, RefinesInMidRunInOneAnimation) {
  write_scene(R"("seconds": 0.5, "step": 0.05, "refine": [0.2])", R"(, "output": {"levels": 2})");
  const Outcome result = run("simulate s.json -o f.glb --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("1 time, to 289 vertices"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("1,089 vertices, 1,024 faces"), std::string::npos) << result.out;
  EXPECT_EQ(report().at("frames").front().at("vertices"), 81);
  EXPECT_EQ(report().at("frames").back().at("vertices"), 289);
}

TEST_F(SimulateTool, GoesOnWithTheSameBitsWithAnyThreads) {
  write_scene(R"("seconds": 0.6, "step": 0.05)", R"(, "output": {"frames_per_second": 10})");
  ASSERT_EQ(run("simulate s.json -o whole.ply --quiet --threads 1").status, 0);
  ASSERT_EQ(run("simulate s.json -o part.ply --seconds 0.3 --state s.state --quiet --threads 2").status, 0);
  ASSERT_EQ(run("simulate s.json -o part.ply --resume s.state --quiet").status, 0);
  for (int i = 0; i <= 6; ++i) {
    const std::string number = "-00" + std::to_string(i) + ".ply";
    EXPECT_EQ(text_of(path("whole" + number)), text_of(path("part" + number))) << i;
    EXPECT_FALSE(text_of(path("part" + number)).empty()) << i;
  }
}

TEST_F(SimulateTool, KeepsWhatIsDoneWhenItIsStopped) {
  write_scene(R"("seconds": 100000, "step": 0.01)", R"(, "output": {"frames_per_second": 1})");
  Process tool(folder_, {"simulate", "s.json", "-o", "f.obj", "--state", "s.state", "--report", "r.json"});
  while (tool.is_running() && !fs::exists(path("f-001.obj"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  tool.send(SIGINT);
  EXPECT_EQ(tool.wait(), 1);
  EXPECT_NE(tool.errors().find("batten: interrupted at "), std::string::npos) << tool.errors();
  EXPECT_NE(tool.errors().find("--resume s.state goes on"), std::string::npos) << tool.errors();
  const double end = report().at("end");
  EXPECT_TRUE(report().at("interrupted"));
  EXPECT_GT(end, 0.99);
  const Outcome result = run("simulate s.json --resume s.state --report r.json --seconds " + std::to_string(end + 0.5));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(report().at("begin"), end);
}

TEST_F(SimulateTool, FindsTheEquilibrium) {
  write_scene(R"("seconds": 1)");
  const Outcome result = run("simulate s.json --equilibrium -o e.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(report().at("equilibrium").at("converged"));
  EXPECT_LT(report().at("equilibrium").at("residual_force"), 1e-6);
  EXPECT_LT(read_mesh(path("e.obj")).points.col(2).minCoeff(), -0.01);
}

TEST_F(SimulateTool, NamesWhatIsWrongWithAScene) {
  const auto expect = [&](const std::string& scene, const std::string& message) {
    write("bad.json", scene);
    const Outcome result = run("simulate bad.json -o f.glb");
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err.rfind("batten: bad.json: " + message, 0), 0U) << result.err;
    EXPECT_FALSE(fs::exists(path("f.glb")));
  };
  expect(R"({"mesh": "no.obj"})", "mesh: no.obj");
  expect(R"({"mesh": "no.obj", "tmie": {}})", "there is no key \"tmie\" here (did you mean time?)");
  expect(R"({"mesh": "no.obj", "time": {"step": -1}})", "time.step: -1 is not above 0");
  expect(R"({"mesh": )", "mesh: not JSON");
}

TEST_F(SimulateTool, RefusesOptionsWithoutMeaning) {
  write_scene(R"("seconds": 0.1)");
  for (const char* options : {"-o - --output-format obj", "--equilibrium --state s.state", "--levels 2", "--moments 3",
                              "-o f.obj --step 0", "-o f.obj --resume"}) {
    const Outcome result = run("simulate s.json " + std::string(options));
    EXPECT_EQ(result.status, 2) << options << "\n" << result.err;
  }
  const Outcome endless = run("simulate s.json --step 1e-9");
  EXPECT_EQ(endless.status, 1);
  EXPECT_NE(endless.err.find("s.json: time: these are more than ten million steps"), std::string::npos) << endless.err;
  write("old.state", "no state");
  const Outcome result = run("simulate s.json --resume old.state");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("old.state: the state file does not begin"), std::string::npos) << result.err;
}

TEST_F(SimulateTool, NamesAPlaceOnce) {
  write_mesh(path("flat.obj"), read_mesh(kModels + "lifted-grid.obj"));
  const auto error_of = [&](const std::string& part) {
    write("s.json", R"({"mesh": "flat.obj", )" + part + "}");
    return run("simulate s.json").err;
  };
  EXPECT_EQ(error_of(R"("supports": [{"type": "hold", "vertices": [1]}, {"type": "hold", "vertices": [2, 1]}])"),
            "batten: s.json: supports[1]: vertex 1 is held twice; name it once\n");
  const std::string place = error_of(
      R"("forces": [{"type": "spring", "at": {"face": 9999, "u": 0, "v": 0}, "to": [0, 0, 0], "stiffness": 1}])");
  EXPECT_EQ(place.rfind("batten: s.json: forces[0].at: there is no face 9999", 0), 0U) << place;
}

TEST_F(SimulateTool, RefusesAStepBeyondTheEnd) {
  write_scene(R"("seconds": 0.1)");
  const Outcome result = run("simulate s.json --step 5 -o f.glb");
  EXPECT_EQ(result.status, 1) << "five seconds instead of a tenth, or none";
  EXPECT_NE(result.err.find("one step is longer than all these seconds"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace batten::cli_tests
