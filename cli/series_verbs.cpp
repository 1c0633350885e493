#include "cli/verbs.h"

#include <array>
#include <limits>
#include <sstream>

#include "batten/io/io.h"
#include "cli/options.h"

namespace batten::cli {

namespace {

const Names<SeriesMatrix> kMatrices{{"limit", SeriesMatrix::Limit}, {"cotangent", SeriesMatrix::Cotangent}};
const Names<MorphOrder> kOrders{{"low-first", MorphOrder::LowFirst}, {"low-last", MorphOrder::LowLast}};

Names<TexturePreset> preset_names() {
  Names<TexturePreset> names;
  for (const auto& [preset, name] : kTexturePresets) names[name] = preset;
  return names;
}

void add_series(CLI::App& verb, SeriesMatrix& matrix) {
  add_choice(verb, "--weights", matrix, kMatrices,
             "limit: of the scheme, by valence, the faster; cotangent: by the shape, however it is meshed");
}

void add_color_moved(CLI::App& verb, PictureArguments& picture) {
  verb.add_flag_callback(
      "--color-moved", [&picture] { picture.coloring = Coloring::Moved; },
      "colour the picture by how far each vertex was moved");
  add_range(verb, picture);
}

/// "f4f2ee,#3a3f48": colours as they stand in web pages.
std::string read_colors(const std::string& words, std::vector<std::array<double, 3>>& colors) {
  colors.clear();
  std::istringstream text(words);
  for (std::string word; std::getline(text, word, ',');) {
    const std::string digits = word.rfind('#', 0) == 0 ? word.substr(1) : word;
    if (digits.size() != 6 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) {
      return "'" + word + "' is not a colour like ff8800";
    }
    const unsigned long number = std::stoul(digits, nullptr, 16);
    constexpr double kWhite = 255.0;
    colors.push_back({static_cast<double>(number >> 16U & 255U) / kWhite,
                      static_cast<double>(number >> 8U & 255U) / kWhite, static_cast<double>(number & 255U) / kWhite});
  }
  return colors.empty() ? "needs a colour at least, like ff8800" : "";
}

void add_noise(CLI::App& verb, TextureArguments& arguments) {
  PresetOptions& noise = arguments.noise;
  verb.add_option("--seed", noise.seed, "another number, another texture; the same number, the same texture")
      ->check(whole_number(0, std::numeric_limits<long long>::max()))
      ->capture_default_str();
  verb.add_option("--frequency", noise.frequency, "features along the bounding box's diagonal")
      ->check(number_in(1e-3, 1e6));
  verb.add_option("--octaves", noise.octaves, "finer and finer noises to add up")->check(whole_number(1, 24));
  verb.add_option("--gain", noise.gain, "strength of each octave, of the one before; the more, the rougher")
      ->check(number_in(0.0, 4.0));
  verb.add_option_function<std::string>(
          "--colors",
          [&arguments](const std::string& words) {
            const std::string wrong = read_colors(words, arguments.colors);
            if (!wrong.empty()) throw CLI::ValidationError("--colors", wrong);
          },
          "the colours to go through, evenly spaced")
      ->option_text("RRGGBB,RRGGBB,...");
}

/// Refuses one shape, or the paper's sequence, where the output is an animation or the other is asked for, and several
/// files on standard output.
void check_frames(const MorphArguments& arguments, bool animated) {
  if (animated && (arguments.rho || arguments.at)) {
    throw UsageError(std::string(arguments.rho ? "--rho" : "--at") +
                     " writes shapes, not an animation: name an .obj or .ply instead of the .glb");
  }
  if (arguments.rho && arguments.at) {
    throw UsageError("--rho gives a sequence of frames; --at belongs to the morph without it");
  }
  if (is_standard_output(arguments.common.output) && !animated && !arguments.at) {
    throw UsageError("standard output takes one file: ask for one shape by --at, or for a .glb");
  }
}

/// Refuses what the kind of output leaves without an effect, and frames that would replace an input.
void check_morph(const CLI::App& verb, const MorphArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const bool animated = !common.output.empty() && file_format(common.output, common.output_format) == "glb";
  if (!animated) {
    for (const char* option : {"--seconds", "--levels"}) {
      if (is_given(verb, option)) throw UsageError(std::string(option) + " does nothing without a .glb to write");
    }
  }
  require_with(verb, {"--no-align"}, {"--rho"});
  if (arguments.rho) require_alone(verb, "--rho", {"--order", "--stages"});
  check_frames(arguments, animated);
  if (common.output.empty() || animated || arguments.at) return;
  check_numbered_files(verb, common.output, arguments.frames < 0 ? kMorphFrames : arguments.frames);
}

}  // namespace

void add_denoise(CLI::App& app, DenoiseArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("denoise", "smooth noise away and leave the shape");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  DenoiseOptions& options = arguments.options;
  CLI::Option* automatic =
      verb.add_flag("--auto", options.automatic,
                    "measure the noise, and smooth as much as takes it away: what is done where nothing else is said");
  CLI::Option* strength =
      verb.add_option("--strength", arguments.strength, "how long a bump may be, in edge lengths, and still vanish")
          ->check(number_in(2.0, 1000.0))
          ->option_text("EDGES")
          ->excludes(automatic);
  verb.add_option("--passes", options.passes, "how often to smooth, instead of a strength")
      ->check(whole_number(0, 1000000))
      ->capture_default_str()
      ->excludes(automatic)
      ->excludes(strength);
  verb.add_option("-m", options.m, "the larger, the sharper between noise and shape: a pass keeps m + 1 terms")
      ->check(whole_number(0, 100))
      ->capture_default_str()
      ->excludes(automatic);
  add_series(verb, options.matrix);
  verb.add_flag("--keep-boundary", options.keep_boundary, "leave boundary vertices where they are");
  verb.add_flag("--keep-volume", options.keep_volume, "scale closed components to the volume that they had");
  add_picture(verb, arguments.picture);
  add_color_moved(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb);
    const bool chosen = is_given(verb, "--strength") || is_given(verb, "--passes") || is_given(verb, "-m");
    if (!chosen) arguments.options.automatic = true;
    return run_denoise(arguments);
  });
}

void add_sharpen(CLI::App& app, SharpenArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("sharpen", "make a mesh's detail stronger");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  SharpenOptions& options = arguments.options;
  verb.add_option("--amount", options.amount, "of the detail that a pass adds")
      ->check(number_in(0.0, 1e6))
      ->capture_default_str();
  verb.add_option("--passes", options.passes, "how often")->check(whole_number(0, 1000))->capture_default_str();
  verb.add_option("-m", options.m, "first term that is added: the larger, the finer the detail that grows")
      ->check(whole_number(1, 1000))
      ->capture_default_str();
  verb.add_option("-n", options.n, "last term that is added, -m or more")
      ->check(whole_number(1, 1000))
      ->capture_default_str();
  verb.add_option("--most-growth", options.most_growth,
                  "no detail becomes larger than so many times; the amount is lowered for it")
      ->check(number_in(1.0, 1e9))
      ->capture_default_str();
  add_series(verb, options.matrix);
  verb.add_flag("--keep-boundary", options.keep_boundary, "leave boundary vertices where they are");
  verb.add_flag_callback(
      "--no-check", [&options] { options.check = false; }, "do not look for faces that pass through each other");
  add_picture(verb, arguments.picture);
  add_color_moved(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb);
    return run_sharpen(arguments);
  });
}

void add_bands(CLI::App& app, BandsArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("bands", "split a mesh into bands, from bumps to shape, and mix them again");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  CLI::Option* count = verb.add_option("--count", arguments.count, "of bands; each has bumps twice as long as the last")
                           ->check(whole_number(2, 12))
                           ->capture_default_str();
  verb.add_option("--gains", arguments.gains, "how strong each band comes out, finest first: one number a band")
      ->delimiter(',')
      ->excludes(count)
      ->option_text("G1,G2,...");
  add_series(verb, arguments.matrix);
  verb.add_flag("--keep-boundary", arguments.keep_boundary, "leave boundary vertices where they are");
  verb.add_flag("--displacements", arguments.displacements,
                "write every band too, as attributes band_1, band_2, ... of three numbers a vertex (PLY)");
  add_output_file(verb, "--plot", arguments.plot, "plot the bands' sizes", {".png", ".svg"});
  add_picture(verb, arguments.picture);
  add_color_moved(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb);
    require_with(verb, {"--displacements"}, {"--output"});
    return run_bands(arguments);
  });
}

void add_texture(CLI::App& app, TextureArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("texture", "colour the limit surface by noise: marble, wood and the like");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  add_choice(verb, "--preset", arguments.preset, preset_names(), "what it looks like; plain noise if not given");
  add_noise(verb, arguments);
  CLI::Option* levels =
      verb.add_option("--levels", arguments.levels, "refinement; as many as make some 400,000 faces, if not given")
          ->check(whole_number(0, 12));
  verb.add_flag("--flat", arguments.flat, "colour the mesh as it is, not its limit surface")->excludes(levels);
  add_length(verb, "--displace", arguments.displace,
             "also move the surface along its normals by so much times the noise");
  add_output_file(verb, "--gallery", arguments.gallery, "draw all presets side by side", {".png"});
  add_picture(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb);
    return run_texture(arguments);
  });
}

void add_morph(CLI::App& app, MorphArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("morph", "from one mesh to another of the same connectivity, in frames or a GLB");
  add_input(verb, arguments.common, "FROM");
  add_input_file(verb, "TO", arguments.target, "mesh file, with the same faces or with --resample")->required();
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  CLI::Option* frames = verb.add_option("--frames", arguments.frames,
                                        "so many files, NAME-000, NAME-001, ...; 11 if not given. In a .glb "
                                        "key frames of one animation, 24")
                            ->check(whole_number(2, 100000));
  verb.add_option("--at", arguments.at, "one file: how it is at this time; 0 is FROM, 1 is TO")
      ->check(number_in(0.0, 1.0))
      ->option_text("0..1")
      ->excludes(frames);
  add_choice(verb, "--order", arguments.options.order, kOrders,
             "what moves first: the overall shape, or the detail; low-first if not given");
  verb.add_option(
          "--stages", arguments.options.stages,
          "how far overall shape and detail are apart in time; each takes four times the work; 0: straight lines")
      ->check(whole_number(0, 8))
      ->capture_default_str();
  verb.add_option("--terms", arguments.options.m,
                  "terms of the mesh series after the first in a smoothing; Lai and Cheng's m")
      ->check(whole_number(0, 1000))
      ->capture_default_str();
  verb.add_option("--rho", arguments.rho, "Lai and Cheng's own sequence, which comes near to TO so fast")
      ->check(number_in(1e-6, 1.0))
      ->option_text("0..1");
  verb.add_flag_callback(
      "--no-align", [&] { arguments.align = false; }, "with --rho: do not lay the centroids on each other first");
  verb.add_option("--seconds", arguments.seconds, "how long a .glb's animation is")
      ->check(number_in(1e-3, 1e6))
      ->capture_default_str();
  verb.add_option("--levels", arguments.levels,
                  "refinement of a .glb's surface; 3 if not given, fewer for a large mesh")
      ->check(whole_number(0, 12));
  verb.add_flag("--resample", arguments.resample, "give TO's surface the faces of FROM first; both must lie close");
  add_picture(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb);
    check_morph(verb, arguments);
    return run_morph(arguments);
  });
}

}  // namespace batten::cli
