#include "cli/common.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"
#include "cli/signals.h"

namespace batten::cli {

void Stages::finish(const std::string& name) {
  const auto now = std::chrono::steady_clock::now();
  stages_.emplace_back(name, std::chrono::duration<double>(now - start_).count());
  start_ = now;
}

nlohmann::ordered_json Stages::json() const {
  nlohmann::ordered_json json;
  for (const auto& stage : stages_) json[stage.first] = stage.second;
  return json;
}

std::string Stages::text() const {
  std::string text;
  double sum = 0.0;
  for (const auto& stage : stages_) {
    text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", stage.first, stage.second);
    sum += stage.second;
  }
  return fmt::format("{:.3f} s ({})", sum, text);
}

void Table::print(const CommonArguments& arguments) const {
  if (arguments.quiet) return;
  std::FILE* out = arguments.output == "-" ? stderr : stdout;
  std::size_t width = 0;
  for (const auto& row : rows_) width = std::max(width, row.first.size());
  for (const auto& row : rows_) fmt::print(out, "{:<{}}  {}\n", row.first, width, row.second);
}

/// After the first half second ten times a second, whatever the stage: short stages of a long run show too.
static bool bar_is_due() {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point next = Clock::now() + std::chrono::milliseconds(500);
  const Clock::time_point now = Clock::now();
  if (now < next) return false;
  next = now + std::chrono::milliseconds(100);
  return true;
}

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), drawable_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

Progress ProgressBar::callback() {
  return [this](double done) {
    if (drawable_ && bar_is_due()) draw(done);
    return !stop_asked();
  };
}

void ProgressBar::draw(double done) {
  constexpr int kWidth = 30;
  const int filled = std::clamp(static_cast<int>(done * kWidth), 0, kWidth);
  fmt::print(stderr, "\r{} [{}{}] {:3.0f} %", label_, std::string(filled, '#'), std::string(kWidth - filled, '.'),
             100.0 * done);
  std::fflush(stderr);
  drawn_ = true;
}

Mesh read_input(const CommonArguments& arguments, nlohmann::ordered_json* repairs) {
  Mesh mesh = read_mesh(arguments.input, arguments.input_format, ProgressBar("reading", arguments.quiet).callback());
  if (arguments.repair) {
    RepairResult repaired = repair(mesh, {}, ProgressBar("repairing", arguments.quiet).callback());
    Table table;
    add_changes(table, "repaired", repaired.changes);
    table.print(arguments);
    if (repairs != nullptr) *repairs = repairs_json(repaired);
    mesh = std::move(repaired.mesh);
  }
  return arguments.triangulate ? triangulated(mesh) : mesh;
}

void add_changes(Table& table, const std::string& name, const std::vector<RepairChange>& changes) {
  if (changes.empty()) table.add(name, "nothing to repair");
  for (const RepairChange& change : changes) table.add(&change == &changes.front() ? name : "", change.text);
}

nlohmann::ordered_json repairs_json(const RepairResult& repaired) {
  nlohmann::ordered_json changes = nlohmann::ordered_json::array();
  for (const RepairChange& change : repaired.changes) {
    changes.push_back({{"kind", repair_word(change.kind)},
                       {"count", change.count},
                       {"elements", change.elements},
                       {"text", change.text}});
  }
  return {{"changes", changes},
          {"vertex_sources", repaired.vertex_sources},
          {"face_sources", repaired.face_sources},
          {"vertex_targets", repaired.vertex_targets},
          {"face_targets", repaired.face_targets}};
}

void write_output(const CommonArguments& arguments, const Mesh& mesh) {
  if (arguments.output.empty()) return;
  ProgressBar bar("writing", arguments.quiet);
  write_mesh(arguments.output, mesh, {arguments.output_format, !arguments.ascii}, bar.callback());
}

Scheme scheme_for(const CommonArguments& arguments, const Mesh& mesh) {
  Scheme scheme = choose_scheme(mesh);
  scheme.kind = arguments.scheme.value_or(scheme.kind);
  scheme.boundary = arguments.boundary.value_or(scheme.boundary);
  scheme.crease_method = arguments.crease_method.value_or(scheme.crease_method);
  scheme.triangle_rule = arguments.triangle_rule.value_or(scheme.triangle_rule);
  scheme.alpha = arguments.alpha;
  scheme.tension = arguments.tension;
  scheme.butterfly_boundary = arguments.butterfly_boundary.value_or(scheme.butterfly_boundary);
  return scheme;
}

std::string numbered(const std::string& path, std::size_t number) {
  const std::size_t dot = path.find_last_of('.');
  const std::size_t slash = path.find_last_of('/');
  const bool has_type = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  const std::string digits = std::to_string(number);
  const std::string part = "-" + std::string(3 - std::min<std::size_t>(3, digits.size()), '0') + digits;
  return has_type ? path.substr(0, dot) + part + path.substr(dot) : path + part;
}

std::int64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return 1024 * std::stoll(line.substr(6));
  }
  return 0;
}

void write_json(const std::string& path, const nlohmann::ordered_json& json) {
  if (path.empty()) return;
  write_atomically(path, [&](const std::string& temporary) {
    std::ofstream file(temporary);
    file << json.dump(2) << '\n';
    file.flush();
    if (!file) throw Error(ErrorCode::FileNotWritable, path + ": the report could not be written");
  });
}

std::string grouped(std::int64_t number) {
  std::string text = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > (number < 0 ? 1 : 0); place -= 3) {
    text.insert(static_cast<std::size_t>(place), ",");
  }
  return text;
}

std::string count_of(std::int64_t number, const std::string& singular, const std::string& plural) {
  return grouped(number) + " " + (number == 1 ? singular : plural);
}

Index isolated_count(const Topology& topology) {
  const Buffer<Index>& starts = topology.tables().vertex_half_edges;
  return static_cast<Index>(std::count(starts.begin(), starts.end(), -1));
}

std::string size_text(const Mesh& mesh) {
  return count_of(mesh.vertex_count(), "vertex", "vertices") + ", " + count_of(mesh.face_count(), "face", "faces");
}

std::string mesh_text(const Topology& topology) {
  std::string text =
      count_of(topology.vertex_count(), "vertex", "vertices") + ", " + count_of(topology.face_count(), "face", "faces");
  const Index isolated = isolated_count(topology);
  if (isolated > 0)
    text += fmt::format(" ({} without a face, passed through)", count_of(isolated, "vertex", "vertices"));
  return text;
}

std::string scheme_text(const Scheme& scheme) {
  std::string text = scheme_name(scheme.kind);
  switch (scheme.boundary) {
    case BoundaryRule::None:
      text += ", boundary none";
      break;
    case BoundaryRule::EdgeOnly:
      text += ", boundary edge-only";
      break;
    case BoundaryRule::EdgeAndCorner:
      text += ", boundary edge-and-corner";
      break;
  }
  if (scheme.crease_method == CreaseMethod::Chaikin) text += ", Chaikin creases";
  if (scheme.triangle_rule == TriangleRule::Smooth) text += ", smooth triangles";
  if (is_interpolating(scheme.kind)) {
    if (scheme.butterfly_boundary == ButterflyBoundary::Reflect) text += ", by reflection";
    if (scheme.tension) text += fmt::format(", tension {:g}", *scheme.tension);
  }
  if (scheme.alpha > 0.0) text += fmt::format(", alpha {:g} in the first step", scheme.alpha);
  return text;
}

nlohmann::ordered_json scheme_json(const Scheme& scheme) {
  static constexpr const char* kKinds[] = {"catmull-clark", "loop", "butterfly", "modified-butterfly"};
  static constexpr const char* kBoundaries[] = {"none", "edge-and-corner", "edge-only"};
  nlohmann::ordered_json json{{"kind", kKinds[static_cast<int>(scheme.kind)]},
                              {"boundary", kBoundaries[static_cast<int>(scheme.boundary)]},
                              {"creases", scheme.crease_method == CreaseMethod::Chaikin ? "chaikin" : "uniform"},
                              {"triangles", scheme.triangle_rule == TriangleRule::Smooth ? "smooth" : "catmark"},
                              {"alpha", scheme.alpha}};
  if (is_interpolating(scheme.kind)) {
    const bool reflect = scheme.butterfly_boundary == ButterflyBoundary::Reflect;
    json["butterfly_boundary"] = reflect ? "reflect" : "crease-rules";
    if (scheme.tension) json["tension"] = *scheme.tension;
  }
  return json;
}

}  // namespace batten::cli
