#include "cli/options.h"
#include "cli/verbs.h"

namespace batten::cli {

namespace {

/// Creases are found with the mesh that they lie on; only a file has some to keep.
void require_creases(const FitArguments& arguments) {
  if (!arguments.creases) return;
  const bool file = arguments.init != kInitAuto && arguments.init != kInitSphere;
  if (*arguments.creases == FitCreases::Keep && !file)
    throw UsageError("--creases keep keeps the creases of --init FILE, which is not given");
  if (*arguments.creases == FitCreases::Auto && arguments.init != kInitAuto)
    throw UsageError("--creases auto finds sharp edges with a mesh of its own: give keep or none with --init");
}

}  // namespace

void add_fit(CLI::App& app, FitArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("fit", "from points to a small, editable subdivision surface");
  add_input(verb, arguments.common, "POINTS", "scan or fine mesh");
  add_output(verb, arguments.common);
  add_repair_flag(verb, arguments.common);
  verb.add_option("--init", arguments.init,
                  "start from a mesh of the right genus that is found, from a sphere, or from this control mesh, whose "
                  "faces and vertex order stay; auto")
      ->type_name("FILE")
      ->option_text("auto|sphere|FILE");
  add_choice(verb, "--method", arguments.method,
             Names<FitMethod>{{"squared-distance", FitMethod::SquaredDistance}, {"dynamic", FitMethod::Dynamic}},
             "steps that make squared distances least, or springs that draw an elastic surface; squared-distance");
  verb.add_option("--vertices", arguments.vertices, "at most so many control points; 400, or those of --init FILE")
      ->check(whole_number(8));
  verb.add_option("--rounds", arguments.rounds,
                  "at most so many rounds for each number of control points; 30. Fewer are faster")
      ->check(whole_number(1));
  add_length(verb, "--tolerance", arguments.tolerance, "stop when no point is farther from the surface");
  verb.add_option("--genus", arguments.genus, "how many handles the surface has; found if not given")
      ->check(whole_number(0));
  add_length(verb, "--bridge", arguments.bridge,
             "close holes in the data up to this width; wider ones become boundaries; a fifth of the longest side");
  add_choice(
      verb, "--creases", arguments.creases,
      Names<FitCreases>{{"auto", FitCreases::Auto}, {"none", FitCreases::None}, {"keep", FitCreases::Keep}},
      "sharp edges that are found in the points, none, or those that --init FILE has tagged; auto, and keep with "
      "--init FILE");
  add_choice(verb, "--scheme", arguments.common.scheme,
             Names<SchemeKind>{{"catmull-clark", SchemeKind::CatmullClark}, {"loop", SchemeKind::Loop}},
             "catmull-clark, or that of --init FILE, if not given");
  add_output_file(verb, "--residuals", arguments.residuals,
                  "write the points with their distances, as the property \"distance\"", {".ply"});
  add_evolution(verb, arguments.evolution);
  add_picture(verb, arguments.picture);
  add_range(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb, {"--picture", "--report", "--residuals", "--frames", "--film"});
    require_with(verb, {"--moments"}, {"--picture"});
    if (arguments.init != kInitAuto) require_alone(verb, "--init", {"--genus", "--bridge"});
    require_creases(arguments);
    return run_fit(arguments);
  });
}

}  // namespace batten::cli
