#include "cli/options.h"

#include <array>
#include <filesystem>
#include <sstream>

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
const Names<Coloring> kColorings{{"error", Coloring::Error},     {"moved", Coloring::Moved},
                                 {"mean", Coloring::Mean},       {"gaussian", Coloring::Gaussian},
                                 {"valence", Coloring::Valence}, {"sharpness", Coloring::Sharpness},
                                 {"zebra", Coloring::Zebra}};
const Names<View> kViews{{"front", View::Front}, {"back", View::Back}, {"left", View::Left},    {"right", View::Right},
                         {"top", View::Top},     {"iso", View::Iso},   {"bottom", View::Bottom}};

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

}  // namespace

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

void add_input(CLI::App& verb, CommonArguments& common, const std::string& name) {
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

void add_picture(CLI::App& verb, PictureArguments& picture) {
  verb.add_option("--picture", picture.path, "draw the result")
      ->check(has_extension({".png"}))
      ->option_text("FILE.png");
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

void require_alone(const CLI::App& verb, const std::string& name, const std::vector<std::string>& others) {
  for (const std::string& other : others) {
    if (verb.count(other) > 0) throw CLI::ValidationError(name, "leaves nothing for " + other + " to do");
  }
}

}  // namespace batten::cli
