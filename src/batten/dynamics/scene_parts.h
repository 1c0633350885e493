/// \file The parts of a scene made for a body.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "batten/dynamics/elastic_run.h"
#include "batten/error.h"

namespace batten::dynamics {

/// What is wrong with the number of steps; empty where nothing is.
std::string wrong_steps(const SceneTime& time);

/// The control mesh of the rest shape and where it starts, refined as the scene says.
struct SceneBody {
  Topology topology;
  Scheme scheme;
  Mesh mesh;     ///< of the rest shape
  Points start;  ///< where its control points start
};

/// Throws Error(BadShape) for a start mesh with other faces.
SceneBody scene_body(const ElasticScene& scene, const SceneMeshes& meshes, const Progress& progress);
/// The scene's options for this body: coefficients that are given a face of the file's mesh are carried to its
/// children.
ElasticOptions body_options(const ElasticScene& scene, const SceneMeshes& meshes);
/// The path of points that are given.
PointPath point_path(const ScenePath& path);
/// Where the springs of the scene take hold, in their order.
std::vector<SurfacePlace> spring_places(const ElasticScene& scene, const ElasticSurface& body);
std::vector<std::shared_ptr<const Force>> scene_forces(const ElasticScene& scene, const SceneMeshes& meshes,
                                                       const ElasticSurface& body);
Supports scene_supports(const ElasticScene& scene, const ElasticSurface& body, const Points& start);

/// Calls `make`; an Error that it throws gets "SCENE: PLACE: " before its message, as forces[2], unless a part within
/// has said its place already.
template <typename Make>
auto made_at(const ElasticScene& scene, const std::string& place, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (error.code() == ErrorCode::Cancelled || message.rfind(scene.name + ": ", 0) == 0) throw;
    throw Error(error.code(), scene.name + ": " + place + ": " + message);
  }
}

}  // namespace batten::dynamics
