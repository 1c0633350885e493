/// \file What is said of a wrong command line: in words, with the nearest right word.
#pragma once
#include <CLI/CLI.hpp>
#include <limits>
#include <string>
#include <vector>

#include "batten/nearest_word.h"
#include "cli/usage_error.h"

namespace batten::cli {

/// One line on what is wrong with the words that `app` could not parse.
std::string usage_text(const CLI::App& app, const CLI::ParseError& error);

/// Refuses options that have no meaning beside another one.
void require_alone(const CLI::App& verb, const std::string& name, const std::vector<std::string>& others);

/// Refuses each of the options that is given while none of `needed` is. Options that the verb lacks do not count.
void require_with(const CLI::App& verb, const std::vector<std::string>& options,
                  const std::vector<std::string>& needed);

/// True if the verb has the option and it is given.
bool is_given(const CLI::App& verb, const std::string& option);

/// Accepts whole numbers in the range and says in words what is wrong with others. No upper end is told where it is the
/// largest int.
CLI::Validator whole_number(long long low, long long high = std::numeric_limits<int>::max());

/// Accepts numbers in the range; NaN is none.
CLI::Validator number_in(double low, double high);

/// Accepts finite numbers above 0.
CLI::Validator positive_number();

}  // namespace batten::cli
