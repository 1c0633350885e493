/// Scenes of elastic surfaces: what a text becomes, and what is said of a wrong one.
#include "batten/dynamics/scene.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/errors.h"

namespace batten {
namespace {

ElasticScene parsed(const std::string& members) {
  return parse_scene("s.json", R"({"mesh": "m.obj", )" + members + "}");
}

void expect_refused(const std::string& members, const std::string& message) {
  test::expect_error([&] { parsed(members); }, ErrorCode::BadFile, "s.json: " + message);
}

template <typename Part>
Part force(const std::string& text) {
  return std::get<Part>(parsed(R"("forces": [)" + text + "]").forces.at(0));
}

TEST(Scene, WithAMeshAloneHasTheDefaults) {
  const ElasticScene scene = parse_scene("s.json", R"({"mesh": "m.obj"})");
  EXPECT_EQ(scene.mesh, "m.obj");
  EXPECT_EQ(scene.time.seconds, 1.0);
  EXPECT_EQ(scene.time.motion.step, MotionOptions().step);
  EXPECT_EQ(scene.body.material.tension, ElasticMaterial().tension);
  EXPECT_FALSE(scene.scheme.has_value());
  EXPECT_TRUE(scene.forces.empty());
}

TEST(Scene, KeepsWhatIsSaidOfTheBody) {
  const ElasticScene scene = parsed(
      R"("$schema": "x", "about": "a test", "refine": 2, "scheme": "loop", "boundary": "edge-and-corner",
         "start": {"mesh": "n.obj", "move": [0, 0, 1], "velocity": [1, 2, 3]},
         "material": {"preset": "stiff", "density": 2, "tension": [1, 2, 3]},
         "rest": {"model": "point", "measure": "parameters", "cutoff_levels": 4})");
  EXPECT_EQ(scene.refine, 2);
  EXPECT_EQ(scene.scheme, SchemeKind::Loop);
  EXPECT_EQ(scene.boundary, BoundaryRule::EdgeAndCorner);
  EXPECT_EQ(scene.start, "n.obj");
  EXPECT_EQ(scene.move, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(scene.velocity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.body.material.density, std::vector<double>{2.0});
  EXPECT_EQ(scene.body.material.tension, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(scene.body.material.rigidity, ElasticMaterial::stiff().rigidity);
  EXPECT_EQ(scene.body.rest, RestModel::Point);
  EXPECT_EQ(scene.body.measure, ElasticMeasure::Parameters);
  EXPECT_EQ(scene.body.cutoff_levels, 4);
}

TEST(Scene, KeepsForces) {
  const auto spring = force<SceneSpring>(
      R"({"type": "spring", "at": {"face": 3, "u": 0.25, "v": 1}, "to": [1, 2, 3], "stiffness": 5})");
  EXPECT_EQ(spring.at.place->face, 3);
  EXPECT_EQ(spring.at.place->u, 0.25);
  EXPECT_EQ(spring.to.points.at(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(spring.stiffness, 5.0);
  EXPECT_EQ(
      force<SceneNearestSprings>(R"({"type": "nearest-springs", "points": [[1, 2, 3], [4, 5, 6]]})").points.rows(), 2);
  EXPECT_EQ(force<SceneNearestSprings>(R"({"type": "nearest-springs", "points": "p.xyz"})").file, "p.xyz");
  EXPECT_EQ(force<SceneGravity>(R"({"type": "gravity"})").acceleration.z(), -9.81);
  EXPECT_EQ(force<ScenePressure>(R"({"type": "pressure", "pressure": -2})").pressure.values.at(0), -2.0);
  const auto balloon = force<ScenePressure>(
      R"({"type": "pressure", "volume": [{"time": 0, "value": 1}, {"time": 1, "value": 2}], "bulk_modulus": 9})");
  EXPECT_EQ(balloon.volume.times, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(balloon.bulk_modulus, 9.0);
  EXPECT_EQ(force<SceneWind>(R"({"type": "wind", "velocity": [1, 0, 0], "sway": [0, 1, 0], "length": 3})").length, 3.0);
  EXPECT_EQ(force<SceneObstacle>(R"({"type": "plane", "normal": [0, 1, 0], "friction": 0.5})").friction, 0.5);
  EXPECT_EQ(force<SceneObstacle>(R"({"type": "sphere", "center": [0, 0, 0], "radius": 2})").radius, 2.0);
  EXPECT_EQ(force<SceneObstacle>(R"({"type": "box", "from": [0, 0, 0], "to": [1, 1, 1]})").corner.z(), 1.0);
}

TEST(Scene, KeepsSupportsAndTimes) {
  const ElasticScene scene = parsed(
      R"("supports": [{"type": "hold", "vertices": "boundary"}, {"type": "hold", "vertices": [3, 4],
                       "move": [{"time": 0, "by": [0, 0, 0]}, {"time": 2, "by": [0, 0, 1]}]},
                      {"type": "hold", "vertices": {"from": [0, 0, 0], "to": [0, 1, 1]}},
                      {"type": "pin", "at": {"near": [1, 0, 0]}}],
         "time": {"seconds": 2, "step": 0.5, "scheme": "second-order", "rounds": 3, "tolerance": 1e-8,
                  "solver": "iterative", "step_error": 1e-3, "refine": [0.5, 1], "until_rest": true,
                  "rest": {"speed": 2}},
         "output": {"frames_per_second": 10, "levels": 2, "up": "y"})");
  EXPECT_TRUE(std::get<SceneHold>(scene.supports[0]).boundary);
  EXPECT_EQ(std::get<SceneHold>(scene.supports[1]).move.times.at(1), 2.0);
  EXPECT_EQ(std::get<SceneHold>(scene.supports[2]).box->second.z(), 1.0);
  EXPECT_EQ(std::get<ScenePin>(scene.supports[3]).at.near->x(), 1.0);
  EXPECT_EQ(scene.time.motion.scheme, TimeScheme::SecondOrder);
  EXPECT_EQ(scene.time.motion.rounds, 3);
  EXPECT_EQ(scene.time.motion.solver, MotionSolver::Iterative);
  EXPECT_EQ(scene.time.step_error, 1e-3);
  EXPECT_EQ(scene.time.refine_at.size(), 2U);
  EXPECT_EQ(scene.time.rest.speed, 2.0);
  EXPECT_FALSE(scene.time.rest.force.has_value());
  EXPECT_EQ(scene.output.levels, 2);
  EXPECT_EQ(scene.output.up, UpAxis::Y);
}

TEST(SceneErrors, NameThePlaceTheFaultAndTheWayOut) {
  expect_refused(R"("forces": [{"type": "gravity"}, {"type": "gravity"},
                               {"type": "spring", "at": {"vertex": 0}, "to": [0, 0, 0], "stiffness": -3}])",
                 "forces[2].stiffness: -3 is negative; give 0 or more");
  expect_refused(R"("time": {"step": 0})", "time.step: 0 is not above 0");
  expect_refused(R"("time": {"seconds": 1e9, "step": 1e-3})", "time: these are more than ten million steps");
  expect_refused(R"("time": {"seconds": 1, "step": 1.5})", "time: one step is longer than all these seconds");
  expect_refused(R"("time": {"refine": [2, 1]})", "time.refine[1]: the times must increase");
  expect_refused(R"("refine": 30)", "refine: 30 is too much; give 6 or less");
  expect_refused(R"("material": {"density": []})", "material.density: a number, or one a face");
  expect_refused(R"("rest": {"cutoff_levels": 4})", "rest.cutoff_levels: goes with");
  expect_refused(R"("forces": [{"type": "pressure"}])", "forces[0]: either \"pressure\", or \"volume\"");
  expect_refused(R"("forces": [{"type": "pressure", "volume": 0, "bulk_modulus": 1}])", "forces[0].volume: 0 is not");
  expect_refused(R"("forces": [{"type": "plane", "normal": [0, 0, 0]}])", "forces[0].normal: a direction");
  expect_refused(R"("forces": [{"type": "box", "from": [0, 0, 0], "to": [1, 0, 1]}])", "forces[0].to: each number");
  expect_refused(R"("supports": [{"type": "pin", "at": {"face": 0, "u": 2, "v": 0}}])",
                 "supports[0].at.u: a number from 0");
  expect_refused(R"("supports": [{"type": "pin", "at": {}}])", "supports[0].at: a place is given by");
  expect_refused(R"("supports": [{"type": "hold", "vertices": [1.5]}])", "supports[0].vertices[0]: a whole number");
  expect_refused(R"("output": {"frames_per_second": 1e9})", "output.frames_per_second: more than a million");
}

TEST(SceneErrors, NameTheNearestWord) {
  expect_refused(R"("forcse": [])", "there is no key \"forcse\" here (did you mean forces?)");
  expect_refused(R"("time": {"second": 1})", "time: there is no key \"second\" here (did you mean seconds?)");
  expect_refused(R"("material": "stif")", "material: \"stif\" is not known here (did you mean stiff?)");
  expect_refused(R"("forces": [{"type": "sprnig"}])",
                 "forces[0].type: \"sprnig\" is not known here (did you mean spring?)");
  expect_refused(R"("forces": [{"type": "magnet"}])",
                 "forces[0].type: \"magnet\" is not known here; the words are spring, ");
}

TEST(SceneErrors, SayWhatIsNoScene) {
  const auto refused = [](const std::string& text, const std::string& message) {
    test::expect_error([&] { parse_scene("s.json", text); }, ErrorCode::BadFile, "s.json: " + message);
  };
  refused("", "not JSON");
  refused("[1]", "an object is expected here, not a list");
  refused("{}", "mesh is missing");
  refused(R"({"mesh": ""})", "mesh: the name of a mesh file");
  refused(R"({"mesh": 3})", "mesh: a text is expected");
  refused(R"({"mesh": "a", "mesh": "b"})", "mesh: is given twice");
  refused(R"({"mesh": "a", "forces": {"type": "gravity"}})", "forces: a list is expected");
  refused(R"({"mesh": "a", "time": {"seconds": NaN}})", "time.seconds: not JSON");
  refused(R"({"mesh": "a", "time": {"seconds": 1e999}})", "time.seconds: not JSON: number overflow");
  refused(std::string(100, '['), "lists or objects lie more than 64 deep");
}

TEST(SceneErrors, NameAFileThatIsNotThere) {
  test::expect_error([] { read_scene("no/scene.json"); }, ErrorCode::FileNotReadable, "no/scene.json");
}

}  // namespace
}  // namespace batten
