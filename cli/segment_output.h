/// \file What segment reads and writes, whether of one surface or of several.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "batten/volume/segment_volume.h"
#include "cli/job.h"
#include "cli/segment_arguments.h"

namespace batten::cli {

/// Throws Error(NotAvailable) in builds without volumes.
Volume read_input_volume(const std::string& path);

/// Whole numbers to 255 as bytes.
void write_output_volume(const std::string& path, const Volume& volume, bool bytes);

/// Twelve slices, four in each direction. Draws nothing where none were asked for.
void draw_overlay(const SegmentArguments& arguments, const Mesh& fine, const Volume& image);

/// What files say of their world.
std::string space_comment(WorldSpace space);

/// Writes the control mesh, or its surface, to the path in the space that was asked for; what the table says of that,
/// empty for the control mesh and where the path is.
std::string write_in_space(const SegmentArguments& arguments, const std::string& path, const Segmentation& result,
                           Job& job);

/// "181 x 217 x 181 voxels of 1 x 1 x 1 mm".
std::string grid_text(const VolumeGrid& grid);

/// What a report says of a surface.
void add_surface(nlohmann::ordered_json& json, const SegmentResult& found);

}  // namespace batten::cli
