/// \file Options that several verbs have, and how the command line's words become values.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/files.h"
#include "cli/usage.h"

namespace batten::cli {

/// The words that stand for an enumeration's values.
template <typename Enum>
using Names = std::map<std::string, Enum>;

/// Accepts the words and suggests the nearest one for others.
CLI::Validator one_of(const std::vector<std::string>& words);

/// An option whose words stand for an enumerator; the help lists the words.
template <typename Enum, typename Target>
void add_choice(CLI::App& verb, const std::string& name, Target& target, const Names<Enum>& names,
                const std::string& help) {
  std::vector<std::string> words;
  std::string text;
  for (const auto& entry : names) {
    words.push_back(entry.first);
    text += (text.empty() ? "" : "|") + entry.first;
  }
  verb.add_option_function<std::string>(
          name, [&target, names](const std::string& word) { target = names.at(word); }, help)
      ->check(one_of(words))
      ->option_text(text);
}

void add_repair_flag(CLI::App& verb, CommonArguments& common);
/// Adds the positional argument for the input file, under the name that the help shows, and what all inputs have;
/// `what` says what the file is.
void add_input(CLI::App& verb, CommonArguments& common, const std::string& name = "INPUT",
               const std::string& what = "mesh file");
/// Adds what every verb has besides its input: --threads, --quiet, --report.
void add_common(CLI::App& verb, CommonArguments& common);
void add_output(CLI::App& verb, CommonArguments& common);
void add_surface(CLI::App& verb, CommonArguments& common);
/// Adds what becomes of values at vertices and at corners, for verbs that refine them. `usual`: the word for the values
/// at vertices where none is given.
void add_attributes(CLI::App& verb, CommonArguments& common, const std::string& usual);
void add_picture_options(CLI::App& verb, PictureArguments& picture);
/// The colour bar's range.
void add_range(CLI::App& verb, PictureArguments& picture);
/// What colours show, and the range of their bar.
void add_coloring(CLI::App& verb, PictureArguments& picture);
/// Adds --picture and what belongs to it, for verbs whose own output is a mesh.
void add_picture(CLI::App& verb, PictureArguments& picture);
/// Adds an option that takes a number, or a number with a per cent sign: a share of the diagonal.
void add_length(CLI::App& verb, const std::string& name, std::optional<Length>& target, const std::string& help);
/// Adds how near normals have to come.
template <typename Target>
void add_normal_tolerance(CLI::App& verb, Target& target) {
  verb.add_option("--normal-tolerance", target, "leave normals alone that are so near, and turn others only so far; 0")
      ->check(number_in(0.0, 180.0))
      ->option_text("DEGREES");
}
/// Lets the verb run `run` once its command line is known to make sense: check_files, and no option that does nothing
/// for want of another one.
void set_run(CLI::App& verb, CommonArguments& common, int& status, const std::function<int()>& run);

}  // namespace batten::cli
