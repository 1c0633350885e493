/// \file What the verbs share: reading with the options applied, tables, timing, the progress bar, reports.
#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"

namespace batten::cli {

/// Seconds a stage took, in order; JSON and the table's last line.
class Stages {
 public:
  /// Ends the running stage and gives it this name.
  void finish(const std::string& name);
  nlohmann::ordered_json json() const;
  std::string text() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<std::pair<std::string, double>> stages_;
};

/// A short table for a person: left column names, right column facts.
class Table {
 public:
  void add(const std::string& name, const std::string& fact) { rows_.emplace_back(name, fact); }
  /// To stdout, or to stderr where the mesh itself goes to stdout.
  void print(const CommonArguments& arguments) const;

 private:
  std::vector<std::pair<std::string, std::string>> rows_;
};

/// Watches one stage: cancels it when a signal asked to stop (signals.h), and draws a bar on stderr where that is a
/// terminal and the tool has run for half a second. Every call that takes a progress callback gets one of these.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar();
  /// Never empty; the bar must outlive it.
  Progress callback();

 private:
  void draw(double done);
  std::string label_;
  bool drawable_;
  bool drawn_ = false;
};

/// The file's mesh with --repair and --triangulate applied. What --repair changed is printed at once, and told to
/// `repairs` (left null without --repair) for the report.
Mesh read_input(const CommonArguments& arguments, nlohmann::ordered_json* repairs = nullptr);
nlohmann::ordered_json repairs_json(const RepairResult& repaired);
/// One row a change, the first with a name.
void add_changes(Table& table, const std::string& name, const std::vector<RepairChange>& changes);
void write_output(const CommonArguments& arguments, const Mesh& mesh);
/// The mesh's own scheme, overruled by the options.
Scheme scheme_for(const CommonArguments& arguments, const Mesh& mesh);
/// name.png becomes name-007.png.
std::string numbered(const std::string& path, std::size_t number);
/// The most memory this process has held, in bytes; 0 where the system does not tell.
std::int64_t peak_memory_bytes();
void write_json(const std::string& path, const nlohmann::ordered_json& json);

/// "12,345"
std::string grouped(std::int64_t number);
std::string count_of(std::int64_t number, const std::string& singular, const std::string& plural);
/// "8 vertices, 6 faces"
std::string size_text(const Mesh& mesh);
std::string mesh_text(const Topology& topology);
std::string scheme_text(const Scheme& scheme);
nlohmann::ordered_json scheme_json(const Scheme& scheme);
Index isolated_count(const Topology& topology);

/// Residual against iteration, with the tolerance, both in the mesh's unit. Throws Error(NotAvailable) as draw does.
void plot_residuals(const std::string& path, const std::string& title, const SolveReport& report, double tolerance);

/// What one way of solving did on the user's mesh.
struct MethodResult {
  std::string name;
  std::string failure;  ///< why there is no result, or empty
  SolveReport report;
  double build_seconds = 0.0;
  double solve_seconds = 0.0;
  double max_error = 0.0;  ///< in the mesh's unit
};
/// Solves by each method in turn. Throws Error(Cancelled) only; other errors are results.
std::vector<MethodResult> compare_methods(const Topology& topology, const Scheme& scheme,
                                          const InterpolateOptions& options, ConstValuesRef targets, bool quiet);
void print_methods(const std::vector<MethodResult>& results, double diagonal, const CommonArguments& arguments);
nlohmann::ordered_json methods_json(const std::vector<MethodResult>& results);
void plot_methods(const std::string& path, const std::vector<MethodResult>& results, double tolerance);

}  // namespace batten::cli
