#include "cli/files.h"
#include "cli/options.h"
#include "cli/usage_error.h"
#include "cli/verbs.h"

namespace batten::cli {

namespace {

/// What the surface starts from, and what draws it.
void add_starts(CLI::App& verb, SegmentArguments& arguments) {
  add_input_volume(verb, "--mask", arguments.mask,
                   "the volume of labels, on a grid of its own; the image itself, if not given");
  verb.add_option("--label", arguments.labels, "the label, or several as one: 71,72; all numbers but 0, if not given")
      ->delimiter(',')
      ->check(number_in(-1e9, 1e9))
      ->option_text("N,...");
  verb.add_flag("--together", arguments.together,
                "a surface for each --label, which do not meet each other, in files of their own: -o organ.obj writes "
                "organ-71.obj and organ-72.obj. --inside then has the labels' numbers");
  add_input_files(verb, "--points", arguments.points,
                  "points on the border of the part: the surface starts from them and is drawn to them and to the "
                  "image's edges; .mrk.json or .fcsv of 3D Slicer, which say their world, or .xyz or a mesh, in the "
                  "world of --space. May stand several times. Labels are then only compared with");
  verb.add_option(
          "--slices", arguments.slices,
          "with --mask: points are the border of the label in every Nth slice, as if only these had been drawn; "
          "1 for a label that is painted in some slices only, across whatever index")
      ->check(whole_number(1));
  verb.add_option("--seed", arguments.seed,
                  "a place in the part, in mm of the world of --space: the surface starts from what a front reaches "
                  "from there before it leaks through the image's edges, and is drawn to them")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  verb.add_option("--numbers", arguments.numbers, "with --seed: the least and the greatest number in the part")
      ->delimiter(',')
      ->expected(2)
      ->option_text("LOW,HIGH");
  add_input_file(verb, "--start", arguments.start,
                 "a closed control mesh in the world of --space, which is drawn to the image's edges");
  verb.add_flag("--edges", arguments.edges, "draw the surface of the labels to the image's edges, too");
}

/// One start, and what a given mesh says itself.
void exclude_starts(CLI::App& verb) {
  const std::vector<std::string> starts{"--points", "--slices", "--seed", "--start"};
  for (const std::string& start : starts) {
    for (const std::string& other : starts) {
      if (start != other) verb.get_option(start)->excludes(verb.get_option(other));
    }
  }
  for (const char* option :
       {"--points", "--slices", "--seed", "--start", "--edges", "--parts", "--frames", "--film", "--moments"})
    verb.get_option("--together")->excludes(verb.get_option(option));
  for (const char* option : {"--vertices", "--genus", "--smoothing", "--scheme"})
    verb.get_option("--start")->excludes(verb.get_option(option));
}

}  // namespace

void add_segment(CLI::App& app, SegmentArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand(
      "segment",
      "from a label of a volume, or points on a part of it or a seed in it, to a small, smooth control mesh");
  add_input_volume(verb, "VOLUME", arguments.common.input,
                   "the image: .nii .nii.gz .nrrd .nhdr .mha .mhd, or a folder of DICOM slices")
      ->required();
  add_starts(verb, arguments);
  add_common(verb, arguments.common);
  add_output(verb, arguments.common);
  verb.add_option("--vertices", arguments.vertices, "about so many control points; 386")->check(whole_number(8));
  verb.add_option("--genus", arguments.genus, "how many handles the surface has; found if not given")
      ->check(whole_number(0));
  verb.add_option("--smoothing", arguments.smoothing,
                  "how far the surface may stay away from the steps between voxels, in voxels (RMS); 0.15")
      ->check(number_in(0.0, 10.0))
      ->option_text("VOXELS");
  add_choice(verb, "--scheme", arguments.common.scheme,
             Names<SchemeKind>{{"catmull-clark", SchemeKind::CatmullClark}, {"loop", SchemeKind::Loop}},
             "catmull-clark, if not given");
  verb.add_option("--levels", arguments.levels, "write the limit surface refined so often, instead of the control mesh")
      ->check(whole_number(0, 8));
  add_choice(verb, "--space", arguments.space, Names<WorldSpace>{{"ras", WorldSpace::Ras}, {"lps", WorldSpace::Lps}},
             "the world of the mesh that is written: x to the right and y to the front, or both the other way; ras");
  add_output_file(verb, "--overlay", arguments.overlay, "draw slices of the image with the surface's outline",
                  {".png"});
  add_output_file(verb, "--inside", arguments.inside, "write 1 where a voxel's centre is inside, on the image's grid",
                  {".nii", ".gz", ".nrrd", ".mha"});
  verb.add_flag("--parts", arguments.parts, "with --inside: write the share of each voxel that is inside");
  add_evolution(verb, arguments.evolution);
  add_picture(verb, arguments.picture);
  exclude_starts(verb);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb, {"--picture", "--report", "--overlay", "--inside", "--frames", "--film"});
    require_with(verb, {"--moments"}, {"--picture"});
    require_with(verb, {"--parts"}, {"--inside"});
    require_with(verb, {"--together"}, {"--label"});
    if (arguments.together && is_standard_output(arguments.common.output))
      throw UsageError("--together writes a file for each label: standard output takes one");
    require_with(verb, {"--edges", "--slices"}, {"--mask"});
    require_with(verb, {"--numbers"}, {"--seed"});
    return run_segment(arguments);
  });
}

}  // namespace batten::cli
