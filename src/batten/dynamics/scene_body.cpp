/// The body, the time and the output of a scene.
#include <algorithm>
#include <string>

#include "batten/dynamics/scene_json.h"
#include "batten/dynamics/scene_parts.h"

namespace batten::dynamics {

namespace {

constexpr double kMostFrames = 1e6;  // a second

void set_coefficient(const JsonPlace& material, const char* key, std::vector<double>& target) {
  if_has(material, key, [&](const JsonPlace& place) {
    if (!place.is_list()) {
      target = {place.not_negative()};
      return;
    }
    target.clear();
    for (std::size_t i = 0; i < place.size(); ++i) target.push_back(place.item(i).not_negative());
    if (target.empty()) place.fail("a number, or one a face, is expected here");
  });
}

ElasticMaterial preset(const JsonPlace& place) {
  switch (place.choice({"medium", "soft", "stiff"})) {
    case 1:
      return ElasticMaterial::soft();
    case 2:
      return ElasticMaterial::stiff();
    default:
      return {};
  }
}

ElasticMaterial material_from_json(const JsonPlace& place) {
  if (place.is_text()) return preset(place);
  place.require_keys({"preset", "density", "damping", "tension", "rigidity"});
  ElasticMaterial material;
  if_has(place, "preset", [&](const JsonPlace& name) { material = preset(name); });
  set_coefficient(place, "density", material.density);
  set_coefficient(place, "damping", material.damping);
  set_coefficient(place, "tension", material.tension);
  set_coefficient(place, "rigidity", material.rigidity);
  return material;
}

void rest_from_json(const JsonPlace& place, ElasticOptions& body) {
  place.require_keys({"model", "measure", "cutoff_levels"});
  if_has(place, "model", [&](const JsonPlace& model) {
    constexpr RestModel kModels[] = {RestModel::Rotating, RestModel::Linear, RestModel::Point};
    body.rest = kModels[model.choice({"rotating", "linear", "point"})];
  });
  if_has(place, "measure", [&](const JsonPlace& measure) {
    body.measure =
        measure.choice({"lengths", "parameters"}) == 0 ? ElasticMeasure::Lengths : ElasticMeasure::Parameters;
  });
  if_has(place, "cutoff_levels", [&](const JsonPlace& levels) {
    constexpr Index kMostLevels = 30;
    if (body.measure != ElasticMeasure::Parameters) levels.fail("goes with \"measure\": \"parameters\" only");
    body.cutoff_levels = levels.index_to(kMostLevels);
  });
}

void motion_from_json(const JsonPlace& time, MotionOptions& motion) {
  if_has(time, "scheme", [&](const JsonPlace& place) {
    constexpr TimeScheme kSchemes[] = {TimeScheme::BackwardEuler, TimeScheme::SecondOrder, TimeScheme::MassFree,
                                       TimeScheme::Paper, TimeScheme::PaperMassFree};
    motion.scheme = kSchemes[place.choice({"backward-euler", "second-order", "mass-free", "paper", "paper-mass-free"})];
  });
  set_positive(time, "step", motion.step);
  if_has(time, "rounds", [&](const JsonPlace& place) {
    constexpr Index kMostRounds = 100000;
    motion.rounds = place.index_to(kMostRounds);
    if (motion.rounds < 1) place.fail("a round at least is needed");
  });
  set_positive(time, "tolerance", motion.tolerance);
  if_has(time, "solver", [&](const JsonPlace& place) {
    constexpr MotionSolver kSolvers[] = {MotionSolver::Auto, MotionSolver::Direct, MotionSolver::Iterative};
    motion.solver = kSolvers[place.choice({"auto", "direct", "iterative"})];
  });
}

void refine_from_json(const JsonPlace& place, SceneTime& time) {
  constexpr std::size_t kMostRefined = 6;
  if (place.is_object()) {
    place.require_keys({"at_rest"});
    time.refine_at_rest = place.at("at_rest").index_to(static_cast<Index>(kMostRefined));
    return;
  }
  for (std::size_t i = 0; i < place.size(); ++i) {
    const JsonPlace moment = place.item(i);
    time.refine_at.push_back(moment.not_negative());
    if (i > 0 && time.refine_at[i] < time.refine_at[i - 1]) moment.fail("the times must increase");
  }
  if (time.refine_at.size() > kMostRefined)
    place.fail("at most " + std::to_string(kMostRefined) + " refinements are possible: each takes four times the work");
}

}  // namespace

std::string wrong_steps(const SceneTime& time) {
  constexpr double kMostSteps = 1e7;
  const bool few = time.seconds >= 0.0 && time.seconds / time.motion.step <= kMostSteps;
  if (!few) return "these are more than ten million steps; give fewer seconds or a longer step";
  // Steps are whole: one that is longer than the run would go far past its end.
  const bool fits = time.seconds == 0.0 || time.motion.step <= time.seconds * (1.0 + 1e-9);
  return fits ? "" : "one step is longer than all these seconds; give more seconds or a shorter step";
}

ElasticOptions body_from_json(const JsonPlace& document) {
  ElasticOptions body;
  if_has(document, "material", [&](const JsonPlace& place) { body.material = material_from_json(place); });
  if_has(document, "rest", [&](const JsonPlace& place) { rest_from_json(place, body); });
  return body;
}

SceneTime time_from_json(const JsonPlace& place) {
  place.require_keys(
      {"seconds", "step", "scheme", "rounds", "tolerance", "solver", "step_error", "refine", "until_rest", "rest"});
  SceneTime time;
  set_not_negative(place, "seconds", time.seconds);
  motion_from_json(place, time.motion);
  if (const std::string wrong = wrong_steps(time); !wrong.empty()) place.fail(wrong);
  set_positive(place, "step_error", time.step_error);
  if_has(place, "refine", [&](const JsonPlace& refine) { refine_from_json(refine, time); });
  if_has(place, "until_rest", [&](const JsonPlace& until) { time.until_rest = until.truth(); });
  if_has(place, "rest", [&](const JsonPlace& rest) {
    rest.require_keys({"speed", "force"});
    set_positive(rest, "speed", time.rest.speed);
    set_positive(rest, "force", time.rest.force);
  });
  return time;
}

SceneOutput output_from_json(const JsonPlace& place) {
  place.require_keys({"frames_per_second", "levels", "up"});
  SceneOutput output;
  if_has(place, "frames_per_second", [&](const JsonPlace& frames) {
    output.frames_per_second = frames.positive();
    if (output.frames_per_second > kMostFrames) frames.fail("more than a million frames a second are too many");
  });
  if_has(place, "levels", [&](const JsonPlace& levels) {
    constexpr Index kMostLevels = 8;
    output.levels = levels.index_to(kMostLevels);
  });
  if_has(place, "up", [&](const JsonPlace& up) {
    constexpr UpAxis kAxes[] = {UpAxis::X, UpAxis::Y, UpAxis::Z, UpAxis::MinusX, UpAxis::MinusY, UpAxis::MinusZ};
    output.up = kAxes[up.choice({"x", "y", "z", "-x", "-y", "-z"})];
  });
  return output;
}

}  // namespace batten::dynamics
