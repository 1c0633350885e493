/// The command line: parsed here, run in the verbs' own files.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "cli/arguments.h"
#include "cli/signals.h"

namespace batten::cli {
namespace {

template <typename Enum>
using Names = std::map<std::string, Enum>;

const Names<SchemeKind> kSchemes{{"catmull-clark", SchemeKind::CatmullClark},
                                 {"loop", SchemeKind::Loop},
                                 {"butterfly", SchemeKind::Butterfly},
                                 {"modified-butterfly", SchemeKind::ModifiedButterfly}};
const Names<ButterflyBoundary> kButterflyBoundaries{{"crease-rules", ButterflyBoundary::CreaseRules},
                                                    {"reflect", ButterflyBoundary::Reflect}};
const Names<BoundaryRule> kBoundaries{{"none", BoundaryRule::None},
                                      {"edge-only", BoundaryRule::EdgeOnly},
                                      {"edge-and-corner", BoundaryRule::EdgeAndCorner}};
const Names<CreaseMethod> kCreases{{"uniform", CreaseMethod::Uniform}, {"chaikin", CreaseMethod::Chaikin}};
const Names<TriangleRule> kTriangles{{"catmark", TriangleRule::Catmark}, {"smooth", TriangleRule::Smooth}};
const Names<SolveMethod> kMethods{{"auto", SolveMethod::Auto},
                                  {"conjugate-gradient", SolveMethod::ConjugateGradient},
                                  {"chebyshev", SolveMethod::Chebyshev},
                                  {"jacobi", SolveMethod::Jacobi},
                                  {"richardson", SolveMethod::Richardson},
                                  {"direct", SolveMethod::Direct}};
const Names<OnSingular> kOnSingular{
    {"refuse", OnSingular::Refuse}, {"least-squares", OnSingular::LeastSquares}, {"alpha", OnSingular::Alpha}};
const Names<LimitMasks> kMasks{{"exact", LimitMasks::Exact}, {"opensubdiv", LimitMasks::OpenSubdiv}};

const Names<SeriesMatrix> kMatrices{{"limit", SeriesMatrix::Limit}, {"cotangent", SeriesMatrix::Cotangent}};
const Names<FaceKind> kFaces{{"quads", FaceKind::Quads}, {"triangles", FaceKind::Triangles}};

const Names<Coloring> kColorings{{"error", Coloring::Error},     {"moved", Coloring::Moved},
                                 {"mean", Coloring::Mean},       {"gaussian", Coloring::Gaussian},
                                 {"valence", Coloring::Valence}, {"sharpness", Coloring::Sharpness},
                                 {"zebra", Coloring::Zebra}};
const Names<View> kViews{{"front", View::Front}, {"back", View::Back}, {"left", View::Left},    {"right", View::Right},
                         {"top", View::Top},     {"iso", View::Iso},   {"bottom", View::Bottom}};

const Names<TexturePreset> kPresets{{"marble", TexturePreset::Marble},
                                    {"wood", TexturePreset::Wood},
                                    {"granite", TexturePreset::Granite},
                                    {"rust", TexturePreset::Rust},
                                    {"clouds", TexturePreset::Clouds}};

const Names<MorphOrder> kOrders{{"low-first", MorphOrder::LowFirst}, {"low-last", MorphOrder::LowLast}};

/// An option whose words stand for an enumerator; the help lists the words.
template <typename Enum, typename Target>
void add_choice(CLI::App& verb, const std::string& name, Target& target, const Names<Enum>& names,
                const std::string& help) {
  std::string words;
  for (const auto& entry : names) words += (words.empty() ? "" : "|") + entry.first;
  verb.add_option_function<std::string>(
          name, [&target, names](const std::string& word) { target = names.at(word); }, help)
      ->check(CLI::IsMember(names))
      ->option_text(words);
}

/// Refuses other names before any work is done.
CLI::Validator has_extension(const std::vector<std::string>& extensions) {
  return {[extensions](const std::string& name) {
            std::string words;
            for (const std::string& extension : extensions) {
              if (std::filesystem::path(name).extension() == extension) return std::string();
              words += (words.empty() ? "" : " or ") + extension;
            }
            return "'" + name + "' should end in " + words;
          },
          ""};
}

void add_repair_flag(CLI::App& verb, CommonArguments& common) {
  verb.add_flag("--repair", common.repair, "mend the mesh first and say what was changed (see batten repair)");
}

/// For what is called INPUT, unless the verb has a better word.
void add_input(CLI::App& verb, CommonArguments& common, const std::string& name = "INPUT") {
  verb.add_option(name, common.input, "mesh file: .obj .ply .off .stl .xyz, or - for standard input")->required();
  verb.add_option("--input-format", common.input_format, "the input's type where its name does not tell")
      ->option_text("obj|ply|off|stl|xyz");
  verb.add_option("--threads", common.threads, "use at most so many threads (the result is the same)")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  verb.add_flag("--quiet,-q", common.quiet, "print errors only");
  verb.add_option("--report", common.report, "write everything that was measured, for a program")
      ->option_text("FILE.json");
}

void add_output(CLI::App& verb, CommonArguments& common) {
  verb.add_option("-o,--output", common.output, "file to write; the type follows the extension, - is standard output")
      ->option_text("FILE");
  verb.add_option("--output-format", common.output_format, "the output's type where its name does not tell")
      ->option_text("obj|ply|off|stl|xyz|glb|usda");
  verb.add_flag("--ascii", common.ascii, "PLY and STL as text");
}

void add_surface(CLI::App& verb, CommonArguments& common) {
  add_repair_flag(verb, common);
  add_choice(verb, "--scheme", common.scheme, kSchemes,
             "Loop for triangles and Catmull-Clark for anything else, if not given");
  add_choice(verb, "--boundary", common.boundary, kBoundaries,
             "what the surface does at a boundary; overrules the file");
  add_choice(verb, "--creases", common.crease_method, kCreases, "how semi-sharp creases fade; overrules the file");
  add_choice(verb, "--triangles", common.triangle_rule, kTriangles,
             "Catmull-Clark's weights at triangles; overrules the file");
  verb.add_option("--alpha", common.alpha, "Lai and Cheng's alpha in the first step (Catmull-Clark)")
      ->check(CLI::Range(0.0, 1.0))
      ->option_text("0..1");
  verb.add_option("--tension", common.tension,
                  "w of Butterfly's eight points (1/16 if not given) or of Modified Butterfly's ten (0)")
      ->check(CLI::Range(-1.0, 1.0))
      ->option_text("W");
  add_choice(verb, "--butterfly-boundary", common.butterfly_boundary, kButterflyBoundaries,
             "how Butterfly makes points beside boundaries and creases; reflect is the paper's");
  verb.add_flag("--triangulate", common.triangulate, "split all faces into triangles first");
}

/// A name, or three numbers with commas.
std::string read_view(const std::string& words, PictureArguments& picture) {
  if (const auto named = kViews.find(words); named != kViews.end()) {
    picture.view = named->second;
    return "";
  }
  std::array<double, 3> direction{};
  std::istringstream text(words);
  char first = ' ';
  char second = ' ';
  const bool read = static_cast<bool>(text >> direction[0] >> first >> direction[1] >> second >> direction[2]);
  if (!read || first != ',' || second != ',' || !(text >> std::ws).eof())
    return "'" + words +
           "' is neither a view (front, back, left, right, top, bottom, iso) nor a direction like 1,-2,0.5";
  picture.direction = direction;
  return "";
}

void add_picture_options(CLI::App& verb, PictureArguments& picture) {
  verb.add_option("--width", picture.width, "pixels")->check(CLI::Range(1, 16384))->capture_default_str();
  verb.add_option("--height", picture.height, "pixels; if not given, a frame of 4:3 or, for two panels, 8:3")
      ->check(CLI::Range(1, 16384));
  verb.add_option("--samples", picture.samples, "per pixel and axis")->check(CLI::Range(1, 16))->capture_default_str();
  verb.add_option_function<std::string>(
          "--view",
          [&](const std::string& words) {
            const std::string wrong = read_view(words, picture);
            if (!wrong.empty()) throw CLI::ValidationError("--view", wrong);
          },
          "from where: a side, or the direction from the object to the eye")
      ->option_text("front|back|left|right|top|bottom|iso|X,Y,Z");
  verb.add_flag("--before-after", picture.before_after, "two panels: the mesh given, and what became of it");
  verb.add_flag("--transparent", picture.transparent, "no background; the shadow is transparent black");
  verb.add_option("--turntable", picture.turntable, "N pictures around it: NAME-000.png, NAME-001.png, ...")
      ->check(CLI::Range(1, 10000))
      ->option_text("N");
}

void add_coloring(CLI::App& verb, PictureArguments& picture) {
  add_choice(verb, "--color", picture.coloring, kColorings, "colour the surface by a measure, with a colour bar");
}

/// Of the verbs whose own output is a mesh.
void add_picture(CLI::App& verb, PictureArguments& picture) {
  verb.add_option("--picture", picture.path, "draw the result")
      ->check(has_extension({".png"}))
      ->option_text("FILE.png");
  add_picture_options(verb, picture);
}

void add_repair(CLI::App& app, RepairArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("repair", "mend a mesh that no surface can be made of, and say what was changed");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  CLI::Option* weld =
      verb.add_option("--weld", arguments.options.weld,
                      "weld open edges that lie so near, of the bounding box's diagonal; 0: equal points")
          ->check(CLI::Range(0.0, 1.0))
          ->capture_default_str();
  verb.add_flag_callback(
          "--no-weld", [&] { arguments.options.weld = -1.0; }, "weld nothing")
      ->excludes(weld);
  verb.callback([&] { status = run_repair(arguments); });
}

void add_series(CLI::App& verb, SeriesMatrix& matrix) {
  add_choice(verb, "--weights", matrix, kMatrices,
             "limit: of the scheme, by valence, the faster; cotangent: by the shape, however it is meshed");
}

void add_color_moved(CLI::App& verb, PictureArguments& picture) {
  verb.add_flag_callback(
      "--color-moved", [&picture] { picture.coloring = Coloring::Moved; },
      "colour the picture by how far each vertex was moved");
}

void add_denoise(CLI::App& app, DenoiseArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("denoise", "smooth noise away and leave the shape");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  DenoiseOptions& options = arguments.options;
  CLI::Option* automatic =
      verb.add_flag("--auto", options.automatic, "measure the noise, and smooth as much as takes it away");
  CLI::Option* strength =
      verb.add_option("--strength", arguments.strength, "how long a bump may be, in edge lengths, and still vanish")
          ->check(CLI::Range(2.0, 1000.0))
          ->option_text("EDGES")
          ->excludes(automatic);
  verb.add_option("--passes", options.passes, "how often to smooth, instead of a strength")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str()
      ->excludes(automatic)
      ->excludes(strength);
  verb.add_option("-m", options.m, "the larger, the sharper between noise and shape: a pass keeps m + 1 terms")
      ->check(CLI::Range(0, 100))
      ->capture_default_str()
      ->excludes(automatic);
  add_series(verb, options.matrix);
  verb.add_flag("--keep-boundary", options.keep_boundary, "leave boundary vertices where they are");
  verb.add_flag("--keep-volume", options.keep_volume, "scale closed components to the volume that they had");
  verb.add_option_function<double>(
          "--features",
          [&options](const double& degrees) {
            options.features = true;
            options.feature_options.degrees = degrees;
          },
          "find edges that are sharper than this, and smooth along them only, as along creases")
      ->check(CLI::Range(1.0, 179.0))
      ->option_text("DEGREES");
  add_picture(verb, arguments.picture);
  add_color_moved(verb, arguments.picture);
  verb.callback([&] { status = run_denoise(arguments); });
}

void add_sharpen(CLI::App& app, SharpenArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("sharpen", "make a mesh's detail stronger");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  SharpenOptions& options = arguments.options;
  verb.add_option("--amount", options.amount, "of the detail that a pass adds")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  verb.add_option("--passes", options.passes, "how often")->check(CLI::Range(0, 1000))->capture_default_str();
  verb.add_option("-m", options.m, "first term that is added: the larger, the finer the detail that grows")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("-n", options.n, "last term that is added, -m or more")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--most-growth", options.most_growth,
                  "no detail becomes larger than so many times; the amount is lowered for it")
      ->check(CLI::Range(1.0, 1e9))
      ->capture_default_str();
  add_series(verb, options.matrix);
  verb.add_flag("--keep-boundary", options.keep_boundary, "leave boundary vertices where they are");
  verb.add_flag_callback(
      "--no-check", [&options] { options.check = false; }, "do not look for faces that pass through each other");
  add_picture(verb, arguments.picture);
  add_color_moved(verb, arguments.picture);
  verb.callback([&] { status = run_sharpen(arguments); });
}

void add_bands(CLI::App& app, BandsArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("bands", "split a mesh into bands, from bumps to shape, and mix them anew");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  CLI::Option* count = verb.add_option("--count", arguments.count, "of bands; each has bumps twice as long as the last")
                           ->check(CLI::Range(2, 12))
                           ->capture_default_str();
  verb.add_option("--gains", arguments.gains, "how strong each band comes out, finest first: one number a band")
      ->delimiter(',')
      ->excludes(count)
      ->option_text("G1,G2,...");
  add_series(verb, arguments.matrix);
  verb.add_flag("--keep-boundary", arguments.keep_boundary, "leave boundary vertices where they are");
  verb.add_flag("--displacements", arguments.displacements,
                "write every band too, as attributes band_1, band_2, ... of three numbers a vertex (PLY)");
  verb.add_option("--plot", arguments.plot, "plot the bands' sizes")
      ->check(has_extension({".png", ".svg"}))
      ->option_text("FILE.png|.svg");
  add_picture(verb, arguments.picture);
  add_color_moved(verb, arguments.picture);
  verb.callback([&] { status = run_bands(arguments); });
}

struct Verbs {
  SharpenArguments sharpen;
  BandsArguments bands;
  DenoiseArguments denoise;
  CommonArguments info;
  InterpolateArguments interpolate;
  SubdivideArguments subdivide;
  CommonArguments convert;
  RenderArguments render;
  DistanceArguments distance;
  TextureArguments texture;
  MorphArguments morph;
  RepairArguments repair;
};

void add_interpolate(CLI::App& app, InterpolateArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("interpolate", "the control mesh whose limit surface passes through the vertices");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  add_picture(verb, arguments.picture);
  add_coloring(verb, arguments.picture);
  InterpolateOptions& options = arguments.options;
  add_choice(verb, "--method", options.method, kMethods, "how to solve; jacobi is Thall's, richardson Lai and Cheng's");
  verb.add_option("--tolerance", options.tolerance, "largest miss, of the bounding box's diagonal")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--omega", options.omega, "damping of jacobi")->check(CLI::PositiveNumber)->capture_default_str();
  verb.add_option("--max-iterations", options.max_iterations, "give up after so many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_choice(verb, "--on-singular", options.on_singular, kOnSingular,
             "where no surface passes through such points; alpha if not given");
  add_choice(verb, "--limit-masks", options.masks, kMasks, "exact at darts and valence 2, or OpenSubdiv's masks there");
  verb.add_flag("--compare-methods", arguments.compare_methods,
                "solve by the papers' iterations and a direct solver too, and print (and plot) how they did");
  verb.add_option("--plot", arguments.plot, "plot the residual against the iteration")
      ->check(has_extension({".png", ".svg"}))
      ->option_text("FILE.png|.svg");
  verb.add_option("--levels", arguments.levels,
                  "write the limit surface refined so often, instead of the control mesh (.glb: always; 3 times "
                  "if not given, fewer for a large mesh)")
      ->check(CLI::Range(0, 12));
  verb.callback([&] { status = run_interpolate(arguments); });
}

/// A number, or one with a per cent sign: of the diagonal.
void add_length(CLI::App& verb, const std::string& name, std::optional<Length>& target, const std::string& help) {
  verb.add_option_function<std::string>(
          name,
          [&target, name](const std::string& words) {
            std::istringstream text(words);
            Length length;
            const bool read = static_cast<bool>(text >> length.value);
            length.relative = read && text.peek() == '%';
            if (length.relative) {
              text.get();
              length.value /= 100.0;
            }
            if (!read || text.peek() != std::istringstream::traits_type::eof() || !(length.value > 0.0)) {
              throw CLI::ValidationError(name, "'" + words +
                                                   "' is neither a positive length like 0.01 nor a share of the "
                                                   "bounding box's diagonal like 0.1%");
            }
            target = length;
          },
          help)
      ->option_text("LENGTH|PERCENT%");
}

void add_adaptive(CLI::App& verb, SubdivideArguments& arguments) {
  add_length(verb, "--chord", arguments.chord,
             "as few faces as stay so near to the limit surface, in the mesh's unit or in % of the diagonal");
  add_length(verb, "--edge-length", arguments.edge_length, "as few faces as have no longer edge");
  verb.add_option("--angle", arguments.angle, "as few faces as turn by no more than so many degrees each")
      ->check(CLI::PositiveNumber)
      ->option_text("DEGREES");
  add_choice(verb, "--faces", arguments.faces, kFaces,
             "with a bound: what to make; quads for Catmull-Clark and triangles for Loop, if not given");
  verb.add_option("--max-faces", arguments.max_faces, "with a bound: stop with an error beyond so many; 20 million")
      ->check(CLI::PositiveNumber)
      ->option_text("N");
}

/// Refuses options that have no meaning beside another one.
void require_alone(const CLI::App& verb, const std::string& name, const std::vector<std::string>& others) {
  for (const std::string& other : others) {
    if (verb.count(other) > 0) throw CLI::ValidationError(name, "leaves nothing for " + other + " to do");
  }
}

void add_subdivide(CLI::App& app, SubdivideArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("subdivide", "refine a control mesh uniformly, or as far as a bound asks");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  verb.add_option("--levels", arguments.levels, "how often, once if not given; with a bound: at most so often")
      ->check(CLI::Range(0, 16));
  verb.add_flag("--limit", arguments.limit, "then move the vertices to the limit surface, with its normals");
  add_adaptive(verb, arguments);
  verb.add_flag("--compare", arguments.compare,
                "measure how fair Butterfly, Modified Butterfly and the interpolated Loop and Catmull-Clark surfaces "
                "of a triangle mesh are; --picture draws them side by side by their mean curvature");
  add_picture(verb, arguments.picture);
  verb.callback([&verb, &arguments, &status] {
    if (arguments.compare) {
      require_alone(verb, "--compare",
                    {"--output", "--scheme", "--tension", "--limit", "--chord", "--edge-length", "--angle", "--faces",
                     "--max-faces"});
      status = run_compare_schemes(arguments);
      return;
    }
    if (!arguments.adaptive() && (arguments.faces || arguments.max_faces)) {
      throw CLI::ValidationError(arguments.faces ? "--faces" : "--max-faces",
                                 "needs a bound: --chord, --edge-length or --angle");
    }
    if (!arguments.adaptive() && arguments.levels > 12) {
      throw CLI::ValidationError("--levels", "at most 12 without a bound");
    }
    status = arguments.adaptive() ? run_adaptive(arguments) : run_subdivide(arguments);
  });
}

void add_render(CLI::App& app, RenderArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("render", "draw a mesh's subdivision surface");
  add_input(verb, arguments.common);
  verb.add_option("-o,--output", arguments.common.output, "picture to write")->required()->option_text("FILE.png");
  add_surface(verb, arguments.common);
  verb.add_option("--levels", arguments.levels, "refinement; as many as make it smooth, if not given")
      ->check(CLI::Range(0, 12));
  add_picture_options(verb, arguments.picture);
  add_coloring(verb, arguments.picture);
  verb.add_option("--targets", arguments.targets, "for --color error: the mesh whose vertices it should pass through")
      ->option_text("FILE");
  verb.add_flag("--flat", arguments.flat, "draw the mesh as it is");
  verb.add_flag("--control", arguments.control, "with the control mesh as lines");
  verb.add_flag("--points", arguments.points, "with the vertices' limit positions");
  verb.callback([&] { status = run_render(arguments); });
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
      ->capture_default_str();
  verb.add_option("--frequency", noise.frequency, "features along the bounding box's diagonal")
      ->check(CLI::Range(1e-3, 1e6));
  verb.add_option("--octaves", noise.octaves, "finer and finer noises to add up")->check(CLI::Range(1, 24));
  verb.add_option("--gain", noise.gain, "strength of each octave, of the one before; the more, the rougher")
      ->check(CLI::Range(0.0, 4.0));
  verb.add_option_function<std::string>(
          "--colors",
          [&arguments](const std::string& words) {
            const std::string wrong = read_colors(words, arguments.colors);
            if (!wrong.empty()) throw CLI::ValidationError("--colors", wrong);
          },
          "the colours to go through, evenly spaced")
      ->option_text("RRGGBB,RRGGBB,...");
}

void add_texture(CLI::App& app, TextureArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("texture", "colour the limit surface by noise: marble, wood and the like");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  add_choice(verb, "--preset", arguments.preset, kPresets, "what it looks like; plain noise if not given");
  add_noise(verb, arguments);
  CLI::Option* levels =
      verb.add_option("--levels", arguments.levels, "refinement; as many as make some 400,000 faces, if not given")
          ->check(CLI::Range(0, 12));
  verb.add_flag("--flat", arguments.flat, "colour the mesh as it is, not its limit surface")->excludes(levels);
  add_length(verb, "--displace", arguments.displace,
             "also move the surface along its normals by so much times the noise");
  verb.add_option("--gallery", arguments.gallery, "draw all presets side by side")
      ->check(has_extension({".png"}))
      ->option_text("FILE.png");
  add_picture(verb, arguments.picture);
  verb.callback([&] { status = run_texture(arguments); });
}

void add_morph(CLI::App& app, MorphArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("morph", "from one mesh to another of the same connectivity, in frames or a GLB");
  add_input(verb, arguments.common, "FROM");
  verb.add_option("TO", arguments.target, "mesh file, with the same faces or with --resample")->required();
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  CLI::Option* frames = verb.add_option("--frames", arguments.frames,
                                        "so many files, NAME-000, NAME-001, ...; 11 if not given. In a .glb "
                                        "key frames of one animation, 24")
                            ->check(CLI::Range(2, 100000));
  verb.add_option("--at", arguments.at, "one file: how it is at this time; 0 is FROM, 1 is TO")
      ->check(CLI::Range(0.0, 1.0))
      ->option_text("0..1")
      ->excludes(frames);
  add_choice(verb, "--order", arguments.options.order, kOrders,
             "what moves first: the overall shape, or the detail; low-first if not given");
  verb.add_option(
          "--stages", arguments.options.stages,
          "how far overall shape and detail are apart in time; each takes four times the work; 0: straight lines")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  verb.add_option("--terms", arguments.options.m,
                  "terms of the mesh series after the first in a smoothing; Lai and Cheng's m")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  verb.add_option("--rho", arguments.rho, "Lai and Cheng's own sequence, which comes near to TO so fast")
      ->check(CLI::Range(1e-6, 1.0))
      ->option_text("0..1");
  verb.add_flag_callback(
      "--no-align", [&] { arguments.align = false; }, "with --rho: do not lay the centroids on each other first");
  verb.add_option("--seconds", arguments.seconds, "how long a .glb's animation is")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--levels", arguments.levels,
                  "refinement of a .glb's surface; 3 if not given, fewer for a large mesh")
      ->check(CLI::Range(0, 12));
  verb.add_flag("--resample", arguments.resample, "give TO's surface the faces of FROM first; both must lie close");
  add_picture(verb, arguments.picture);
  verb.callback([&] { status = run_morph(arguments); });
}

void add_distance(CLI::App& app, DistanceArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("distance", "how far points lie from the limit surface of a mesh");
  verb.add_option("SCAN", arguments.scan, "its vertices are measured: .obj .ply .off .stl .xyz")->required();
  add_input(verb, arguments.common, "SURFACE");
  verb.add_option("-o,--output", arguments.common.output,
                  "write the scan with each point's distance, as the property \"distance\"")
      ->check(has_extension({".ply"}))
      ->option_text("FILE.ply");
  verb.add_flag("--ascii", arguments.common.ascii, "PLY as text");
  add_surface(verb, arguments.common);
  add_picture(verb, arguments.picture);
  verb.callback([&] { status = run_distance(arguments); });
}

int run(int argc, char** argv) {
  CLI::App app("Batten: smooth subdivision surfaces through data.", "batten");
  app.set_version_flag("--version", std::string("batten ") + BATTEN_VERSION);
  app.set_help_all_flag("--help-all", "Print the help of every verb");
  app.require_subcommand(1);
  app.get_formatter()->column_width(38);
  Verbs verbs;
  int status = 0;
  add_interpolate(app, verbs.interpolate, status);
  add_subdivide(app, verbs.subdivide, status);
  add_render(app, verbs.render, status);
  add_distance(app, verbs.distance, status);
  add_texture(app, verbs.texture, status);
  add_denoise(app, verbs.denoise, status);
  add_sharpen(app, verbs.sharpen, status);
  add_bands(app, verbs.bands, status);
  add_morph(app, verbs.morph, status);
  add_repair(app, verbs.repair, status);
  CLI::App& info = *app.add_subcommand("info", "what a mesh is made of, and whether a surface can be made of it");
  add_input(info, verbs.info);
  add_repair_flag(info, verbs.info);
  info.callback([&] { status = run_info(verbs.info); });
  CLI::App& convert = *app.add_subcommand("convert", "read one format, write another");
  add_input(convert, verbs.convert);
  add_output(convert, verbs.convert);
  add_repair_flag(convert, verbs.convert);
  convert.add_flag("--triangulate", verbs.convert.triangulate, "split all faces into triangles");
  convert.callback([&] { status = run_convert(verbs.convert); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return status;
}

/// The way out that only the tool knows.
const char* hint(ErrorCode code) {
  switch (code) {
    case ErrorCode::DegenerateFace:
    case ErrorCode::RepeatedFace:
    case ErrorCode::NonManifoldEdge:
    case ErrorCode::NonManifoldVertex:
    case ErrorCode::InconsistentFaces:
    case ErrorCode::NonOrientable:
      return " (or let --repair do it)";
    default:
      return "";
  }
}

}  // namespace
}  // namespace batten::cli

int main(int argc, char** argv) {
  batten::cli::handle_signals();
  try {
    const int status = batten::cli::run(argc, argv);
    // What was printed may still wait in the buffer; a closed pipe or a full disk shows here.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    std::fprintf(stderr, "batten: standard output: cannot be written: %s\n", std::strerror(errno));
  } catch (const batten::Error& error) {
    if (error.code() == batten::ErrorCode::Cancelled) {
      std::fprintf(stderr, "batten: interrupted; unfinished files are as they were\n");
    } else {
      std::fprintf(stderr, "batten: %s%s\n", error.what(), batten::cli::hint(error.code()));
    }
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "batten: out of memory; take a smaller mesh or fewer levels\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "batten: %s\n", error.what());
  }
  return 1;
}
