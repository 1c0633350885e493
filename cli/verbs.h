/// \file The verbs' options, a function each: what the command line says becomes their arguments, and running them.
#pragma once
#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "cli/fit_arguments.h"
#include "cli/segment_arguments.h"
#include "cli/simulate_arguments.h"

namespace batten::cli {

void add_interpolate(CLI::App& app, InterpolateArguments& arguments, int& status);
void add_subdivide(CLI::App& app, SubdivideArguments& arguments, int& status);
void add_render(CLI::App& app, RenderArguments& arguments, int& status);
void add_distance(CLI::App& app, DistanceArguments& arguments, int& status);
void add_info(CLI::App& app, InfoArguments& arguments, int& status);
void add_repair(CLI::App& app, RepairArguments& arguments, int& status);
void add_denoise(CLI::App& app, DenoiseArguments& arguments, int& status);
void add_sharpen(CLI::App& app, SharpenArguments& arguments, int& status);
void add_bands(CLI::App& app, BandsArguments& arguments, int& status);
void add_texture(CLI::App& app, TextureArguments& arguments, int& status);
void add_morph(CLI::App& app, MorphArguments& arguments, int& status);
void add_simulate(CLI::App& app, SimulateArguments& arguments, int& status);
void add_fit(CLI::App& app, FitArguments& arguments, int& status);
void add_segment(CLI::App& app, SegmentArguments& arguments, int& status);
void add_medial(CLI::App& app, MedialArguments& arguments, int& status);

}  // namespace batten::cli
