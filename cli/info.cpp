#include <fmt/format.h>

#include <optional>

#include "batten/error.h"
#include "batten/mesh/check.h"
#include "batten/mesh/places.h"
#include "batten/mesh/seams.h"
#include "batten/mesh/self_intersections.h"
#include "batten/mesh/summary.h"
#include "batten/mesh/vertex_fields.h"
#include "batten/parallel/parallel.h"
#include "cli/contents.h"
#include "cli/curvature.h"
#include "cli/input_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/table.h"
#include "cli/text.h"

namespace batten::cli {
namespace {

using Json = nlohmann::ordered_json;

/// "3: 12, 4: 500, 5: 8", the rare ones gathered.
std::string histogram_text(const std::map<Index, Index>& histogram) {
  std::string text;
  std::size_t shown = 0;
  Index rest = 0;
  for (const auto& entry : histogram) {
    if (shown++ < 8) {
      text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", entry.first, grouped(entry.second));
    } else {
      rest += entry.second;
    }
  }
  return rest > 0 ? text + ", more: " + grouped(rest) : text;
}

Json histogram_json(const std::map<Index, Index>& histogram) {
  Json json = Json::object();
  for (const auto& entry : histogram) json[std::to_string(entry.first)] = entry.second;
  return json;
}

std::map<Index, Index> face_sizes(const Mesh& mesh) {
  std::map<Index, Index> sizes;
  for (Index begin = 0; begin < mesh.face_count();) {
    const Index size = mesh.face_size(begin);
    Index end = begin + 1;
    while (end < mesh.face_count() && mesh.face_size(end) == size) ++end;
    sizes[size] += end - begin;
    begin = end;
  }
  return sizes;
}

/// "3: 2 closed of genus 0; 1 of genus 1 with 2 boundary loops"
std::string components_text(const std::vector<ComponentSummary>& components) {
  std::map<std::pair<Index, Index>, Index> kinds;
  for (const ComponentSummary& component : components) ++kinds[{component.boundary_loops, component.genus()}];
  std::string text = kinds.size() > 1 ? grouped(static_cast<Index>(components.size())) + ": " : "";
  std::size_t shown = 0;
  for (const auto& kind : kinds) {
    if (shown++ > 0) text += "; ";
    if (shown > 4) return text + "others";
    const Index loops = kind.first.first;
    text += fmt::format("{} {}of genus {}{}", grouped(kind.second), loops == 0 ? "closed " : "", kind.first.second,
                        loops == 0 ? "" : " with " + count_of(loops, "boundary loop", "boundary loops"));
  }
  return text;
}

Json components_json(const std::vector<ComponentSummary>& components) {
  Json json = Json::array();
  for (const ComponentSummary& component : components) {
    json.push_back({{"first_vertex", component.first_vertex},
                    {"vertices", component.vertices},
                    {"edges", component.edges},
                    {"faces", component.faces},
                    {"genus", component.genus()},
                    {"boundary_edges", component.boundary_edges},
                    {"boundary_loops", component.boundary_loops}});
  }
  return json;
}

void describe_creases(const MeshSummary& summary, Table& table, Json& json) {
  json["sharp_edges"] = summary.sharp_edges;
  json["semi_sharp_edges"] = summary.semi_sharp_edges;
  json["sharpness"] = {summary.least_sharpness, summary.most_sharpness};
  json["darts"] = summary.darts;
  if (summary.sharp_edges == 0) return;
  table.add("creases", fmt::format("{} inside, {} of them semi-sharp; sharpness {:g} to {:g}{}",
                                   count_of(summary.sharp_edges, "edge", "edges"), grouped(summary.semi_sharp_edges),
                                   summary.least_sharpness, summary.most_sharpness,
                                   summary.darts > 0 ? "; " + count_of(summary.darts, "dart", "darts") : ""));
}

void describe_topology(const Topology& topology, const Components& components, Table& table, Json& json) {
  const MeshSummary summary = summarize(topology, components);
  const Index isolated = summary.isolated_vertices;
  if (isolated > 0) table.add("isolated", count_of(isolated, "vertex has", "vertices have") + " no face");
  table.add("edges", grouped(topology.edge_count()));
  if (!summary.components.empty()) table.add("components", components_text(summary.components));
  if (summary.boundary_loops > 0) {
    table.add("boundaries", fmt::format("{}, {}", count_of(summary.boundary_loops, "loop", "loops"),
                                        count_of(summary.boundary_edges, "edge", "edges")));
  }
  if (!summary.valences.empty()) table.add("valences", histogram_text(summary.valences));
  if (!summary.boundary_valences.empty()) table.add("at the boundary", histogram_text(summary.boundary_valences));
  json["edges"] = topology.edge_count();
  json["isolated_vertices"] = isolated;
  json["boundary_edges"] = summary.boundary_edges;
  json["boundary_loops"] = summary.boundary_loops;
  json["euler_characteristic"] = topology.vertex_count() - isolated - topology.edge_count() + topology.face_count();
  json["components"] = components_json(summary.components);
  json["valences"] = histogram_json(summary.valences);
  json["boundary_valences"] = histogram_json(summary.boundary_valences);
  describe_creases(summary, table, json);
}

void describe_seams(Index count, bool repaired, Table& table, Json& json) {
  if (count > 0) table.add("seams", seams_text(count, repaired));
  json["coincident_boundary_vertices"] = count;
}

/// "by Chebyshev in tiles in 30 iterations"
std::string solve_text(const SolveReport& solve) {
  if (solve.method == SolveMethod::Auto) return "without solving anything";
  std::string text = "by " + solve.method_name;
  if (solve.iterations > 0) text += " in " + count_of(solve.iterations, "iteration", "iterations");
  return text;
}

/// Takes the mesh as the control points of a surface and finds them again from the limit positions.
void describe_interpolation(const Mesh& mesh, const Topology& topology, const Scheme& scheme, bool quiet, Table& table,
                            Json& json) {
  const Interpolator interpolator(topology, scheme, {}, ProgressBar("building", quiet).callback());
  const Values targets = interpolator.limit_matrix().apply(mesh.points);
  const Interpolant found = interpolator.solve(targets, ProgressBar("self-check", quiet).callback());
  const double diagonal = bounding_diagonal(targets);
  const double error = diagonal > 0.0 ? found.report.max_error / diagonal : found.report.max_error;
  table.add("interpolation",
            found.report.singular.empty()
                ? std::string("no component is singular")
                : count_of(static_cast<std::int64_t>(found.report.singular.size()), "component is", "components are") +
                      " singular: a surface passes through some sets of points only");
  table.add("self-check", fmt::format("a known surface was found again {}, to {:.2g} of the diagonal{}",
                                      solve_text(found.report.solve), error,
                                      found.report.converged() ? "" : ": NOT as exact as asked"));
  json["interpolation"] = {{"singular_components", found.report.singular.size()},
                           {"method", found.report.solve.method_name},
                           {"iterations", found.report.solve.iterations},
                           {"converged", found.report.converged()},
                           {"max_error", found.report.max_error},
                           {"relative_error", error}};
}

struct KindName {
  const char* word;
  const char* one;
  const char* many;
};

KindName name_of(ErrorCode kind) {
  switch (kind) {
    case ErrorCode::NotFinite:
      return {"not-finite", "value that is not a finite number", "values that are not finite numbers"};
    case ErrorCode::IndexOutOfRange:
      return {"index-out-of-range", "index out of range", "indices out of range"};
    case ErrorCode::DegenerateFace:
      return {"degenerate-face", "degenerate face", "degenerate faces"};
    case ErrorCode::RepeatedFace:
      return {"repeated-face", "repeated face", "repeated faces"};
    case ErrorCode::NonManifoldEdge:
      return {"non-manifold-edge", "edge of more than two faces", "edges of more than two faces"};
    case ErrorCode::NonManifoldVertex:
      return {"non-manifold-vertex", "vertex of several fans of faces", "vertices of several fans of faces"};
    case ErrorCode::InconsistentFaces:
      return {"inconsistent-face", "face against its neighbours' direction",
              "faces against their neighbours' direction"};
    case ErrorCode::NonOrientable:
      return {"non-orientable", "component without an orientation", "components without an orientation"};
    case ErrorCode::BadArgument:
      return {"tag", "tag on what is not there", "tags on what is not there"};
    default:
      return {"arrays", "fault of the arrays", "faults of the arrays"};
  }
}

/// The count of each kind, and the first few; the advice once.
void describe_problems(const std::vector<MeshProblem>& problems, Table& table, Json& json) {
  constexpr std::size_t kShown = 3;
  for (const MeshProblem& problem : problems) {
    const KindName name = name_of(problem.kind);
    table.add("problem", count_of(static_cast<std::int64_t>(problem.count), name.one, name.many));
    for (std::size_t i = 0; i < std::min(kShown, problem.messages.size()); ++i) {
      const std::string& message = problem.messages[i];
      table.add("", "  " + (i == 0 ? message : message.substr(0, message.find(';'))));
    }
    if (problem.count > kShown) table.add("", fmt::format("  and {} more", grouped(problem.count - kShown)));
    json["problems"].push_back({{"kind", name.word}, {"count", problem.count}, {"first", problem.messages}});
  }
}

/// True where no step of a repair has anything to do: no fault, no open edges to weld, no vertex without a face.
bool is_whole(const std::optional<Topology>& topology, Index seam_vertices) {
  return topology && seam_vertices == 0 && isolated_count(*topology) == 0;
}

/// What --repair would do, where there is something.
void describe_repair(const Mesh& mesh, const std::optional<Topology>& topology, Index seam_vertices, bool quiet,
                     Table& table, Json& json) {
  json["repair_would"] = Json::array();
  if (is_whole(topology, seam_vertices)) return;
  const RepairResult repaired = repair(mesh, {}, ProgressBar("looking for repairs", quiet).callback());
  if (!repaired.changes.empty()) add_changes(table, "--repair would have", repaired.changes);
  json["repair_would"] = repairs_json(repaired)["changes"];
}

void describe_mesh(const Mesh& mesh, Table& table, Json& json) {
  const Index coincident = coincident_count(mesh.points);
  const std::map<Index, Index> sizes = face_sizes(mesh);
  const double diagonal = bounding_diagonal(mesh.points);
  table.add("vertices", grouped(mesh.vertex_count()));
  table.add("faces", fmt::format("{} ({})", grouped(mesh.face_count()), histogram_text(sizes)));
  table.add("diagonal", fmt::format("{:g}", diagonal));
  if (coincident > 0) {
    table.add("coincident", count_of(coincident, "vertex lies", "vertices lie") + " where an earlier one lies");
  }
  if (!mesh.corners.empty()) table.add("corners", grouped(static_cast<std::int64_t>(mesh.corners.size())));
  if (!mesh.holes.empty()) table.add("holes", grouped(static_cast<std::int64_t>(mesh.holes.size())));
  json["vertices"] = mesh.vertex_count();
  json["faces"] = mesh.face_count();
  json["diagonal"] = diagonal;
  json["coincident_vertices"] = coincident;
  json["face_sizes"] = histogram_json(sizes);
  json["creases"] = mesh.creases.size();
  json["corners"] = mesh.corners.size();
  json["holes"] = mesh.holes.size();
}

/// None where the mesh has problems. Topology accepts exactly the meshes in which check() finds none, in less time.
std::optional<Topology> topology_of(const Mesh& mesh, bool quiet) {
  try {
    return Topology(mesh, ProgressBar("connecting", quiet).callback());
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    return std::nullopt;
  }
}

/// Looks for faces that pass through each other, in a large mesh only where that is asked for.
void describe_intersections(const Mesh& mesh, const Topology& topology, const InfoArguments& arguments, Table& table,
                            Json& json) {
  constexpr std::int64_t kManyTriangles = 300000;
  const std::int64_t triangles = std::int64_t{topology.half_edge_count()} - 2 * std::int64_t{topology.face_count()};
  json["self_intersections"] = nullptr;
  if (triangles > kManyTriangles && !arguments.self_intersections) {
    table.add("intersections", "not looked for in so large a mesh; --self-intersections does");
    return;
  }
  const SelfIntersections found =
      find_self_intersections(topology, mesh.points, ProgressBar("intersecting", arguments.common.quiet).callback());
  json["self_intersections"] = {{"triangle_pairs", found.count}, {"first_faces", found.faces}};
  if (found.count == 0) return;
  table.add("intersections", fmt::format("{} through each other, the first in faces {} and {}",
                                         count_of(found.count, "pair of triangles passes", "pairs of triangles pass"),
                                         found.faces[0][0], found.faces[0][1]));
}

void describe_surface(const Mesh& mesh, const Topology& topology, Index seam_vertices, const InfoArguments& arguments,
                      Table& table, Json& json) {
  const Scheme scheme = choose_scheme(mesh);
  const Components components = connected_components(topology);
  describe_topology(topology, components, table, json);
  describe_seams(seam_vertices, arguments.common.repair, table, json);
  describe_sizes(topology, components, mesh.points, table, json);
  describe_intersections(mesh, topology, arguments, table, json);
  table.add("surface", scheme_text(scheme));
  json["scheme"] = scheme_json(scheme);
  if (mesh.face_count() == 0) return;
  describe_interpolation(mesh, topology, scheme, arguments.common.quiet, table, json);
  if (arguments.curvature) {
    const VertexCurvature curvature = measure_curvature(topology, scheme, mesh);
    describe_curvature(curvature, table, json);
    write_curvature(arguments.common, curvature, mesh, table, json);
  }
}

}  // namespace

int run_info(const InfoArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const ThreadLimit limit(common.threads);
  Json repairs;
  std::vector<std::string> notes;
  const Mesh mesh = read_input(common, &repairs, &notes);
  Table table;
  Json json{{"verb", "info"}, {"input", common.input}, {"repairs", repairs}, {"notes", notes}};
  describe_mesh(mesh, table, json);
  describe_box(mesh, table, json);
  describe_values(mesh, table, json);
  const std::optional<Topology> topology = topology_of(mesh, common.quiet);
  const Index seam_vertices = topology ? coincident_boundary_count(*topology, mesh.points) : 0;
  json["problems"] = Json::array();
  if (topology) {
    describe_surface(mesh, *topology, seam_vertices, arguments, table, json);
  } else {
    const std::vector<MeshProblem> problems = check(mesh, 10, ProgressBar("checking", common.quiet).callback());
    describe_problems(problems, table, json);
  }
  if (arguments.curvature && (!topology || mesh.face_count() == 0)) {
    throw Error(ErrorCode::BadArgument,
                common.input + ": no surface can be made of this mesh, so it has no curvature (info tells why)");
  }
  if (!common.repair) describe_repair(mesh, topology, seam_vertices, common.quiet, table, json);
  table.print(common);
  write_json(common.report, json);
  return 0;
}

}  // namespace batten::cli
