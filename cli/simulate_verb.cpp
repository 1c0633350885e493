#include "batten/io/io.h"
#include "cli/options.h"
#include "cli/verbs.h"

namespace batten::cli {

namespace {

const Names<Coloring> kSimulationColorings{
    {"mean", Coloring::Mean}, {"gaussian", Coloring::Gaussian}, {"zebra", Coloring::Zebra}};

/// Refuses what has no meaning for one shape, and several files on standard output.
void check_simulation(const CLI::App& verb, const SimulateArguments& arguments) {
  if (arguments.equilibrium)
    require_alone(verb, "--equilibrium", {"--seconds", "--step", "--plot", "--moments", "--state"});
  require_with(verb, {"--levels"}, {"--output"});
  require_with(verb, {"--moments"}, {"--picture"});
  if (arguments.moments) require_alone(verb, "--moments", {"--before-after"});
  const std::string& output = arguments.common.output;
  if (output.empty() || arguments.equilibrium) return;
  if (is_standard_output(output) && file_format(output, arguments.common.output_format) != "glb")
    throw UsageError("standard output takes one file: ask for a .glb, or for --equilibrium");
}

}  // namespace

void add_simulate(CLI::App& app, SimulateArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("simulate", "move a surface as an elastic body, as a scene file says");
  add_input_file(verb, "SCENE", arguments.common.input, "scene, .json (see docs/simulate.md); - is standard input")
      ->required();
  add_common(verb, arguments.common);
  add_output(verb, arguments.common);
  verb.add_option("--levels", arguments.levels,
                  "write the limit surface refined so often; if neither this nor the scene says so the control mesh, "
                  "or for GLB at most 3")
      ->check(whole_number(0, 8));
  verb.add_option("--seconds", arguments.seconds, "how long, instead of what the scene says")->check(positive_number());
  verb.add_option("--step", arguments.step, "seconds of a step, instead of the scene's")->check(positive_number());
  verb.add_flag("--equilibrium", arguments.equilibrium, "find the shape at which all forces balance, and write that");
  add_output_file(verb, "--state", arguments.state, "write where the run ended, also after Ctrl-C, for --resume", {});
  verb.add_option("--resume", arguments.resume, "go on where an earlier run of this scene ended")->option_text("STATE");
  add_output_file(verb, "--plot", arguments.plot, "plot the energies against time", {".png", ".svg"});
  add_picture(verb, arguments.picture);
  add_range(verb, arguments.picture);
  add_choice(verb, "--color", arguments.picture.coloring, kSimulationColorings,
             "colour the surface by its curvature, or draw bands that it mirrors");
  verb.add_option("--moments", arguments.moments,
                  "with --picture: so many frames side by side, first and last among "
                  "them, instead of the last alone")
      ->check(whole_number(2, 12));
  set_run(verb, arguments.common, status, [&] {
    check_simulation(verb, arguments);
    return run_simulate(arguments);
  });
}

}  // namespace batten::cli
