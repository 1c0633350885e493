#include "batten/dynamics/scene_parts.h"

#include <algorithm>
#include <string>
#include <utility>

#include "batten/energy/face_coefficients.h"
#include "batten/mesh/moved_mesh.h"
#include "batten/nearest/nearest_point.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"

namespace batten::dynamics {

namespace {

Points start_points(const ElasticScene& scene, const SceneMeshes& meshes) {
  Points start = meshes.rest.points;
  if (meshes.start) {
    made_at(scene, "start.mesh", [&] { require_same_connectivity(meshes.rest, *meshes.start); });
    start = meshes.start->points;
  }
  return start.rowwise() + scene.move.transpose();
}

Scheme scene_scheme(const ElasticScene& scene, const Mesh& mesh) {
  Scheme scheme = choose_scheme(mesh);
  scheme.kind = scene.scheme.value_or(scheme.kind);
  scheme.boundary = scene.boundary.value_or(scheme.boundary);
  return scheme;
}

SurfacePlace vertex_place(const SurfacePatches& patches, Index vertex) {
  if (vertex >= patches.topology().vertex_count() || patches.base().is_isolated(vertex)) {
    throw Error(ErrorCode::IndexOutOfRange, "there is no vertex " + std::to_string(vertex) +
                                                " on the surface; the mesh has vertices 0 to " +
                                                std::to_string(patches.topology().vertex_count() - 1));
  }
  return place_of_vertex(patches.base(), vertex);
}

/// Finds the places of a scene on a body; nearest places are looked for in its rest shape.
class PlaceFinder {
 public:
  explicit PlaceFinder(const ElasticSurface& body) : body_(body) {}
  SurfacePlace find(const ScenePlace& place) {
    if (place.place) return checked(*place.place);
    if (place.vertex) return vertex_place(body_.patches(), *place.vertex);
    if (!nearest_) nearest_.emplace(body_.patches(), body_.rest());
    return nearest_->nearest(*place.near).place;
  }

 private:
  SurfacePlace checked(const SurfacePlace& place) const {
    const Index faces = body_.patches().base().face_count();
    if (place.face >= faces) {
      throw Error(ErrorCode::IndexOutOfRange, "there is no face " + std::to_string(place.face) +
                                                  "; the surface has faces 0 to " + std::to_string(faces - 1));
    }
    if (!body_.patches().quads() && place.u + place.v > 1.0)
      throw Error(ErrorCode::BadArgument, "u + v is above 1, outside of a triangle");
    return place;
  }

  const ElasticSurface& body_;
  std::optional<NearestPoints> nearest_;
};

void add_hold(const SceneHold& hold, const ElasticSurface& body, const Points& start, Supports& supports) {
  const Topology& topology = body.topology();
  const auto is_held = [&](Index v) {
    if (hold.boundary) return !topology.is_isolated(v) && topology.is_boundary_vertex(v);
    const Eigen::Vector3d point = start.row(v).transpose();
    return (point.array() >= hold.box->first.array()).all() && (point.array() <= hold.box->second.array()).all();
  };
  std::vector<Index> vertices = hold.vertices;
  if (hold.boundary || hold.box) {
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (is_held(v)) vertices.push_back(v);
    }
  }
  if (vertices.empty()) {
    throw Error(ErrorCode::BadArgument, hold.boundary ? "the mesh has no boundary to hold"
                                                      : "no control point starts in this box, so it holds nothing");
  }
  std::vector<bool> held(static_cast<std::size_t>(topology.vertex_count()), false);
  for (const Supports::FixedPoint& point : supports.points) held[static_cast<std::size_t>(point.vertex)] = true;
  for (const Index v : vertices) {
    if (v >= topology.vertex_count()) {
      throw Error(ErrorCode::IndexOutOfRange, "there is no vertex " + std::to_string(v) +
                                                  "; the mesh has vertices 0 to " +
                                                  std::to_string(topology.vertex_count() - 1));
    }
    if (held[static_cast<std::size_t>(v)])
      throw Error(ErrorCode::BadArgument, "vertex " + std::to_string(v) + " is held twice; name it once");
    held[static_cast<std::size_t>(v)] = true;
    const Eigen::Vector3d from = start.row(v).transpose();
    if (hold.move.points.empty()) {
      supports.points.push_back({v, stay_at(from)});
    } else {
      const PointPath move = point_path(hold.move);
      supports.points.push_back({v, [from, move](double time) -> Eigen::Vector3d { return from + move(time); }});
    }
  }
}

}  // namespace

PointPath point_path(const ScenePath& path) {
  return path.times.empty() ? stay_at(path.points.front()) : straight_path(path.times, path.points);
}

SceneBody scene_body(const ElasticScene& scene, const SceneMeshes& meshes, const Progress& progress) {
  return made_at(scene, "mesh", [&] {
    const Points start = start_points(scene, meshes);
    const Scheme scheme = scene_scheme(scene, meshes.rest);
    const Topology topology(meshes.rest, progress);
    if (scene.refine == 0) return SceneBody{topology, scheme, meshes.rest, start};
    RefinedMesh refined = refine_mesh(topology, scheme, meshes.rest, scene.refine, progress);
    const RefinedSurface moved = batten::refine(topology, scheme, start, scene.refine, progress);
    return SceneBody{refined.topology, scheme.after_first_step(), std::move(refined.mesh), moved.values};
  });
}

ElasticOptions body_options(const ElasticScene& scene, const SceneMeshes& meshes) {
  ElasticOptions options = scene.body;
  const Scheme scheme = scene_scheme(scene, meshes.rest);
  const std::pair<const char*, std::vector<double>*> lists[] = {{"density", &options.material.density},
                                                                {"damping", &options.material.damping},
                                                                {"tension", &options.material.tension},
                                                                {"rigidity", &options.material.rigidity}};
  for (const auto& [name, list] : lists) {
    if (list->size() == 1) continue;
    if (list->size() != static_cast<std::size_t>(meshes.rest.face_count())) {
      throw Error(ErrorCode::BadShape,
                  scene.name + ": material." + name + ": there are " + std::to_string(list->size()) + " numbers for " +
                      std::to_string(meshes.rest.face_count()) + " faces; give one for all or one a face");
    }
    Topology topology(meshes.rest);
    for (int i = 0; i < scene.refine; ++i) {
      *list = child_coefficients(*list, topology, scheme.kind == SchemeKind::CatmullClark);
      if (i + 1 < scene.refine) topology = Refinement(topology, scheme).child();
    }
  }
  return options;
}

std::vector<SurfacePlace> spring_places(const ElasticScene& scene, const ElasticSurface& body) {
  PlaceFinder finder(body);
  std::vector<SurfacePlace> places;
  for (std::size_t i = 0; i < scene.forces.size(); ++i) {
    if (const auto* spring = std::get_if<SceneSpring>(&scene.forces[i]))
      places.push_back(made_at(scene, "forces[" + std::to_string(i) + "].at", [&] { return finder.find(spring->at); }));
  }
  return places;
}

Supports scene_supports(const ElasticScene& scene, const ElasticSurface& body, const Points& start) {
  Supports supports;
  PlaceFinder finder(body);
  for (std::size_t i = 0; i < scene.supports.size(); ++i) {
    made_at(scene, "supports[" + std::to_string(i) + "]", [&] {
      if (const auto* hold = std::get_if<SceneHold>(&scene.supports[i])) {
        add_hold(*hold, body, start, supports);
        return;
      }
      const auto& pin = std::get<ScenePin>(scene.supports[i]);
      const SurfacePlace place = finder.find(pin.at);
      if (!pin.to.points.empty()) {
        supports.pins.push_back({place, point_path(pin.to)});
        return;
      }
      const Points at = place_rows(body.patches(), {&place, 1}).rows * start;
      supports.pins.push_back({place, stay_at(at.row(0).transpose())});
    });
  }
  return supports;
}

}  // namespace batten::dynamics
