/// \file From JSON to the parts of a scene. Each throws Error(BadFile) that names the file and the place.
#pragma once
#include "batten/dynamics/scene.h"
#include "batten/io/json_place.h"

namespace batten::dynamics {

using io::JsonPlace;

/// [x, y, z], or a list of {"time": ..., KEY: [x, y, z]} with times that increase.
ScenePath path_from_json(const JsonPlace& place, const char* key);
SceneForce force_from_json(const JsonPlace& place);
SceneSupport support_from_json(const JsonPlace& place);
ElasticOptions body_from_json(const JsonPlace& document);
SceneTime time_from_json(const JsonPlace& place);
SceneOutput output_from_json(const JsonPlace& place);

/// Gives the member to `read`, where there is one.
template <typename Read>
void if_has(const JsonPlace& place, const char* key, const Read& read) {
  if (place.has(key)) read(place.at(key));
}

/// Sets the target where there is such a member.
template <typename Target>
void set_not_negative(const JsonPlace& place, const char* key, Target& target) {
  if_has(place, key, [&](const JsonPlace& member) { target = member.not_negative(); });
}
template <typename Target>
void set_positive(const JsonPlace& place, const char* key, Target& target) {
  if_has(place, key, [&](const JsonPlace& member) { target = member.positive(); });
}
inline void set_vector(const JsonPlace& place, const char* key, Eigen::Vector3d& target) {
  if_has(place, key, [&](const JsonPlace& member) { target = member.vector(); });
}
inline void set_text(const JsonPlace& place, const char* key, std::string& target) {
  if_has(place, key, [&](const JsonPlace& member) { target = member.text(); });
}

}  // namespace batten::dynamics
