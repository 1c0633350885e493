/// The forces and the supports of a scene.
#include "batten/dynamics/scene_json.h"

namespace batten::dynamics {

namespace {

ScenePlace place_from_json(const JsonPlace& json) {
  json.require_keys({"face", "u", "v", "vertex", "near"});
  ScenePlace place;
  const int ways = (json.has("face") ? 1 : 0) + (json.has("vertex") ? 1 : 0) + (json.has("near") ? 1 : 0);
  if (ways != 1) json.fail("a place is given by \"near\": [x, y, z], by \"vertex\", or by \"face\", \"u\" and \"v\"");
  if (json.has("face")) {
    const auto share = [&](const char* key) {
      const JsonPlace number = json.at(key);
      const double value = number.number();
      if (value < 0.0 || value > 1.0) number.fail("a number from 0 to 1 is expected here");
      return value;
    };
    place.place = SurfacePlace{json.at("face").index(), share("u"), share("v")};
  } else if (json.has("u") || json.has("v")) {
    json.at(json.has("u") ? "u" : "v").fail("goes with \"face\" only");
  }
  if_has(json, "vertex", [&](const JsonPlace& vertex) { place.vertex = vertex.index(); });
  if_has(json, "near", [&](const JsonPlace& near) { place.near = near.vector(); });
  return place;
}

SceneSpring spring_from_json(const JsonPlace& json) {
  json.require_keys({"type", "at", "to", "stiffness"});
  SceneSpring spring;
  spring.at = place_from_json(json.at("at"));
  spring.to = path_from_json(json.at("to"), "point");
  set_not_negative(json, "stiffness", spring.stiffness);
  return spring;
}

SceneNearestSprings nearest_springs_from_json(const JsonPlace& json) {
  json.require_keys({"type", "points", "stiffness", "radius"});
  SceneNearestSprings springs;
  const JsonPlace points = json.at("points");
  if (points.is_text()) {
    springs.file = points.text();
    if (springs.file.empty()) points.fail("the name of a file is expected here");
  } else {
    springs.points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
      springs.points.row(static_cast<Eigen::Index>(i)) = points.item(i).vector().transpose();
    if (points.size() == 0) points.fail("a point at least is expected here");
  }
  set_not_negative(json, "stiffness", springs.stiffness);
  set_not_negative(json, "radius", springs.radius);
  return springs;
}

SceneGravity gravity_from_json(const JsonPlace& json) {
  json.require_keys({"type", "acceleration"});
  SceneGravity gravity;
  set_vector(json, "acceleration", gravity.acceleration);
  return gravity;
}

/// A number, or a list of {"time": ..., "value": ...} with times that increase.
SceneNumbers numbers_from_json(const JsonPlace& place, bool positive) {
  const auto number = [&](const JsonPlace& json) { return positive ? json.positive() : json.number(); };
  SceneNumbers numbers;
  if (place.is_number()) {
    numbers.values.push_back(number(place));
    return numbers;
  }
  for (std::size_t i = 0; i < place.size(); ++i) {
    const JsonPlace moment = place.item(i);
    moment.require_keys({"time", "value"});
    numbers.times.push_back(moment.at("time").number());
    numbers.values.push_back(number(moment.at("value")));
    if (i > 0 && !(numbers.times[i] > numbers.times[i - 1])) moment.at("time").fail("the times must increase");
  }
  if (numbers.values.empty()) place.fail("a number, or a list of numbers at times, is expected here");
  return numbers;
}

ScenePressure pressure_from_json(const JsonPlace& json) {
  json.require_keys({"type", "pressure", "volume", "bulk_modulus"});
  ScenePressure pressure;
  if (json.has("pressure") == json.has("volume"))
    json.fail("either \"pressure\", or \"volume\" with its \"bulk_modulus\", is expected here");
  if (json.has("bulk_modulus") != json.has("volume")) json.fail("\"volume\" and \"bulk_modulus\" go together");
  if_has(json, "pressure", [&](const JsonPlace& place) { pressure.pressure = numbers_from_json(place, false); });
  if_has(json, "volume", [&](const JsonPlace& place) { pressure.volume = numbers_from_json(place, true); });
  set_not_negative(json, "bulk_modulus", pressure.bulk_modulus);
  return pressure;
}

SceneWind wind_from_json(const JsonPlace& json) {
  json.require_keys({"type", "velocity", "sway", "length", "normal", "tangential"});
  SceneWind wind;
  set_vector(json, "velocity", wind.velocity);
  set_vector(json, "sway", wind.sway);
  set_positive(json, "length", wind.length);
  set_not_negative(json, "normal", wind.normal);
  set_not_negative(json, "tangential", wind.tangential);
  return wind;
}

void set_surface(const JsonPlace& json, SceneObstacle& obstacle) {
  set_positive(json, "stiffness", obstacle.stiffness);
  set_not_negative(json, "friction", obstacle.friction);
  set_not_negative(json, "thickness", obstacle.thickness);
}

SceneObstacle plane_from_json(const JsonPlace& json) {
  json.require_keys({"type", "point", "normal", "stiffness", "friction", "thickness"});
  SceneObstacle plane;
  set_vector(json, "point", plane.point);
  if_has(json, "normal", [&](const JsonPlace& normal) {
    plane.normal = normal.vector();
    if (!(plane.normal.norm() > 0.0)) normal.fail("a direction is expected here, not 0");
  });
  set_surface(json, plane);
  return plane;
}

SceneObstacle sphere_from_json(const JsonPlace& json) {
  json.require_keys({"type", "center", "radius", "stiffness", "friction", "thickness"});
  SceneObstacle sphere;
  sphere.kind = SceneObstacle::Kind::Sphere;
  sphere.point = json.at("center").vector();
  sphere.radius = json.at("radius").positive();
  set_surface(json, sphere);
  return sphere;
}

SceneObstacle box_from_json(const JsonPlace& json) {
  json.require_keys({"type", "from", "to", "stiffness", "friction", "thickness"});
  SceneObstacle box;
  box.kind = SceneObstacle::Kind::Box;
  box.point = json.at("from").vector();
  box.corner = json.at("to").vector();
  if ((box.corner - box.point).minCoeff() <= 0.0) json.at("to").fail("each number must be above that of \"from\"");
  set_surface(json, box);
  return box;
}

SceneHold hold_from_json(const JsonPlace& json) {
  json.require_keys({"type", "vertices", "move"});
  SceneHold hold;
  const JsonPlace vertices = json.at("vertices");
  if (vertices.is_text()) {
    vertices.choice({"boundary"});
    hold.boundary = true;
  } else if (vertices.is_object()) {
    vertices.require_keys({"from", "to"});
    hold.box = {vertices.at("from").vector(), vertices.at("to").vector()};
    if ((hold.box->second - hold.box->first).minCoeff() < 0.0)
      vertices.at("to").fail("no number may be below that of \"from\"");
  } else {
    for (std::size_t i = 0; i < vertices.size(); ++i) hold.vertices.push_back(vertices.item(i).index());
    if (hold.vertices.empty()) vertices.fail("a vertex at least is expected here");
  }
  if_has(json, "move", [&](const JsonPlace& move) { hold.move = path_from_json(move, "by"); });
  return hold;
}

ScenePin pin_from_json(const JsonPlace& json) {
  json.require_keys({"type", "at", "to"});
  ScenePin pin;
  pin.at = place_from_json(json.at("at"));
  if_has(json, "to", [&](const JsonPlace& to) { pin.to = path_from_json(to, "point"); });
  return pin;
}

}  // namespace

ScenePath path_from_json(const JsonPlace& place, const char* key) {
  ScenePath path;
  if (place.size() == 0) place.fail("[x, y, z], or a list of points at times, is expected here");
  if (place.item(0).is_number()) {
    path.points.push_back(place.vector());
    return path;
  }
  for (std::size_t i = 0; i < place.size(); ++i) {
    const JsonPlace moment = place.item(i);
    moment.require_keys({"time", key});
    path.times.push_back(moment.at("time").number());
    path.points.push_back(moment.at(key).vector());
    if (i > 0 && !(path.times[i] > path.times[i - 1])) moment.at("time").fail("the times must increase");
  }
  return path;
}

SceneForce force_from_json(const JsonPlace& place) {
  switch (
      place.at("type").choice({"spring", "nearest-springs", "gravity", "pressure", "wind", "plane", "sphere", "box"})) {
    case 0:
      return spring_from_json(place);
    case 1:
      return nearest_springs_from_json(place);
    case 2:
      return gravity_from_json(place);
    case 3:
      return pressure_from_json(place);
    case 4:
      return wind_from_json(place);
    case 5:
      return plane_from_json(place);
    case 6:
      return sphere_from_json(place);
    default:
      return box_from_json(place);
  }
}

SceneSupport support_from_json(const JsonPlace& place) {
  if (place.at("type").choice({"hold", "pin"}) == 0) return hold_from_json(place);
  return pin_from_json(place);
}

}  // namespace batten::dynamics
