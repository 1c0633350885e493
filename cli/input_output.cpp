#include "cli/input_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "batten/error.h"
#include "batten/io/file_paths.h"
#include "batten/io/io.h"
#include "batten/io/losses.h"
#include "batten/io/materials.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/table.h"
#include "cli/usage_error.h"

namespace batten::cli {

Mesh read_file(const std::string& path, const std::string& format, bool quiet, std::vector<std::string>* notes) {
  std::vector<std::string> found;
  Mesh mesh = read_mesh(path, format, ProgressBar("reading", quiet).callback(), &found);
  say_notes(found, quiet);
  if (notes != nullptr) notes->insert(notes->end(), found.begin(), found.end());
  return mesh;
}

void say_notes(const std::vector<std::string>& notes, bool quiet) {
  if (quiet) return;
  for (const std::string& note : notes) fmt::print(stderr, "batten: {}\n", note);
}

void name_from_output(const CommonArguments& arguments, Mesh& mesh) {
  if (arguments.output.empty() || arguments.input == "-") return;
  const auto rename = [&](std::string& name) {
    const std::string path = io::path_named_in(arguments.input, name);
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) name = io::name_in(arguments.output, path);
  };
  std::for_each(mesh.material_libraries.begin(), mesh.material_libraries.end(), rename);
  if (!mesh.material_libraries.empty()) return;
  for (Group& group : mesh.groups) {
    if (group.keyword == "usemtl" && io::is_image_name(group.name)) rename(group.name);
  }
}

Mesh read_input(const CommonArguments& arguments, nlohmann::ordered_json* repairs, std::vector<std::string>* notes) {
  Mesh mesh = read_file(arguments.input, arguments.input_format, arguments.quiet, notes);
  name_from_output(arguments, mesh);
  if (arguments.repair) {
    RepairResult repaired = repair(mesh, {}, ProgressBar("repairing", arguments.quiet).callback());
    Table table;
    add_changes(table, "repaired", repaired.changes);
    table.print(arguments);
    if (repairs != nullptr) *repairs = repairs_json(repaired);
    mesh = std::move(repaired.mesh);
  }
  if (arguments.triangulate) mesh = triangulated(mesh);
  return mesh;
}

void require_surface(const CommonArguments& arguments, const Mesh& mesh) {
  if (mesh.face_count() > 0) return;
  throw Error(ErrorCode::BadArgument,
              arguments.input + ": there are no faces, only points; a surface needs a mesh over its points");
}

UpAxis up_axis_for(const CommonArguments& arguments, const Mesh& mesh) {
  if (arguments.up != UpAxis::Auto) return arguments.up;
  return find_up_axis(mesh, file_format(arguments.input, arguments.input_format));
}

void write_output(const CommonArguments& arguments, const Mesh& mesh, UpAxis up) {
  if (arguments.output.empty()) return;
  ProgressBar bar("writing", arguments.quiet);
  write_mesh(arguments.output, mesh, {arguments.output_format, !arguments.ascii, up}, bar.callback());
}

std::vector<std::string> tell_losses(const CommonArguments& arguments, const Mesh& mesh) {
  if (arguments.output.empty()) return {};
  std::vector<std::string> losses = find_losses(arguments.output, mesh, {arguments.output_format, !arguments.ascii});
  say_losses(arguments.output, losses, arguments.quiet);
  return losses;
}

void say_losses(const std::string& path, const std::vector<std::string>& losses, bool quiet) {
  if (losses.empty() || quiet) return;
  fmt::print(stderr, "batten: {}: lost: {}\n", path == "-" ? "standard output" : path, fmt::join(losses, ", "));
}

Scheme scheme_as_asked(const CommonArguments& arguments, const Mesh& mesh) {
  Scheme scheme = choose_scheme(mesh);
  scheme.kind = arguments.scheme.value_or(scheme.kind);
  scheme.boundary = arguments.boundary.value_or(scheme.boundary);
  scheme.crease_method = arguments.crease_method.value_or(scheme.crease_method);
  scheme.triangle_rule = arguments.triangle_rule.value_or(scheme.triangle_rule);
  scheme.face_varying = arguments.face_varying.value_or(scheme.face_varying);
  scheme.alpha = arguments.alpha;
  scheme.tension = arguments.tension;
  scheme.butterfly_boundary = arguments.butterfly_boundary.value_or(scheme.butterfly_boundary);
  return scheme;
}

Scheme scheme_for(const CommonArguments& arguments, const Mesh& mesh) {
  const Scheme scheme = scheme_as_asked(arguments, mesh);
  const auto refuse = [&](const char* option, const char* others) {
    throw UsageError(std::string(option) + " does nothing with " + scheme_name(scheme.kind) + ", only with " + others);
  };
  const bool quads = scheme.kind == SchemeKind::CatmullClark;
  if (arguments.alpha > 0.0 && !quads) refuse("--alpha", "Catmull-Clark");
  if (arguments.triangle_rule && !quads) refuse("--triangles", "Catmull-Clark");
  if (arguments.face_varying && is_interpolating(scheme.kind)) refuse("--face-varying", "Catmull-Clark and Loop");
  if (arguments.tension && !is_interpolating(scheme.kind)) refuse("--tension", "Butterfly and Modified Butterfly");
  if (arguments.butterfly_boundary && !is_interpolating(scheme.kind))
    refuse("--butterfly-boundary", "Butterfly and Modified Butterfly");
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

}  // namespace batten::cli
