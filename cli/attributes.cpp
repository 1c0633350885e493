#include "cli/attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "batten/error.h"
#include "cli/usage_error.h"

namespace batten::cli {

namespace {

/// What the table says of an outcome besides the error; empty where the values are met.
const char* missed_text(Outcome outcome) {
  switch (outcome) {
    case Outcome::Reached:
    case Outcome::Rounding:
      return "";
    case Outcome::LeastSquares:
      return ": some components have no such values, but these are the nearest";
    case Outcome::NotReached:
      break;
  }
  return ": the tolerance was NOT reached";
}

}  // namespace

void require_values(const CommonArguments& common, const Mesh& mesh) {
  const auto has_values = [&](bool at_corners) {
    return std::any_of(mesh.attributes.begin(), mesh.attributes.end(), [&](const Attribute& attribute) {
      return attribute.name != "normal" && attribute.per_corner() == at_corners;
    });
  };
  if (common.attributes && !has_values(false)) {
    throw UsageError("--attributes does nothing for " + common.input + ", which has no values at its vertices");
  }
  if (common.face_varying && !has_values(true)) {
    throw UsageError("--face-varying does nothing for " + common.input +
                     ", which has no texture coordinates or other values at its corners");
  }
}

std::vector<InterpolationReport> prepare_values(const Topology& topology, const Scheme& scheme, Job& job) {
  AttributeOptions options;
  options.rule = job.common.attributes.value_or(AttributeRule::Scheme);
  ProgressBar bar("solving for values", job.common.quiet);
  PreparedAttributes prepared = prepare_attributes(topology, scheme, std::move(job.mesh), options, bar.callback());
  job.mesh = std::move(prepared.mesh);
  if (!prepared.reports.empty()) job.stages.finish("values");
  return std::move(prepared.reports);
}

void add_value_rows(Table& table, const std::vector<InterpolationReport>& reports) {
  for (const InterpolationReport& report : reports) {
    const Index vertex = report.worst.empty() ? -1 : report.worst.front().row;
    table.add(report.name,
              fmt::format("max error {:.3g} at vertex {}{}", report.max_error, vertex, missed_text(report.outcome)));
  }
}

nlohmann::ordered_json solved_values_json(const std::vector<InterpolationReport>& reports) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const InterpolationReport& report : reports) {
    json.push_back({{"name", report.name},
                    {"method", report.solve.method_name},
                    {"converged", report.converged()},
                    {"iterations", report.solve.iterations},
                    {"max_error", report.max_error},
                    {"rms_error", report.rms_error}});
  }
  return json;
}

void require_reached(const std::vector<InterpolationReport>& reports) {
  for (const InterpolationReport& report : reports) {
    if (report.converged()) continue;
    throw Error(ErrorCode::NotConverged,
                fmt::format("{}: the tolerance was not reached in {} iterations; what was reached is written",
                            report.name, report.solve.iterations));
  }
}

}  // namespace batten::cli
