/// \file Options that several verbs have, and how the command line's words become values.
#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace batten::cli {

/// The words that stand for an enumeration's values.
template <typename Enum>
using Names = std::map<std::string, Enum>;

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
CLI::Validator has_extension(const std::vector<std::string>& extensions);
void add_repair_flag(CLI::App& verb, CommonArguments& common);
/// Adds the positional argument for the input file, under the name that the help shows.
void add_input(CLI::App& verb, CommonArguments& common, const std::string& name = "INPUT");
void add_output(CLI::App& verb, CommonArguments& common);
void add_surface(CLI::App& verb, CommonArguments& common);
void add_picture_options(CLI::App& verb, PictureArguments& picture);
void add_coloring(CLI::App& verb, PictureArguments& picture);
/// Adds --picture and what belongs to it, for verbs whose own output is a mesh.
void add_picture(CLI::App& verb, PictureArguments& picture);
/// Adds an option that takes a number, or a number with a per cent sign: a share of the diagonal.
void add_length(CLI::App& verb, const std::string& name, std::optional<Length>& target, const std::string& help);
/// Refuses options that have no meaning beside another one.
void require_alone(const CLI::App& verb, const std::string& name, const std::vector<std::string>& others);

}  // namespace batten::cli
