/// \file The short table that a verb prints.
#pragma once
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "batten/mesh/repair.h"
#include "cli/arguments.h"

namespace batten::cli {

/// Where text for a person goes: stdout, or stderr where an output takes stdout.
std::FILE* text_stream(const CommonArguments& arguments);

/// A short table for a person: left column names, right column facts.
class Table {
 public:
  void add(const std::string& name, const std::string& fact) { rows_.emplace_back(name, fact); }
  /// Prints to text_stream, unless --quiet.
  void print(const CommonArguments& arguments) const;

 private:
  std::vector<std::pair<std::string, std::string>> rows_;
};

/// Adds a row for each change; the first has the name.
void add_changes(Table& table, const std::string& name, const std::vector<RepairChange>& changes);

}  // namespace batten::cli
