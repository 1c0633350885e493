/// The command line: parsed here, run in the verbs' own files.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "batten/error.h"
#include "cli/options.h"
#include "cli/signals.h"
#include "cli/verbs.h"

namespace batten::cli {
namespace {

struct Verbs {
  SharpenArguments sharpen;
  BandsArguments bands;
  DenoiseArguments denoise;
  InfoArguments info;
  InterpolateArguments interpolate;
  SubdivideArguments subdivide;
  CommonArguments convert;
  RenderArguments render;
  DistanceArguments distance;
  TextureArguments texture;
  MorphArguments morph;
  FitArguments fit;
  SegmentArguments segment;
  MedialArguments medial;
  SimulateArguments simulate;
  RepairArguments repair;
};

/// Prints what is wrong with the command line; returns the exit code.
int report_usage(const CLI::App& app, const std::string& text) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const std::string verb = parsed.empty() ? "" : " " + parsed.front()->get_name();
  std::fprintf(stderr, "batten: %s (see batten%s --help)\n", text.c_str(), verb.c_str());
  return 2;
}

/// What the user can do about an error by an option of this verb, or else by another verb.
std::string hint(const CLI::App& verb, ErrorCode code) {
  const auto has = [&](const char* option) { return verb.get_option_no_throw(option) != nullptr; };
  switch (code) {
    case ErrorCode::DegenerateFace:
    case ErrorCode::RepeatedFace:
    case ErrorCode::NonManifoldEdge:
    case ErrorCode::NonManifoldVertex:
    case ErrorCode::InconsistentFaces:
    case ErrorCode::NonOrientable:
      return has("--repair") ? " (or let --repair do it)" : " (or let batten repair do it)";
    case ErrorCode::NotTriangles:
      return has("--triangulate") ? " (--triangulate splits all faces)"
                                  : " (batten convert --triangulate splits all faces)";
    default:
      return "";
  }
}

int report_error(const CLI::App& app, const Error& error) {
  if (error.code() == ErrorCode::Cancelled) {
    std::fprintf(stderr, "batten: interrupted; unfinished files are as they were\n");
  } else {
    std::fprintf(stderr, "batten: %s%s\n", error.what(), hint(*app.get_subcommands().front(), error.code()).c_str());
  }
  return 1;
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
  add_simulate(app, verbs.simulate, status);
  add_fit(app, verbs.fit, status);
  add_segment(app, verbs.segment, status);
  add_medial(app, verbs.medial, status);
  add_repair(app, verbs.repair, status);
  add_info(app, verbs.info, status);
  CLI::App& convert = *app.add_subcommand("convert", "read one format, write another, and say what is lost");
  add_input(convert, verbs.convert);
  add_output(convert, verbs.convert);
  add_repair_flag(convert, verbs.convert);
  convert.add_flag("--triangulate", verbs.convert.triangulate, "split all faces into triangles");
  set_run(convert, verbs.convert, status, [&] {
    require_output(convert);
    return run_convert(verbs.convert);
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return report_usage(app, usage_text(app, error));
  } catch (const UsageError& error) {
    return report_usage(app, error.what());
  } catch (const Error& error) {
    return report_error(app, error);
  }
  return status;
}

}  // namespace
}  // namespace batten::cli

int main(int argc, char** argv) {
  batten::cli::handle_signals();
  try {
    const int status = batten::cli::run(argc, argv);
    // The text may still stand in the buffer; this write meets a closed pipe or a full disk.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    std::fprintf(stderr, "batten: standard output: cannot be written: %s\n", std::strerror(errno));
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "batten: out of memory; take a smaller mesh or fewer levels\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "batten: %s\n", error.what());
  }
  return 1;
}
