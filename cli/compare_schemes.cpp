/// subdivide --compare: sets Butterfly, Modified Butterfly, the interpolated Loop and Catmull-Clark surfaces and the
/// fairest Loop surface of one triangle mesh side by side.
#include <fmt/format.h>

#include <cmath>

#include "batten/error.h"
#include "batten/expand/scheme_comparison.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

void draw_compared(const std::vector<ComparedSurface>& all, const Mesh& mesh, const PictureArguments& arguments,
                   Job& job) {
  std::vector<Subject> subjects;
  if (arguments.before_after) {
    Subject given;
    given.control = &mesh;
    given.flat = true;
    given.after_caption = "the mesh given";
    subjects.push_back(std::move(given));
  }
  for (const ComparedSurface& compared : all) {
    if (!compared.failure.empty()) continue;
    Subject subject;
    subject.control = &compared.mesh;
    subject.flat = true;
    subject.numbers = compared.mean;
    subject.numbers_scale = mean_curvature_scale();
    subject.after_caption = compared.name;
    subjects.push_back(std::move(subject));
  }
  draw_row(subjects, arguments, job);
}

std::string how(const ComparedSurface& compared) {
  if (compared.method.empty()) return "no solve";
  if (compared.iterations == 0) return compared.method;
  return fmt::format("{}, {}", compared.method, count_of(compared.iterations, "iteration", "iterations"));
}

void print_compared(const std::vector<ComparedSurface>& all, const CommonArguments& common) {
  if (common.quiet) return;
  std::FILE* out = text_stream(common);
  fmt::print(out, "\n{:<27}  {:>10}  {:>10}  {:>8}  {}\n", "surface", "bending", "variation", "faces", "how");
  for (const ComparedSurface& compared : all) {
    if (!compared.failure.empty()) {
      fmt::print(out, "{:<27}  {}\n", compared.name, compared.failure);
      continue;
    }
    fmt::print(out, "{:<27}  {:>10.4g}  {:>10.4g}  {:>8}  {}\n", compared.name, compared.fairness.bending,
               compared.fairness.variation, grouped(compared.mesh.face_count()), how(compared));
  }
  fmt::print(out, "bending: the integral of the squared mean curvature (a sphere of any size has 12.57)\n");
  fmt::print(out, "variation: the area times the integral of its squared gradient (a sphere has 0)\n");
}

nlohmann::ordered_json compared_json(const std::vector<ComparedSurface>& all) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ComparedSurface& compared : all) {
    nlohmann::ordered_json one{
        {"name", compared.name}, {"scheme", scheme_json(compared.scheme)}, {"failure", compared.failure}};
    if (!compared.method.empty()) {
      one["method"] = compared.method;
      one["iterations"] = compared.iterations;
      one["max_error"] = compared.max_error;
    }
    if (compared.failure.empty()) {
      one["vertices"] = compared.mesh.vertex_count();
      one["faces"] = compared.mesh.face_count();
      one["bending"] = compared.fairness.bending;
      one["variation"] = compared.fairness.variation;
      if (std::isfinite(compared.fairness.area)) one["area"] = compared.fairness.area;
      one["vertices_left_out"] = compared.fairness.left_out;
    }
    json.push_back(std::move(one));
  }
  return json;
}

}  // namespace

int run_compare_schemes(const SubdivideArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("subdivide", common);
  const Mesh& mesh = job.mesh;
  if (!all_triangles(mesh)) {
    throw Error(ErrorCode::NotTriangles,
                common.input + ": the schemes to compare have triangles in common only; split its faces first");
  }
  const Topology topology = job.connect();
  const int levels = arguments.levels < 0 ? picture_levels(topology) : arguments.levels;
  ProgressBar bar("comparing", common.quiet);
  const std::vector<ComparedSurface> all =
      compare_schemes(topology, scheme_as_asked(common, mesh), mesh.points, levels, bar.callback());
  job.stages.finish("compare");
  if (!arguments.picture.path.empty()) {
    draw_compared(all, mesh, arguments.picture, job);
    job.stages.finish("picture");
  }
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("refined", count_of(levels, "level", "levels"));
  job.print(table);
  print_compared(all, common);
  job.report({{"levels", levels},
              {"vertices", mesh.vertex_count()},
              {"faces", mesh.face_count()},
              {"compared", compared_json(all)}});
  return 0;
}

}  // namespace batten::cli
