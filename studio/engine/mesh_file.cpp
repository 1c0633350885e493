#include "studio/engine/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "batten/adaptive/adaptive_surface_mesh.h"
#include "batten/io/io.h"
#include "batten/io/losses.h"
#include "batten/medial/medial_boundary.h"
#include "batten/medial/medial_check.h"
#include "batten/medial/medial_io.h"
#include "batten/mesh/check.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/topology.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/surface_mesh.h"

namespace batten::studio {
namespace {

constexpr std::size_t kMessages = 3;

std::vector<double> flat_creases(const Mesh& mesh) {
  std::vector<double> flat;
  for (const Crease& crease : mesh.creases)
    flat.insert(flat.end(), {static_cast<double>(crease.a), static_cast<double>(crease.b), crease.sharpness});
  return flat;
}

std::vector<double> flat_corners(const Mesh& mesh) {
  std::vector<double> flat;
  for (const Corner& corner : mesh.corners)
    flat.insert(flat.end(), {static_cast<double>(corner.vertex), corner.sharpness});
  return flat;
}

}  // namespace

val MeshFile::contents() const {
  val result = val::object();
  result.set("points", typed_array(mesh_.points));
  result.set("faceOffsets", typed_array(mesh_.face_offsets));
  result.set("faceVertices", typed_array(mesh_.face_vertices));
  result.set("creases", typed_array(flat_creases(mesh_)));
  result.set("corners", typed_array(flat_corners(mesh_)));
  result.set("notes", list(notes_, [](const std::string& note) { return val(note); }));
  result.set("diagonal", bounding_diagonal(mesh_.points));
  result.set("up", static_cast<int>(up_));
  result.set("triangles", all_triangles(mesh_));
  result.set("scheme", static_cast<int>(choose_scheme(mesh_).kind));
  result.set("origins", typed_array(origins_));
  return result;
}

val MeshFile::problems() const {
  return guarded([&] {
    return list(check(mesh_, kMessages), [](const MeshProblem& problem) {
      val one = val::object();
      one.set("code", static_cast<int>(problem.kind));
      one.set("count", static_cast<double>(problem.count));
      one.set("messages", list(problem.messages, [](const std::string& message) { return val(message); }));
      return one;
    });
  });
}

val MeshFile::set_points(const val& points) {
  return guarded([&] {
    Points given = to_points(points);
    if (given.rows() != mesh_.points.rows()) throw Error(ErrorCode::BadShape, "a point for each vertex is needed");
    mesh_.points = std::move(given);
    return val::null();
  });
}

val MeshFile::set_tags(const val& creases, const val& corners) {
  return guarded([&] {
    const std::vector<double> edges = emscripten::convertJSArrayToNumberVector<double>(creases);
    const std::vector<double> vertices = emscripten::convertJSArrayToNumberVector<double>(corners);
    mesh_.creases.clear();
    for (std::size_t i = 0; i + 2 < edges.size(); i += 3)
      mesh_.creases.push_back({static_cast<Index>(edges[i]), static_cast<Index>(edges[i + 1]), edges[i + 2]});
    mesh_.corners.clear();
    for (std::size_t i = 0; i + 1 < vertices.size(); i += 2)
      mesh_.corners.push_back({static_cast<Index>(vertices[i]), vertices[i + 1]});
    return val::null();
  });
}

val MeshFile::repaired(double weld) const {
  return guarded([&] {
    RepairOptions options;
    options.weld = weld;
    RepairResult repaired = repair(mesh_, options);
    val result = val::object();
    result.set("changes", list(repaired.changes, [](const RepairChange& change) { return val(change.text); }));
    result.set("mesh", std::make_shared<MeshFile>(std::move(repaired.mesh), up_));
    return result;
  });
}

val MeshFile::write(const std::string& path, int levels) const {
  return guarded([&] {
    Mesh refined;
    if (levels >= 0) {
      const Topology topology(mesh_);
      refined = surface_mesh(topology, choose_scheme(mesh_), mesh_, levels);
    }
    return write_as(path, levels >= 0 ? refined : mesh_);
  });
}

val MeshFile::write_adaptive(const std::string& path, double chord) const {
  return guarded([&] {
    const Scheme scheme = choose_scheme(mesh_);
    AdaptiveOptions options;
    options.chord = chord;
    options.faces = scheme.kind == SchemeKind::CatmullClark ? FaceKind::Quads : FaceKind::Triangles;
    return write_as(path, adaptive_surface_mesh(Topology(mesh_), scheme, mesh_, options).mesh);
  });
}

val MeshFile::write_as(const std::string& path, const Mesh& written) const {
  WriteOptions options;
  options.up = up_;
  write_mesh(path, written, options);
  val result = val::object();
  result.set("losses", list(find_losses(path, written), [](const std::string& loss) { return val(loss); }));
  return result;
}

Values wanted_normals_of(const val& numbers, Index vertices) {
  const auto flat = emscripten::convertJSArrayToNumberVector<double>(numbers);
  if (flat.empty()) return {};
  Values normals = Values::Zero(vertices, 3);
  for (std::size_t i = 0; i + 4 <= flat.size(); i += 4) {
    const double vertex = flat[i];
    if (!(vertex >= 0.0 && vertex < vertices)) throw Error(ErrorCode::IndexOutOfRange, "there is no such point");
    normals.row(static_cast<Index>(vertex)) << flat[i + 1], flat[i + 2], flat[i + 3];
  }
  return normals;
}

val MeshFile::write_normals(const std::string& path, const val& normals) const {
  return guarded([&] {
    Mesh mesh = mesh_;
    std::erase_if(mesh.attributes, [](const Attribute& attribute) { return attribute.name == "normal"; });
    mesh.attributes.push_back({"normal", wanted_normals_of(normals, mesh.vertex_count()), {}});
    write_mesh(path, mesh);
    return val::null();
  });
}

namespace {

MeshFile medial_file(const std::string& path, const Progress& progress) {
  const MedialModel model = read_medial(path, progress);
  MedialBoundary boundary = medial_boundary(model);
  const SpokeCheck check = check_spokes(boundary);
  const auto degrees = static_cast<long>(std::lround(180.0 / std::numbers::pi * check.max_tilt));
  std::string note = "A medial model: " + std::to_string(boundary.mesh.vertex_count()) +
                     " spokes, which lean by at most " + std::to_string(degrees) + " degrees.";
  if (!check.crossings.empty())
    note += " " + std::to_string(check.crossings.size()) + " pairs of neighbouring spokes pass each other.";
  return {std::move(boundary.mesh), UpAxis::Z, {std::move(note)}, std::move(boundary.origins)};
}

}  // namespace

val read_mesh_file(const std::string& path, const val& report) {
  return guarded([&] {
    if (path.ends_with(".json")) return val(std::make_shared<MeshFile>(medial_file(path, progress_of(report))));
    std::vector<std::string> notes;
    Mesh mesh = read_mesh(path, "", progress_of(report), &notes);
    const UpAxis up = find_up_axis(mesh, file_format(path));
    return val(std::make_shared<MeshFile>(std::move(mesh), up, std::move(notes)));
  });
}

}  // namespace batten::studio
