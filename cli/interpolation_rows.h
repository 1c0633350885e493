/// \file What verbs tell of values that were interpolated.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batten/interpolate/interpolation_report.h"
#include "cli/table.h"

namespace batten::cli {

/// "0.0222 of the diagonal"
std::string share_text(double length, double diagonal);
/// What the table says of an outcome besides the errors; empty where the surface passes through each value.
const char* outcome_text(Outcome outcome);
/// "3.79e-10 at vertex 107 (4.09e-11 of the diagonal)"
std::string error_text(const InterpolationReport& report);

/// A row for each set of values, under its name.
void add_value_rows(const std::vector<InterpolationReport>& reports, Table& table);
/// How the values were solved for, and what was reached.
nlohmann::ordered_json values_json(const InterpolationReport& report);
/// The same for each set, after its name and size.
nlohmann::ordered_json named_values_json(const std::vector<InterpolationReport>& reports);

/// Throws where values were missed. The output is written by then; the error gives the exit code. advice: what else to
/// try, or nothing.
void require_reached(const std::vector<InterpolationReport>& reports, double tolerance, const std::string& advice = {});

}  // namespace batten::cli
