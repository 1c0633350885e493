/// Runs of scenes: what each key does to the body, frames, states that are kept and taken up again.
#include "batten/dynamics/elastic_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/threads.h"
#include "support/errors.h"
#include "support/source_folder.h"

namespace batten {
namespace {

/// A sheet of 4 by 4 quads that hangs at its boundary, or the members given instead.
const std::string kHanging = R"("supports": [{"type": "hold", "vertices": "boundary"}], "forces": [{"type": "gravity"}],
                                "time": {"seconds": 1, "step": 0.1})";

ElasticRun run_of(const std::string& members, const Mesh& mesh = grid(4, 4)) {
  SceneMeshes meshes;
  meshes.rest = mesh;
  return {parse_scene("s.json", R"({"mesh": "m.obj", )" + members + "}"), meshes};
}

void expect_same(const ElasticRun& a, const ElasticRun& b) {
  EXPECT_EQ(a.state().time, b.state().time);
  EXPECT_EQ(a.state().positions, b.state().positions);
  EXPECT_EQ(a.state().velocities, b.state().velocities);
  EXPECT_EQ(a.at_rest(), b.at_rest());
}

void run_out(ElasticRun& run) {
  while (!run.done()) run.step();
}

class StateFile : public testing::Test {
 protected:
  std::string path_ = (std::filesystem::temp_directory_path() / ("batten-state-" + std::to_string(getpid()))).string();
  void TearDown() override { std::filesystem::remove(path_); }
};

TEST_F(StateFile, GoesOnWithTheSameBits) {
  for (const char* time :
       {R"("seconds": 1, "step": 0.1)", R"("seconds": 1, "step": 0.1, "scheme": "second-order")",
        R"("seconds": 1, "step": 0.1, "scheme": "paper")", R"("seconds": 1, "step": 0.1, "step_error": 1e-4)",
        R"("seconds": 1, "step": 0.1, "refine": [0.2, 0.5])"}) {
    const std::string scene =
        R"("supports": [{"type": "pin", "at": {"near": [0, 0, 0]}}],
           "forces": [{"type": "gravity"}, {"type": "plane", "point": [0, 0, -0.5], "friction": 0.3}],
           "time": {)" +
        std::string(time) + "}";
    ElasticRun whole = run_of(scene);
    ElasticRun begun = run_of(scene);
    for (int i = 0; i < 4; ++i) begun.step();
    write_state(path_, begun.save());
    ElasticRun resumed = run_of(scene);
    resumed.resume(read_state(path_));
    expect_same(resumed, begun);
    run_out(whole);
    run_out(resumed);
    EXPECT_EQ(whole.state().time, resumed.state().time) << time;
    EXPECT_EQ((whole.state().positions - resumed.state().positions).cwiseAbs().maxCoeff(), 0.0) << time;
    EXPECT_EQ((whole.state().velocities - resumed.state().velocities).cwiseAbs().maxCoeff(), 0.0) << time;
  }
}

TEST_F(StateFile, ThatIsDamagedIsRefused) {
  ElasticRun run = run_of(kHanging);
  run.step();
  write_state(path_, run.save());
  std::ifstream file(path_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const auto expect_refused = [&](const std::string& text, const std::string& part) {
    std::ofstream(path_, std::ios::binary) << text;
    test::expect_error([&] { read_state(path_); }, ErrorCode::BadFile, path_ + ": the state file " + part);
  };
  expect_refused("v 0 0 0\n", "does not begin");
  expect_refused(bytes.substr(0, bytes.size() - 8), "is cut short or was changed");
  expect_refused(bytes.substr(0, 25), "is cut short");
  std::string changed = bytes;
  changed[200] = static_cast<char>(changed[200] ^ 1);
  expect_refused(changed, "is cut short or was changed");
  test::expect_error([] { read_state("no/such.state"); }, ErrorCode::FileNotReadable, "no/such.state");
}

TEST_F(StateFile, OfAnotherBodyIsRefused) {
  ElasticRun run = run_of(kHanging);
  write_state(path_, run.save());
  ElasticRun other = run_of(kHanging, grid(4, 5));
  test::expect_error([&] { other.resume(read_state(path_)); }, ErrorCode::BadArgument, "is of another body");
}

TEST(ElasticRun, HasTheSameBitsWithOneThreadAndTwo) {
  const std::string scene = R"("refine": 2, "forces": [{"type": "gravity"}, {"type": "plane", "point": [0, 0, -0.1]},
      {"type": "wind", "velocity": [1, 0, 1]}], "time": {"seconds": 0.5, "step": 0.1})";
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    ElasticRun made = run_of(scene);
    run_out(made);
    return made.state().positions;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(ElasticRun, HasFramesAtTheirTimes) {
  ElasticRun run = run_of(kHanging + R"(, "output": {"frames_per_second": 4})");
  std::vector<Index> frames{run.frame()};
  while (!run.done()) {
    run.step();
    if (run.frame() > frames.back()) frames.push_back(run.frame());
  }
  EXPECT_EQ(frames, (std::vector<Index>{0, 1, 2, 3, 4}));
  EXPECT_NEAR(run.state().time, 1.0, 1e-12);
}

TEST(ElasticRun, HoldsAndLeadsControlPoints) {
  ElasticRun run = run_of(R"("start": {"move": [0, 0, 1]}, "supports": [{"type": "hold", "vertices": [0]},
      {"type": "hold", "vertices": {"from": [0.9, 0.9, 0], "to": [1, 1, 2]},
       "move": [{"time": 0, "by": [0, 0, 0]}, {"time": 1, "by": [0, 0, 3]}]}], "time": {"seconds": 0.5, "step": 0.1})");
  run_out(run);
  const Points rest = grid(4, 4).points;
  const Points& now = run.state().positions;
  EXPECT_LT((now.row(0) - rest.row(0) - Eigen::RowVector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((now.row(24) - rest.row(24) - Eigen::RowVector3d(0, 0, 2.5)).norm(), 1e-12);
}

TEST(ElasticRun, StartsWithItsVelocityAndKeepsIt) {
  ElasticRun run = run_of(R"("start": {"velocity": [1, 2, 3]}, "material": {"damping": 0},
                             "time": {"seconds": 0.5, "step": 0.1})");
  run_out(run);
  const Points moved = run.state().positions - grid(4, 4).points;
  EXPECT_LT((moved.rowwise() - Eigen::RowVector3d(0.5, 1.0, 1.5)).cwiseAbs().maxCoeff(), 1e-9);
}

/// Springs pull at the places that the scene names: a stiff one takes its place along.
TEST(ElasticRun, PullsAtThePlacesNamed) {
  const Mesh mesh = grid(4, 4);
  for (const char* at : {R"({"vertex": 12})", R"({"near": [0, 0, 1]})", R"({"face": 10, "u": 0, "v": 0})"}) {
    ElasticRun run = run_of(R"("forces": [{"type": "spring", "at": )" + std::string(at) +
                            R"(, "to": [0, 0, 0.5], "stiffness": 1e6}], "time": {"seconds": 10, "until_rest": true})");
    run_out(run);
    const Topology topology(mesh);
    const Values limit = LimitMatrix(topology, run.scheme()).apply(run.state().positions);
    EXPECT_LT((limit.row(12) - Eigen::RowVector3d(0, 0, 0.5)).norm(), 1e-3) << at;
    const Points line = run.spring_lines(run.state().positions, 0.0);
    EXPECT_LT((line.row(0) - limit.row(12)).norm(), 1e-12) << at;
    EXPECT_EQ(line.row(1), Eigen::RowVector3d(0, 0, 0.5));
  }
}

TEST(ElasticRun, RefinesWithoutAJump) {
  ElasticRun run = run_of(kHanging + R"(, "output": {"levels": 1})");
  ElasticRun finer = run_of(R"("supports": [{"type": "hold", "vertices": "boundary"}], "forces": [{"type": "gravity"}],
                               "time": {"seconds": 1, "step": 0.1, "refine": [0.3]})");
  for (int i = 0; i < 3; ++i) finer.step();
  const Points before = finer.state().positions;
  EXPECT_EQ(finer.refined(), 0);
  finer.step();
  EXPECT_EQ(finer.refined(), 1);
  EXPECT_EQ(finer.mesh().vertex_count(), 81);
  const Points same = finer.refined_points(before, 0);
  EXPECT_EQ(same.rows(), 81);
  // One step of a tenth of a second moves less than gravity alone would.
  EXPECT_LT((finer.state().positions - same).rowwise().norm().maxCoeff(), 9.81 * (0.1 * 0.1 + 0.1 * 0.4));
}

TEST(ElasticRun, EndsAtRestAndRefinesThere) {
  ElasticRun run = run_of(R"("supports": [{"type": "hold", "vertices": "boundary"}], "forces": [{"type": "gravity"}],
      "material": {"damping": 20}, "time": {"seconds": 100, "step": 0.1, "until_rest": true, "refine": {"at_rest": 1}})");
  run_out(run);
  EXPECT_TRUE(run.at_rest());
  EXPECT_EQ(run.refined(), 1);
  EXPECT_LT(run.state().time, 50.0);
  // What rests is near the equilibrium.
  const Points rests = run.state().positions;
  EXPECT_TRUE(run.find_equilibrium().converged);
  EXPECT_LT((run.state().positions - rests).rowwise().norm().maxCoeff(), 0.02);
  EXPECT_GT((run.state().positions - rests).rowwise().norm().maxCoeff(), 1e-9);
}

TEST(ElasticRun, CarriesCoefficientsToTheFacesOfARefinedMesh) {
  std::string list = "[";
  for (int i = 0; i < 16; ++i) list += (i == 0 ? "" : ",") + std::to_string(i);
  ElasticRun coarse = run_of(R"("boundary": "edge-and-corner", "material": {"density": )" + list + "]}");
  ElasticRun fine = run_of(R"("boundary": "edge-and-corner", "refine": 2, "material": {"density": )" + list + "]}");
  const auto center = [](const ElasticRun& run) {
    const Points weighted = run.motion().surface().mass() * run.state().positions;
    return Eigen::RowVector4d(run.motion().surface().mass().sum(), weighted.col(0).sum(), weighted.col(1).sum(), 0.0);
  };
  EXPECT_LT((center(coarse) - center(fine)).norm(), 1e-9);
  test::expect_error([] { run_of(R"("material": {"tension": [1, 2]})"); }, ErrorCode::BadShape,
                     "s.json: material.tension: there are 2 numbers for 16 faces");
}

TEST(ElasticRunErrors, NameTheSceneAndThePlace) {
  const auto expect = [](const std::string& members, ErrorCode code, const std::string& message) {
    test::expect_error([&] { run_of(members); }, code, "s.json: " + message);
  };
  expect(R"("supports": [{"type": "hold", "vertices": [99]}])", ErrorCode::IndexOutOfRange,
         "supports[0]: there is no vertex 99");
  expect(R"("supports": [{"type": "hold", "vertices": {"from": [5, 5, 5], "to": [6, 6, 6]}}])", ErrorCode::BadArgument,
         "supports[0]: no control point starts in this box");
  expect(R"("forces": [{"type": "spring", "at": {"face": 16, "u": 0, "v": 0}, "to": [0, 0, 0]}])",
         ErrorCode::IndexOutOfRange, "forces[0].at: there is no face 16");
  expect(R"("forces": [{"type": "gravity"}, {"type": "pressure", "volume": 2, "bulk_modulus": 1}])",
         ErrorCode::BadArgument, "forces[1]: the rest shape encloses no volume");
  expect(R"("scheme": "loop")", ErrorCode::NotTriangles, "");
  test::expect_error([] { run_of(R"("supports": [{"type": "hold", "vertices": "boundary"}])", cube()); },
                     ErrorCode::BadArgument, "s.json: supports[0]: the mesh has no boundary");
}

TEST(ElasticRunErrors, NameFilesThatAreNotThere) {
  const auto expect = [](const std::string& text, const std::string& message) {
    test::expect_error([&] { read_scene_meshes(parse_scene("s.json", text)); }, ErrorCode::FileNotReadable, message);
  };
  expect(R"({"mesh": "no.obj"})", "s.json: mesh: no.obj");
  const std::string cube_file = test::source_folder() + "/models/cube.obj";
  expect(R"({"mesh": ")" + cube_file + R"(", "start": {"mesh": "no.obj"}})", "s.json: start.mesh: no.obj");
  expect(R"({"mesh": ")" + cube_file + R"(", "forces": [{"type": "nearest-springs", "points": "no.xyz"}]})",
         "s.json: forces[0].points: no.xyz");
}

TEST(ElasticRunErrors, NameAStartWithOtherFaces) {
  SceneMeshes meshes;
  meshes.rest = grid(4, 4);
  meshes.start = grid(4, 3);
  test::expect_error([&] { ElasticRun(parse_scene("s.json", R"({"mesh": "m", "start": {"mesh": "n"}})"), meshes); },
                     ErrorCode::BadShape, "s.json: start.mesh: the first mesh has 25 vertices and the second 20");
}

TEST(ElasticRunScenes, OfTheModelsRun) {
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() + "/models")) {
    const std::string path = entry.path().string();
    if (path.find(".scene.json") == std::string::npos) continue;
    ElasticRun run(read_scene(path));
    for (int i = 0; i < 2; ++i) EXPECT_LT(run.step().step.change, 0.05 * run.motion().surface().diagonal()) << path;
    EXPECT_TRUE(run.state().positions.allFinite()) << path;
  }
}

}  // namespace
}  // namespace batten
