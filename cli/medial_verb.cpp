#include "cli/options.h"
#include "cli/verbs.h"

namespace batten::cli {

namespace {

const Names<MedialColoring> kMedialColorings{{"angle", MedialColoring::Angle},
                                             {"distance", MedialColoring::Distance},
                                             {"shift", MedialColoring::Shift},
                                             {"radius", MedialColoring::Radius}};

}  // namespace

void add_medial(CLI::App& app, MedialArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("medial", "the smooth surface through the spoke ends of a medial model");
  add_input_file(verb, "MODEL", arguments.common.input,
                 "medial model: .srep.json of 3D Slicer, or .json (see docs/medial.md); - is standard input")
      ->required();
  add_common(verb, arguments.common);
  add_output(verb, arguments.common);
  verb.add_option("--levels", arguments.levels,
                  "write the limit surface refined so often; the control mesh, or for GLB at most 3, if not given")
      ->check(whole_number(0, 12));
  add_output_file(verb, "--sheet", arguments.sheet, "write the medial sheet as a mesh", {});
  add_output_file(verb, "--model", arguments.model, "write the model again, as .srep.json or .json", {".json"});
  verb.add_option("--sheet-levels", arguments.sheet_levels, "refine the sheet of --sheet and --model so often")
      ->check(whole_number(0, 10));
  verb.add_flag("--normals", arguments.normals,
                "refine twice and turn the surface's normals to the directions of the spokes");
  add_normal_tolerance(verb, arguments.normal_tolerance);
  add_picture(verb, arguments.picture);
  add_range(verb, arguments.picture);
  add_choice(verb, "--color", arguments.coloring, kMedialColorings,
             "colour the surface by how far its normals or its atoms are off, or by the radius");
  set_run(verb, arguments.common, status, [&] {
    require_with(verb, {"--sheet-levels"}, {"--sheet", "--model"});
    require_with(verb, {"--normal-tolerance"}, {"--normals"});
    require_with(verb, {"--levels"}, {"--output", "--picture"});
    return run_medial(arguments);
  });
}

}  // namespace batten::cli
