#include "cli/options.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "batten/io/io.h"

namespace batten::cli {

namespace {

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
const Names<FaceVaryingRule> kFaceVarying{{"none", FaceVaryingRule::None},
                                          {"corners-only", FaceVaryingRule::CornersOnly},
                                          {"corners-plus1", FaceVaryingRule::CornersPlus1},
                                          {"corners-plus2", FaceVaryingRule::CornersPlus2},
                                          {"boundaries", FaceVaryingRule::Boundaries},
                                          {"all", FaceVaryingRule::All}};
const Names<AttributeRule> kAttributes{{"midpoint", AttributeRule::Midpoint},
                                       {"scheme", AttributeRule::Scheme},
                                       {"interpolated", AttributeRule::Interpolated}};
const Names<Coloring> kColorings{
    {"error", Coloring::Error},       {"moved", Coloring::Moved},     {"mean", Coloring::Mean},
    {"gaussian", Coloring::Gaussian}, {"valence", Coloring::Valence}, {"sharpness", Coloring::Sharpness},
    {"zebra", Coloring::Zebra},       {"checker", Coloring::Checker}, {"normals", Coloring::Normals}};
const Names<View> kViews{{"front", View::Front}, {"back", View::Back}, {"left", View::Left},    {"right", View::Right},
                         {"top", View::Top},     {"iso", View::Iso},   {"bottom", View::Bottom}};

const Names<UpAxis> kUpAxes{{"x", UpAxis::X},       {"y", UpAxis::Y},       {"z", UpAxis::Z},
                            {"-x", UpAxis::MinusX}, {"-y", UpAxis::MinusY}, {"-z", UpAxis::MinusZ}};

/// What --picture alone gives a meaning, in the verbs that have it.
const std::vector<std::string> kPictureOptions{"--width",       "--height",     "--samples", "--view",
                                               "--turntable",   "--color",      "--range",   "--before-after",
                                               "--transparent", "--color-moved"};

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
  if (std::all_of(direction.begin(), direction.end(), [](double part) { return part == 0.0; }))
    return "'" + words + "' is no direction; give one like 1,-2,0.5";
  picture.direction = direction;
  return "";
}

/// An up axis means something to pictures, GLB and USD.
void require_upright(const CLI::App& verb, const CommonArguments& common) {
  if (!is_given(verb, "--up") || verb.get_name() == "render") return;
  if (is_given(verb, "--picture") || is_given(verb, "--gallery")) return;
  const bool writes = is_given(verb, "--output");
  const std::string format = writes ? file_format(common.output, common.output_format) : "";
  if (format == "glb" || format == "usda") return;
  throw UsageError(writes ? "--up does nothing for ." + format + ", only for pictures, .glb and .usda"
                          : std::string("--up does nothing without a picture, a .glb or a .usda"));
}

/// "A:B"; empty where the words are two ascending numbers.
std::string read_range(const std::string& words, PictureArguments& picture) {
  std::array<double, 2> range{};
  std::istringstream text(words);
  char between = ' ';
  const bool read = static_cast<bool>(text >> range[0] >> between >> range[1]) && between == ':';
  if (!read || !(text >> std::ws).eof() || !(range[0] < range[1])) {
    return "'" + words + "' is not a range like 0:2.5, the smaller number first";
  }
  picture.range = range;
  return "";
}

/// Standard output takes one picture.
void require_picture_files(const CLI::App& verb) {
  const CLI::Option* picture = verb.get_option_no_throw("--picture");
  if (picture == nullptr) picture = verb.get_option("--output");
  for (const std::string& path : picture->results()) {
    if (is_standard_output(path)) throw UsageError("--turntable: standard output takes one picture; name a file");
  }
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& words) {
  return {[words](const std::string& word) {
            if (std::find(words.begin(), words.end(), word) != words.end()) return std::string();
            const std::string near = suggestion(word, words);
            return "'" + word + "' is not one of " + CLI::detail::join(words, ", ") + near;
          },
          ""};
}

void add_repair_flag(CLI::App& verb, CommonArguments& common) {
  verb.add_flag("--repair", common.repair, "repair the mesh first and list what was changed (see batten repair)");
}

void add_input(CLI::App& verb, CommonArguments& common, const std::string& name, const std::string& what) {
  add_input_file(verb, name, common.input,
                 what + ": .obj .ply .off .stl .xyz .glb .gltf, also as .gz, or - for standard input")
      ->required();
  verb.add_option("--input-format", common.input_format, "the input's type where its name does not tell")
      ->option_text("obj|ply|off|stl|xyz|glb|gltf");
  add_common(verb, common);
}

void add_common(CLI::App& verb, CommonArguments& common) {
  verb.add_option("--threads", common.threads, "use at most so many threads (the result is the same)")
      ->check(whole_number(0))
      ->option_text("N");
  verb.add_flag("--quiet,-q", common.quiet, "print errors only");
  add_output_file(verb, "--report", common.report, "write everything that was measured, for a program", {".json"});
}

void add_output(CLI::App& verb, CommonArguments& common) {
  add_output_file(verb, "-o,--output", common.output,
                  "file to write; the type follows the extension, - is standard output");
  verb.add_option("--output-format", common.output_format, "the output's type where its name does not tell")
      ->option_text("obj|ply|off|stl|xyz|glb|usda|vtk|fsb|gii");
  verb.add_flag("--ascii", common.ascii, "PLY, STL, VTK, FreeSurfer's format and GIFTI as text");
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
      ->check(number_in(0.0, 1.0))
      ->option_text("0..1");
  verb.add_option("--tension", common.tension,
                  "w of Butterfly's eight points (1/16 if not given) or of Modified Butterfly's ten (0)")
      ->check(number_in(-1.0, 1.0))
      ->option_text("W");
  add_choice(verb, "--butterfly-boundary", common.butterfly_boundary, kButterflyBoundaries,
             "how Butterfly makes points beside boundaries and creases; reflect is the paper's");
  verb.add_flag("--triangulate", common.triangulate, "split all faces into triangles first");
  verb.add_option("--features,--auto-creases", common.features,
                  "find edges that are sharper than this, also in noise, and take them as creases")
      ->check(number_in(1.0, 179.0))
      ->option_text("DEGREES");
}

void add_attributes(CLI::App& verb, CommonArguments& common, const std::string& usual) {
  add_choice(
      verb, "--attributes", common.attributes, kAttributes,
      "colours and other values at the vertices: interpolated is smooth and exact at the vertices, midpoint linear "
      "between them, scheme smoothed as points are; " +
          usual + " if not given");
  add_choice(verb, "--face-varying", common.face_varying, kFaceVarying,
             "what stays linear of texture coordinates at corners; overrules the file");
}

void add_picture_options(CLI::App& verb, PictureArguments& picture) {
  verb.add_option("--width", picture.width, "pixels")->check(whole_number(1, 16384))->capture_default_str();
  verb.add_option("--height", picture.height, "pixels; if not given, a frame of 4:3 or, for two panels, 8:3")
      ->check(whole_number(1, 16384));
  verb.add_option("--samples", picture.samples, "per pixel and axis")
      ->check(whole_number(1, 16))
      ->capture_default_str();
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
      ->check(whole_number(1, 10000))
      ->option_text("N");
}

void add_range(CLI::App& verb, PictureArguments& picture) {
  verb.add_option_function<std::string>(
          "--range",
          [&](const std::string& words) {
            const std::string wrong = read_range(words, picture);
            if (!wrong.empty()) throw CLI::ValidationError("--range", wrong);
          },
          "the numbers at the colour bar's ends; all but the 2 % at each end, if not given")
      ->option_text("A:B");
}

void add_coloring(CLI::App& verb, PictureArguments& picture) {
  add_range(verb, picture);
  add_choice(verb, "--color", picture.coloring, kColorings, "colour the surface by a measure, with a colour bar");
}

void add_picture(CLI::App& verb, PictureArguments& picture) {
  add_output_file(verb, "--picture", picture.path, "draw the result", {".png"});
  add_picture_options(verb, picture);
}

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

void set_run(CLI::App& verb, CommonArguments& common, int& status, const std::function<int()>& run) {
  if (verb.get_option_no_throw("--output") != nullptr) {
    add_choice(verb, "--up", common.up, kUpAxes,
               "the direction that points up in pictures, GLB and USD; guessed from the format and the shape if not "
               "given");
  }
  verb.callback([&verb, &common, &status, run] {
    check_files(verb, common);
    require_upright(verb, common);
    require_with(verb, {"--ascii", "--output-format"}, {"--output"});
    if (verb.get_option_no_throw("--picture") != nullptr)
      require_with(verb, kPictureOptions, {"--picture", "--gallery"});
    require_with(verb, {"--range"}, {"--color", "--color-moved", "--values", "--compare", "--from", "SCAN"});
    const CLI::Option* color = verb.get_option_no_throw("--color");
    const std::string coloring = color != nullptr && color->count() > 0 ? color->as<std::string>() : "";
    if (coloring == "zebra" || coloring == "checker") require_alone(verb, "--color " + coloring, {"--range"});
    if (coloring == "normals" && !is_given(verb, "--normals"))
      throw UsageError("--color normals shows how far normals are from those of interpolate's --normals");
    if (is_given(verb, "--turntable")) require_picture_files(verb);
    if (is_given(verb, "--output") && verb.get_option_no_throw("--output-format") != nullptr) {
      const std::string format = file_format(common.output, common.output_format);
      constexpr std::array kWithText{"ply", "stl", "vtk", "fsb", "gii"};
      if (common.ascii && std::find(kWithText.begin(), kWithText.end(), format) == kWithText.end()) {
        throw UsageError("--ascii does nothing for ." + format + ", only for .ply, .stl, .vtk, .fsb and .gii");
      }
    }
    status = run();
  });
}

}  // namespace batten::cli
