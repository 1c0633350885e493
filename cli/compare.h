/// \file What --compare-methods prints and reports.
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "batten/interpolate/method_comparison.h"
#include "cli/arguments.h"

namespace batten::cli {

/// A line a method; errors as shares of the diagonal.
void print_methods(const std::vector<MethodResult>& results, double diagonal, const CommonArguments& arguments);
nlohmann::ordered_json methods_json(const std::vector<MethodResult>& results);

}  // namespace batten::cli
