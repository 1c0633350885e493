#include "cli/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace batten::cli {

std::FILE* text_stream(const CommonArguments& arguments) { return arguments.text_to_stderr ? stderr : stdout; }

void Table::print(const CommonArguments& arguments) const {
  if (arguments.quiet) return;
  std::FILE* out = text_stream(arguments);
  std::size_t width = 0;
  for (const auto& row : rows_) width = std::max(width, row.first.size());
  for (const auto& row : rows_) fmt::print(out, "{:<{}}  {}\n", row.first, width, row.second);
}

void add_changes(Table& table, const std::string& name, const std::vector<RepairChange>& changes) {
  if (changes.empty()) table.add(name, "nothing to repair");
  for (const RepairChange& change : changes) table.add(&change == &changes.front() ? name : "", change.text);
}

}  // namespace batten::cli
