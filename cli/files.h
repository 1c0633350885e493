/// \file The files that a command line names: what may not be read or written is refused before any work is done.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace batten::cli {

/// Adds an option, or without a leading dash a positional argument, for a file that the verb reads.
CLI::Option* add_input_file(CLI::App& verb, const std::string& name, std::string& target, const std::string& help);
/// The same for an option that may stand several times, a file each.
CLI::Option* add_input_files(CLI::App& verb, const std::string& name, std::vector<std::string>& targets,
                             const std::string& help);

/// The same for a volume, which may be a folder of slices.
CLI::Option* add_input_volume(CLI::App& verb, const std::string& name, std::string& target, const std::string& help);

/// Adds an option for a file that the verb writes; - is standard output. Other extensions than these are refused; none
/// given leaves the choice to write_mesh. Devices, pipes and - may have any name.
CLI::Option* add_output_file(CLI::App& verb, const std::string& name, std::string& target, const std::string& help,
                             const std::vector<std::string>& extensions = {});

/// True for - and /dev/stdout.
bool is_standard_output(const std::string& path);

/// Refuses a folder among the files that the verb reads or writes, and an output that is an input or another output,
/// under whatever name. Sets common.text_to_stderr where an output takes standard output.
/// Throws UsageError, and Error(FileNotReadable, FileNotWritable) for folders.
void check_files(const CLI::App& verb, CommonArguments& common);

/// Refuses inputs that are among the files NAME-000, NAME-001, ... that are written for `output`.
void check_numbered_files(const CLI::App& verb, const std::string& output, int count);

/// Refuses an output that is one of the files which the verb reads without their being on the command line, such as the
/// meshes of a scene, also as NAME-000 and so on where `numbers` says so. Empty names are no files. Throws UsageError.
void require_others(const std::vector<std::string>& outputs, const std::vector<std::string>& read, bool numbers);

/// Refuses a verb that would write nothing, unless one of the options in `instead` is given.
void require_output(const CLI::App& verb, const std::vector<std::string>& instead = {});

}  // namespace batten::cli
