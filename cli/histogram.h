/// \file A histogram as lines of text and in the report.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batten/nearest/distance_summary.h"

namespace batten::cli {

/// One line a bar.
std::vector<std::string> histogram_lines(const Histogram& histogram);
nlohmann::ordered_json histogram_json(const Histogram& histogram);

}  // namespace batten::cli
