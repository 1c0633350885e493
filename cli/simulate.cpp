/// The verb simulate: from a scene file to the motion of an elastic surface.
#include "cli/simulate_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include "batten/error.h"
#include "batten/io/io.h"
#include "cli/files.h"
#include "cli/picture.h"
#include "cli/plots.h"
#include "cli/signals.h"
#include "cli/simulation_frames.h"
#include "cli/simulation_outlines.h"
#include "cli/surface_output.h"

namespace batten::cli {
namespace {

/// A run, and what came of it.
struct Simulation {
  const SimulateArguments& arguments;
  ElasticRun& run;
  double begin;  ///< the time at which it started or went on
  std::vector<ElasticRow> rows = {};
  bool interrupted = false;
};

const char* force_word(const SceneForce& force) {
  if (std::holds_alternative<SceneSpring>(force)) return "spring";
  if (std::holds_alternative<SceneNearestSprings>(force)) return "nearest springs";
  if (std::holds_alternative<SceneGravity>(force)) return "gravity";
  if (std::holds_alternative<ScenePressure>(force)) return "pressure";
  if (std::holds_alternative<SceneWind>(force)) return "wind";
  switch (std::get<SceneObstacle>(force).kind) {
    case SceneObstacle::Kind::Plane:
      return "plane";
    case SceneObstacle::Kind::Sphere:
      return "sphere";
    default:
      return "box";
  }
}

/// "4 springs, gravity"
std::string forces_text(const ElasticScene& scene) {
  std::vector<std::pair<std::string, int>> counts;
  for (const SceneForce& force : scene.forces) {
    const std::string word = force_word(force);
    const auto same =
        std::find_if(counts.begin(), counts.end(), [&](const auto& entry) { return entry.first == word; });
    if (same == counts.end()) {
      counts.emplace_back(word, 1);
    } else {
      ++same->second;
    }
  }
  std::string text;
  for (const auto& [word, count] : counts) {
    text += text.empty() ? "" : ", ";
    text += count == 1 ? word : fmt::format("{} {}{}", count, word, word.back() == 's' ? "" : "s");
  }
  return text.empty() ? "none" : text;
}

/// Steps until the time is over or a signal asks to stop; a step that was begun then is as if it had not been.
void run_steps(Simulation& simulation, SimulationFrames& frames) {
  ElasticRun& run = simulation.run;
  ProgressBar bar("simulating", simulation.arguments.common.quiet);
  const Progress report = bar.callback();
  const double end = run.scene().time.seconds;
  const auto go_on = [&](double /*of the step*/) {
    return report(std::min(1.0, (run.state().time - simulation.begin) / std::max(end - simulation.begin, 1e-300)));
  };
  while (!run.done()) {
    try {
      if (!go_on(0.0)) throw Error(ErrorCode::Cancelled, "stopped");
      simulation.rows.push_back(run.step(go_on));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Cancelled) throw;
      simulation.interrupted = true;
      return;
    }
    frames.take_due();
  }
  frames.take_last();
}

void add_rows(const Simulation& simulation, double used, Table& table) {
  const std::vector<ElasticRow>& rows = simulation.rows;
  const double seconds = simulation.run.state().time - simulation.begin;
  table.add("run", fmt::format("{}, {:.4g} s simulated in {:.3g} s",
                               count_of(static_cast<std::int64_t>(rows.size()), "step", "steps"), seconds, used));
  if (rows.empty()) return;
  const auto rounds = std::max_element(
      rows.begin(), rows.end(), [](const ElasticRow& a, const ElasticRow& b) { return a.step.rounds < b.step.rounds; });
  const auto change = std::max_element(
      rows.begin(), rows.end(), [](const ElasticRow& a, const ElasticRow& b) { return a.step.change < b.step.change; });
  table.add("solves", fmt::format("at most {} a step, the last moved no point by more than {:.3g}", rounds->step.rounds,
                                  change->step.change));
  const ElasticRow& last = rows.back();
  table.add("energy", fmt::format("kinetic {:.4g}, elastic {:.4g}, of forces {:.4g}", last.measure.kinetic_energy,
                                  last.measure.elastic_energy, last.measure.force_energy));
  if (!simulation.run.motion().supports().empty()) {
    const auto worst = std::max_element(rows.begin(), rows.end(), [](const ElasticRow& a, const ElasticRow& b) {
      return a.step.support_error < b.step.support_error;
    });
    table.add("supports", fmt::format("off by at most {:.3g}", worst->step.support_error));
  }
  table.add("at rest", fmt::format("{}: speed {:.3g}, force that nothing balances {:.3g}", last.at_rest ? "yes" : "no",
                                   last.speed, last.measure.residual_force));
  if (simulation.run.refined() > 0) {
    table.add("refined", fmt::format("{}, to {}", count_of(simulation.run.refined(), "time", "times"),
                                     count_of(last.vertices, "vertex", "vertices")));
  }
}

nlohmann::ordered_json row_json(const ElasticRow& row) {
  return {{"time", row.time},
          {"kinetic_energy", row.measure.kinetic_energy},
          {"elastic_energy", row.measure.elastic_energy},
          {"force_energy", row.measure.force_energy},
          {"residual_force", row.measure.residual_force},
          {"speed", row.speed},
          {"at_rest", row.at_rest},
          {"rounds", row.step.rounds},
          {"solver_iterations", row.step.solver_iterations},
          {"change", row.step.change},
          {"settled", row.step.settled},
          {"support_error", row.step.support_error},
          {"time_error", row.step.time_error},
          {"vertices", row.vertices}};
}

nlohmann::ordered_json report_json(const Simulation& simulation, const SimulationFrames& frames) {
  nlohmann::ordered_json json{{"scheme", scheme_json(simulation.run.scheme())},
                              {"begin", simulation.begin},
                              {"end", simulation.run.state().time},
                              {"interrupted", simulation.interrupted},
                              {"at_rest", simulation.run.at_rest()},
                              {"refined", simulation.run.refined()}};
  json["frames"] = nlohmann::ordered_json::array();
  for (const SimulationFrame& frame : frames.frames())
    json["frames"].push_back({{"number", frame.number}, {"time", frame.time}, {"vertices", frame.points.rows()}});
  json["steps"] = nlohmann::ordered_json::array();
  for (const ElasticRow& row : simulation.rows) json["steps"].push_back(row_json(row));
  return json;
}

/// A shape in a picture.
struct ShownShape {
  Mesh mesh;
  double time;
  std::string caption;
};

/// Side by side, with springs and obstacles.
void draw_shapes(const SimulateArguments& arguments, const ElasticRun& run, const std::vector<ShownShape>& shapes,
                 Job& job) {
  Eigen::RowVector3d low = shapes.front().mesh.points.colwise().minCoeff();
  Eigen::RowVector3d high = shapes.front().mesh.points.colwise().maxCoeff();
  for (const ShownShape& shape : shapes) {
    low = low.cwiseMin(shape.mesh.points.colwise().minCoeff());
    high = high.cwiseMax(shape.mesh.points.colwise().maxCoeff());
  }
  std::vector<Subject> subjects;
  for (const ShownShape& shape : shapes) {
    Subject subject;
    subject.control = &shape.mesh;
    subject.topology = run.motion().surface().topology();
    subject.scheme = run.scheme();
    subject.lines = outlines_of(run, shape.mesh.points, shape.time, low, high);
    if (shapes.size() > 1) subject.after_caption = shape.caption;
    subjects.push_back(std::move(subject));
  }
  draw_row(subjects, arguments.picture, job);
}

/// The last shape, the first and the last, or so many moments.
void draw_frames(const Simulation& simulation, const SimulationFrames& frames, Job& job) {
  const SimulateArguments& arguments = simulation.arguments;
  const std::size_t panels =
      arguments.moments ? static_cast<std::size_t>(*arguments.moments) : (arguments.picture.before_after ? 2 : 1);
  const std::vector<SimulationFrame>& all = frames.frames();
  const std::size_t count = std::min(panels, all.size());
  std::vector<ShownShape> shapes;
  for (std::size_t i = 0; i < count; ++i) {
    const SimulationFrame& frame = all[count > 1 ? i * (all.size() - 1) / (count - 1) : all.size() - 1];
    shapes.push_back({frames.mesh_of(frame), frame.time, fmt::format("{:.2f} s", frame.time)});
  }
  draw_shapes(arguments, simulation.run, shapes, job);
}

void plot_run(const std::string& path, const ElasticScene& scene, const std::vector<ElasticRow>& rows) {
  EnergyCurves curves;
  for (const ElasticRow& row : rows) {
    curves.times.push_back(row.time);
    curves.kinetic.push_back(row.measure.kinetic_energy);
    curves.elastic.push_back(row.measure.elastic_energy);
    curves.forces.push_back(row.measure.force_energy);
  }
  plot_energies(path, "Energy of " + scene.name, curves);
}

/// The static solution.
int find_shape(const SimulateArguments& arguments, ElasticRun& run, Table& table, Job& job) {
  const Mesh before = run.mesh();
  const EquilibriumReport found = run.find_equilibrium(ProgressBar("balancing", arguments.common.quiet).callback());
  job.stages.finish("balance");
  const MotionMeasure measure = run.motion().measure(run.state());
  table.add("balance",
            fmt::format("{} after {}, force that nothing balances {:.3g}", found.converged ? "reached" : "not reached",
                        count_of(found.rounds, "round", "rounds"), found.residual_force));
  table.add("energy", fmt::format("elastic {:.4g}, of forces {:.4g}", measure.elastic_energy, measure.force_energy));
  const Mesh mesh = run.mesh();
  const Topology& topology = run.motion().surface().topology();
  const int levels = arguments.levels >= 0 ? arguments.levels : run.scene().output.levels.value_or(-1);
  const std::string written = write_surface({mesh, topology, run.scheme()}, levels, job);
  if (!written.empty()) table.add("written", written);
  if (!arguments.picture.path.empty()) {
    std::vector<ShownShape> shapes;
    if (arguments.picture.before_after) shapes.push_back({before, run.state().time, "where it starts"});
    shapes.push_back({mesh, run.state().time, "where forces balance"});
    draw_shapes(arguments, run, shapes, job);
    job.stages.finish("picture");
  }
  job.print(table);
  job.report({{"scheme", scheme_json(run.scheme())},
              {"equilibrium",
               {{"converged", found.converged},
                {"rounds", found.rounds},
                {"solver_iterations", found.solver_iterations},
                {"change", found.change},
                {"residual_force", found.residual_force},
                {"elastic_energy", measure.elastic_energy},
                {"force_energy", measure.force_energy}}}});
  if (!found.converged) {
    throw Error(ErrorCode::NotConverged, "no equilibrium after " + count_of(found.rounds, "round", "rounds") +
                                             "; the last round still moved a point by " +
                                             fmt::format("{:.3g}", found.change));
  }
  return 0;
}

/// Moves, and writes what came of it.
int run_motion(const SimulateArguments& arguments, ElasticRun& run, Table& table, Job& job) {
  SimulationFrames frames(arguments, run, job);
  Simulation simulation{arguments, run, run.state().time};
  const auto start = std::chrono::steady_clock::now();
  run_steps(simulation, frames);
  job.stages.finish("simulate");
  add_rows(simulation, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), table);
  if (!arguments.state.empty()) write_state(arguments.state, run.save());
  const std::string written = frames.finish(simulation.interrupted);
  if (!written.empty()) table.add("written", written);
  job.stages.finish("write");
  if (!arguments.plot.empty() && !simulation.rows.empty()) plot_run(arguments.plot, run.scene(), simulation.rows);
  if (!arguments.picture.path.empty() && !simulation.interrupted) {
    draw_frames(simulation, frames, job);
    job.stages.finish("picture");
  }
  job.print(table);
  job.report(report_json(simulation, frames));
  if (!simulation.interrupted) return 0;
  fmt::print(stderr, "batten: interrupted at {:.4g} of {:g} seconds; what was done until then is written{}\n",
             run.state().time, run.scene().time.seconds,
             arguments.state.empty() ? "" : ", and --resume " + arguments.state + " goes on");
  return 1;
}

/// The scene's own files.
std::vector<std::string> files_of(const ElasticScene& scene) {
  std::vector<std::string> files{scene.mesh, scene.start};
  for (const auto& force : scene.forces) {
    if (const auto* springs = std::get_if<SceneNearestSprings>(&force)) files.push_back(springs->file);
  }
  return files;
}

}  // namespace

int run_simulate(const SimulateArguments& arguments) {
  const CommonArguments& common = arguments.common;
  ElasticScene scene;
  SceneMeshes meshes;
  std::vector<std::string> notes;
  const auto read = [&] {
    scene = read_scene(common.input);
    require_others({common.output, arguments.state, arguments.plot, arguments.picture.path, common.report},
                   files_of(scene), !arguments.equilibrium);
    meshes = read_scene_meshes(scene, ProgressBar("reading", common.quiet).callback(), &notes);
    CommonArguments mesh = common;
    mesh.input = scene.mesh;
    name_from_output(mesh, meshes.rest);
  };
  Job job("simulate", common, read, UpAxis::Auto);
  job.notes = notes;
  say_notes(notes, common.quiet);
  if (job.up == UpAxis::Auto) job.up = scene.output.up.value_or(find_up_axis(meshes.rest, file_format(scene.mesh)));
  scene.time.seconds = arguments.seconds.value_or(scene.time.seconds);
  scene.time.motion.step = arguments.step.value_or(scene.time.motion.step);
  ElasticRun run(scene, meshes, ProgressBar("building", common.quiet).callback());
  if (!arguments.resume.empty())
    run.resume(read_state(arguments.resume), ProgressBar("building", common.quiet).callback());
  job.stages.finish("build");
  Table table;
  table.add("mesh", mesh_text(run.motion().surface().topology()));
  table.add("scheme", scheme_text(run.scheme()));
  table.add("forces", forces_text(scene));
  return arguments.equilibrium ? find_shape(arguments, run, table, job) : run_motion(arguments, run, table, job);
}

}  // namespace batten::cli
