#include "cli/interpolation_rows.h"

#include <fmt/format.h>

#include <utility>

#include "batten/error.h"

namespace batten::cli {

namespace {

const char* outcome_word(Outcome outcome) {
  switch (outcome) {
    case Outcome::Reached:
      return "tolerance";
    case Outcome::Rounding:
      return "rounding";
    case Outcome::LeastSquares:
      return "least squares";
    case Outcome::NotReached:
      break;
  }
  return "not reached";
}

nlohmann::ordered_json singular_json(const InterpolationReport& report) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const SingularReport& one : report.singular) {
    constexpr const char* kReasons[] = {"two-colourable", "valence 2", "unsolvable"};
    constexpr const char* kTreatments[] = {"none needed", "least squares", "alpha"};
    json.push_back({{"vertex", one.vertex},
                    {"vertices", one.vertex_count},
                    {"reason", kReasons[static_cast<int>(one.reason)]},
                    {"treatment", kTreatments[static_cast<int>(one.treatment)]},
                    {"alpha", one.alpha}});
  }
  return json;
}

}  // namespace

std::string share_text(double length, double diagonal) {
  return fmt::format("{:.3g} of the diagonal", diagonal > 0.0 ? length / diagonal : 0.0);
}

const char* outcome_text(Outcome outcome) {
  switch (outcome) {
    case Outcome::Reached:
      return "";
    case Outcome::Rounding:
      return "as near as doubles come at these coordinates";
    case Outcome::LeastSquares:
      return "the nearest miss on singular components, the tolerance elsewhere";
    case Outcome::NotReached:
      break;
  }
  return "the tolerance was NOT reached";
}

std::string error_text(const InterpolationReport& report) {
  return fmt::format("{:.3g} at vertex {} ({})", report.max_error, report.worst.empty() ? -1 : report.worst.front().row,
                     share_text(report.max_error, report.diagonal));
}

void add_value_rows(const std::vector<InterpolationReport>& reports, Table& table) {
  for (const InterpolationReport& report : reports) {
    const std::string outcome = outcome_text(report.outcome);
    table.add(report.name, "max error " + error_text(report) + (outcome.empty() ? "" : ": " + outcome));
  }
}

nlohmann::ordered_json values_json(const InterpolationReport& report) {
  nlohmann::ordered_json worst = nlohmann::ordered_json::array();
  for (const RowError& entry : report.worst) worst.push_back({{"vertex", entry.row}, {"error", entry.error}});
  return {{"method", report.solve.method_name},
          {"converged", report.converged()},
          {"outcome", outcome_word(report.outcome)},
          {"iterations", report.solve.iterations},
          {"residual_history", report.solve.residual_history},
          {"measured_after", report.solve.measured_after},
          {"max_error", report.max_error},
          {"rms_error", report.rms_error},
          {"worst_vertices", worst},
          {"max_movement", report.max_movement},
          {"singular", singular_json(report)}};
}

nlohmann::ordered_json named_values_json(const std::vector<InterpolationReport>& reports) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const InterpolationReport& report : reports) {
    nlohmann::ordered_json one{{"name", report.name}, {"diagonal", report.diagonal}};
    one.update(values_json(report));
    json.push_back(std::move(one));
  }
  return json;
}

void require_reached(const std::vector<InterpolationReport>& reports, double tolerance, const std::string& advice) {
  for (const InterpolationReport& report : reports) {
    if (report.converged()) continue;
    throw Error(ErrorCode::NotConverged,
                fmt::format("{}the tolerance {:g} was not reached in {} iterations; what was reached is written{}",
                            report.name == "points" ? "" : report.name + ": ", tolerance, report.solve.iterations,
                            advice.empty() ? "" : " (" + advice + ")"));
  }
}

}  // namespace batten::cli
