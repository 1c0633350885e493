/// The verb interpolate with --from and --local: what moves, and what stays.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

using Json = nlohmann::json;

const std::string kHorn = kModels + "creature-horn.obj";

Values limit_of(const Mesh& control) {
  return LimitMatrix(Topology(control), choose_scheme(control)).apply(control.points);
}

Index moved_rows(const Mesh& a, const Mesh& b) {
  return static_cast<Index>(((a.points - b.points).rowwise().norm().array() > 0.0).count());
}

TEST_F(Tool, ASurfaceFollowsAMovedPointAsAWholeSolveWould) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj -o control.obj").status, 0);
  const Outcome result = run("interpolate " + kHorn + " --from control.obj -o moved.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  ASSERT_EQ(run("interpolate " + kHorn + " -o whole.obj --method direct").status, 0);
  const Mesh moved = read_mesh(path("moved.obj"));
  const Mesh whole = read_mesh(path("whole.obj"));
  const double diagonal = bounding_diagonal(whole.points);
  // What the first solve leaves elsewhere stays: its tolerance, some ten times larger in control points.
  EXPECT_LE((moved.points - whole.points).rowwise().norm().maxCoeff(), 2e-9 * diagonal);
  EXPECT_LE((limit_of(moved) - read_mesh(kHorn).points).rowwise().norm().maxCoeff(), 2e-10 * diagonal);
  const Json report = Json::parse(text_of(path("r.json")));
  EXPECT_EQ(report["moved_points"], 1);
  EXPECT_EQ(report["is_local"], true);
  EXPECT_EQ(report["rings"], nullptr);
  EXPECT_EQ(report["moved_control_points"], moved_rows(moved, read_mesh(path("control.obj"))));
  EXPECT_NE(result.out.find("1 of 602"), std::string::npos) << result.out;
}

TEST_F(Tool, LocalMovesOnlyTheRingsAroundAPoint) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj -o control.obj").status, 0);
  const Outcome result = run("interpolate " + kHorn + " --from control.obj --local 2 -o moved.obj --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh control = read_mesh(path("control.obj"));
  const Mesh moved = read_mesh(path("moved.obj"));
  EXPECT_EQ(moved_rows(control, moved), 25);  // two rings of quads around a vertex of valence 4
  const Mesh horn = read_mesh(kHorn);
  const Values errors = (limit_of(moved) - horn.points).rowwise().norm();
  const Json report = Json::parse(text_of(path("r.json")));
  EXPECT_NEAR(report["max_miss"].get<double>(), errors.maxCoeff(), 1e-9);
  EXPECT_NEAR(errors(report["worst_miss"].get<Index>()), errors.maxCoeff(), 1e-9);
  EXPECT_EQ(report["missed_points"], (errors.array() > 1e-8).count());
  EXPECT_LE(report["max_error"].get<double>(), 1e-14);
  EXPECT_EQ(report["rings"], 2);
}

TEST_F(Tool, FromDrawsBeforeAndAfterWithoutAnotherOutput) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj -o control.obj").status, 0);
  const Outcome result = run("interpolate " + kHorn + " --from control.obj --picture p.png --before-after --width 160");
  if (result.err.find("this build has no pictures") != std::string::npos) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(path("p.png")));
}

TEST_F(Tool, FromKeepsWhatElseTheControlMeshHolds) {
  ASSERT_EQ(run("interpolate " + kModels + "bracket.obj -o control.obj").status, 0);
  Mesh model = read_mesh(kModels + "bracket.obj");
  model.creases.clear();
  model.points.row(5) *= 1.01;
  write_mesh(path("model.obj"), model);
  ASSERT_EQ(run("interpolate model.obj --from control.obj -o moved.obj").status, 0);
  EXPECT_EQ(read_mesh(path("moved.obj")).creases.size(), read_mesh(path("control.obj")).creases.size());
}

TEST_F(Tool, FromWritesTheSurfaceWhereItIsAskedFor) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj -o control.obj").status, 0);
  const Outcome result = run("interpolate " + kHorn + " --from control.obj --levels 1 -o surface.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  const Mesh surface = read_mesh(path("surface.obj"));
  EXPECT_EQ(surface.face_count(), 2400);
  EXPECT_LE((surface.points.topRows(602) - read_mesh(kHorn).points).rowwise().norm().maxCoeff(), 1e-8);
}

TEST_F(Tool, FromRefusesAnotherModel) {
  ASSERT_EQ(run("interpolate " + kModels + "creature.obj -o control.obj").status, 0);
  const Outcome other = run("interpolate " + kModels + "tripod.obj --from control.obj -o x.obj");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("does not have the faces of"), std::string::npos) << other.err;
  const Outcome most = run("interpolate " + kModels + "creature-ball.obj --from control.obj -o x.obj");
  EXPECT_EQ(most.status, 1);
  EXPECT_NE(most.err.find("602 of 602 points"), std::string::npos) << most.err;
  EXPECT_EQ(run("interpolate " + kHorn + " --local 2 -o x.obj").status, 2);
  EXPECT_EQ(run("interpolate " + kHorn + " --from control.obj --local -1 -o x.obj").status, 2);
  EXPECT_EQ(run("interpolate " + kHorn + " --from control.obj --plot x.png -o x.obj").status, 2);
  EXPECT_EQ(run("interpolate " + kHorn + " --from x.obj -o x.obj").status, 2);
}

}  // namespace
}  // namespace batten::cli_tests
