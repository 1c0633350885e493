/// Butterfly, Modified Butterfly and the interpolated Loop and Catmull-Clark surfaces of one triangle mesh.
#include <fmt/format.h>

#include <array>

#include "batten/error.h"
#include "batten/interpolate/interpolator.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/discrete_curvature.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

struct ComparedScheme {
  const char* name;
  SchemeKind kind;
};
constexpr std::array<ComparedScheme, 4> kComparedSchemes{{{"Butterfly", SchemeKind::Butterfly},
                                                          {"Modified Butterfly", SchemeKind::ModifiedButterfly},
                                                          {"interpolated Loop", SchemeKind::Loop},
                                                          {"interpolated Catmull-Clark", SchemeKind::CatmullClark}}};

/// One surface through the vertices, as fine mesh on it.
struct Compared {
  std::string name;
  Scheme scheme;
  std::string failure;  ///< why there is no surface, or empty
  std::string method;   ///< how it was interpolated; empty where there was nothing to solve
  int iterations = 0;
  double max_error = 0.0;  ///< in the mesh's unit
  Mesh mesh;
  Scalars mean;
  Fairness fairness;
};

/// The surface through the points.
Interpolant through_points(const Topology& topology, const Mesh& mesh, Compared& compared, bool quiet) {
  const Interpolator interpolator(topology, compared.scheme, {}, ProgressBar("building", quiet).callback());
  ProgressBar bar("interpolating", quiet);
  Interpolant interpolant = interpolator.solve(mesh.points, bar.callback());
  compared.method = interpolant.report.solve.method_name;
  compared.iterations = interpolant.report.solve.iterations;
  compared.max_error = interpolant.report.max_error;
  if (!interpolant.report.converged()) {
    throw Error(ErrorCode::NotConverged,
                fmt::format("not solved: it still misses vertices by {:.2g} after {}", compared.max_error,
                            count_of(compared.iterations, "iteration", "iterations")));
  }
  return interpolant;
}

void build(const Topology& topology, const Mesh& mesh, int levels, Compared& compared, bool quiet) {
  RefinedSurface surface{with_surface_holes(topology, compared.scheme), mesh.points};
  Scheme scheme = compared.scheme;
  int steps = levels;
  if (!is_interpolating(scheme.kind)) {
    surface.values = Values();
    Interpolant control = through_points(topology, mesh, compared, quiet);
    if (control.topology.vertex_count() > topology.vertex_count()) {
      surface.topology = control.topology;
      steps = std::max(0, levels - 1);
    }
    surface.values = std::move(control.control);
    scheme = control.scheme;
  }
  ProgressBar bar("refining", quiet);
  surface = refine(surface.topology, scheme, surface.values, steps, bar.callback());
  if (steps > 0) scheme = scheme.after_first_step();
  const Values points = LimitMatrix(surface.topology, scheme, {}, bar.callback()).apply(surface.values, bar.callback());
  const DiscreteCurvature curvature = discrete_curvature(surface.topology, points, bar.callback());
  compared.fairness = fairness(surface.topology, points, curvature, bar.callback());
  compared.mean = curvature.mean;
  compared.mesh = mesh_from_topology(surface.topology);
  compared.mesh.points = points;
}

Compared compare(const ComparedScheme& contestant, const SubdivideArguments& arguments, const Topology& topology,
                 const Mesh& mesh, int levels) {
  Compared compared;
  compared.name = contestant.name;
  compared.scheme = scheme_for(arguments.common, mesh);
  compared.scheme.kind = contestant.kind;
  try {
    build(topology, mesh, levels, compared, arguments.common.quiet);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    compared.failure = error.what();
  }
  return compared;
}

void draw_compared(const std::vector<Compared>& all, const Mesh& mesh, const PictureArguments& arguments, bool quiet) {
  std::vector<Subject> subjects;
  if (arguments.before_after) {
    Subject given;
    given.control = mesh;
    given.flat = true;
    given.after_caption = "the mesh given";
    subjects.push_back(std::move(given));
  }
  for (const Compared& compared : all) {
    if (!compared.failure.empty()) continue;
    Subject subject;
    subject.control = compared.mesh;
    subject.flat = true;
    subject.numbers = compared.mean;
    subject.numbers_scale = mean_curvature_scale();
    subject.after_caption = compared.name;
    subjects.push_back(std::move(subject));
  }
  draw_row(subjects, arguments, quiet);
}

std::string how(const Compared& compared) {
  if (compared.method.empty()) return "no solve";
  return fmt::format("{}, {}", compared.method, count_of(compared.iterations, "iteration", "iterations"));
}

void print_compared(const std::vector<Compared>& all, const CommonArguments& common) {
  if (common.quiet) return;
  fmt::print("\n{:<27}  {:>10}  {:>10}  {:>8}  {}\n", "surface", "bending", "variation", "faces", "how");
  for (const Compared& compared : all) {
    if (!compared.failure.empty()) {
      fmt::print("{:<27}  {}\n", compared.name, compared.failure);
      continue;
    }
    fmt::print("{:<27}  {:>10.4g}  {:>10.4g}  {:>8}  {}\n", compared.name, compared.fairness.bending,
               compared.fairness.variation, grouped(compared.mesh.face_count()), how(compared));
  }
  fmt::print("bending: the integral of the squared mean curvature (a sphere of any size has 12.57)\n");
  fmt::print("variation: the area times the integral of its squared gradient (a sphere has 0)\n");
}

nlohmann::ordered_json compared_json(const std::vector<Compared>& all) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Compared& compared : all) {
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
      one["area"] = compared.fairness.area;
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
                common.input +
                    ": the schemes to compare have triangles in common only; split its faces by "
                    "--triangulate");
  }
  const Topology topology = job.connect();
  const int levels = arguments.levels < 0 ? picture_levels(topology) : arguments.levels;
  std::vector<Compared> all;
  for (const ComparedScheme& contestant : kComparedSchemes) {
    all.push_back(compare(contestant, arguments, topology, mesh, levels));
    job.stages.finish(contestant.name);
  }
  if (!arguments.picture.path.empty()) {
    draw_compared(all, mesh, arguments.picture, common.quiet);
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
