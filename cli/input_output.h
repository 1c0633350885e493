/// \file Meshes in and out, as the options that all verbs share ask for.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace batten::cli {

/// A file's mesh. What the reader skipped is printed on stderr at once, unless quiet, and added to `notes`.
Mesh read_file(const std::string& path, const std::string& format, bool quiet,
               std::vector<std::string>* notes = nullptr);
/// The input's mesh with --repair and --triangulate applied. What --repair changed is printed at once, and told to
/// `repairs` (left null without --repair) for the report; `notes` as above.
Mesh read_input(const CommonArguments& arguments, nlohmann::ordered_json* repairs = nullptr,
                std::vector<std::string>* notes = nullptr);
/// Material files, and images after which materials are named, have names relative to the folder of the mesh file.
/// Gives those that are there the names that they have from the output's folder.
void name_from_output(const CommonArguments& arguments, Mesh& mesh);
/// Throws where there are points alone, which make no surface.
void require_surface(const CommonArguments& arguments, const Mesh& mesh);
/// That of --up, or find_up_axis of the mesh, which is the input's.
UpAxis up_axis_for(const CommonArguments& arguments, const Mesh& mesh);
/// Writes to the output; does nothing without one.
void write_output(const CommonArguments& arguments, const Mesh& mesh, UpAxis up);
/// What the output's format does not keep of the mesh, which is also printed on stderr unless quiet; nothing without an
/// output.
std::vector<std::string> tell_losses(const CommonArguments& arguments, const Mesh& mesh);
/// Says on stderr what readers skipped, unless quiet.
void say_notes(const std::vector<std::string>& notes, bool quiet);
/// Says on stderr what a file lacks, unless quiet; nothing where it lacks nothing.
void say_losses(const std::string& path, const std::vector<std::string>& losses, bool quiet);
/// The mesh's own scheme, overruled by the options.
Scheme scheme_as_asked(const CommonArguments& arguments, const Mesh& mesh);
/// As scheme_as_asked. Throws UsageError where an option has no effect on the scheme's kind.
Scheme scheme_for(const CommonArguments& arguments, const Mesh& mesh);
/// name.png becomes name-007.png.
std::string numbered(const std::string& path, std::size_t number);

}  // namespace batten::cli
