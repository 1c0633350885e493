#include "batten/dynamics/scene.h"

#include <filesystem>

#include "batten/dynamics/scene_json.h"
#include "batten/io/file_paths.h"
#include "batten/io/source.h"

namespace batten {
namespace {

using dynamics::if_has;
using io::JsonPlace;

constexpr Index kMostRefined = 6;

void read_scheme(const JsonPlace& document, ElasticScene& scene) {
  if_has(document, "scheme", [&](const JsonPlace& place) {
    scene.scheme = place.choice({"catmull-clark", "loop"}) == 0 ? SchemeKind::CatmullClark : SchemeKind::Loop;
  });
  if_has(document, "boundary", [&](const JsonPlace& place) {
    constexpr BoundaryRule kRules[] = {BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner};
    scene.boundary = kRules[place.choice({"none", "edge-only", "edge-and-corner"})];
  });
}

void read_start(const JsonPlace& document, ElasticScene& scene) {
  if_has(document, "start", [&](const JsonPlace& start) {
    start.require_keys({"mesh", "move", "velocity"});
    dynamics::set_text(start, "mesh", scene.start);
    dynamics::set_vector(start, "move", scene.move);
    dynamics::set_vector(start, "velocity", scene.velocity);
  });
}

std::string required_file(const JsonPlace& place) {
  std::string file = place.text();
  if (file.empty()) place.fail("the name of a mesh file is expected here");
  return file;
}

}  // namespace

ElasticScene parse_scene(const std::string& name, std::string_view text) {
  const io::JsonName names{name, "scene"};
  const io::Json json = io::parse_json(names, text);
  const JsonPlace document(names, json);
  document.require_keys({"$schema", "about", "mesh", "refine", "scheme", "boundary", "start", "material", "rest",
                         "forces", "supports", "time", "output"});
  ElasticScene scene;
  scene.name = name;
  scene.mesh = required_file(document.at("mesh"));
  if_has(document, "refine", [&](const JsonPlace& place) { scene.refine = place.index_to(kMostRefined); });
  read_scheme(document, scene);
  read_start(document, scene);
  scene.body = dynamics::body_from_json(document);
  if_has(document, "forces", [&](const JsonPlace& list) {
    for (std::size_t i = 0; i < list.size(); ++i) scene.forces.push_back(dynamics::force_from_json(list.item(i)));
  });
  if_has(document, "supports", [&](const JsonPlace& list) {
    for (std::size_t i = 0; i < list.size(); ++i) scene.supports.push_back(dynamics::support_from_json(list.item(i)));
  });
  if_has(document, "time", [&](const JsonPlace& place) { scene.time = dynamics::time_from_json(place); });
  if_has(document, "output", [&](const JsonPlace& place) { scene.output = dynamics::output_from_json(place); });
  return scene;
}

ElasticScene read_scene(const std::string& path) {
  const io::InputFile file(path);
  ElasticScene scene = parse_scene(path == "-" ? "standard input" : path, file.bytes());
  const auto find = [&](std::string& name) {
    if (!name.empty()) name = io::path_named_in(path, name);
  };
  find(scene.mesh);
  find(scene.start);
  for (SceneForce& force : scene.forces) {
    if (auto* springs = std::get_if<SceneNearestSprings>(&force)) find(springs->file);
  }
  return scene;
}

}  // namespace batten
