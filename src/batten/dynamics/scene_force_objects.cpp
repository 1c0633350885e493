/// From the forces of a scene to those that act on its body.
#include <cmath>
#include <numbers>
#include <string>

#include "batten/dynamics/contact.h"
#include "batten/dynamics/drag.h"
#include "batten/dynamics/gravity.h"
#include "batten/dynamics/nearest_springs.h"
#include "batten/dynamics/pressure.h"
#include "batten/dynamics/scene_parts.h"
#include "batten/dynamics/spring.h"

namespace batten::dynamics {

namespace {

using ForcePointer = std::shared_ptr<const Force>;

/// Straight between the times, as points are.
NumberPath number_path(const SceneNumbers& numbers, double unit) {
  if (numbers.values.empty()) return {};
  if (numbers.times.empty()) return always(unit * numbers.values.front());
  std::vector<Eigen::Vector3d> points;
  for (const double value : numbers.values) points.emplace_back(unit * value, 0.0, 0.0);
  const PointPath path = straight_path(numbers.times, std::move(points));
  return [path](double time) { return path(time).x(); };
}

ForcePointer make(const ScenePressure& scene, const ElasticSurface& body) {
  double unit = 1.0;
  if (!scene.volume.values.empty()) {
    unit = Pressure(body, 0.0).volume(body.rest());
    if (!(unit > 0.0)) {
      throw Error(ErrorCode::BadArgument,
                  "the rest shape encloses no volume, or is inside out; only a closed surface "
                  "whose normals point outward has a volume to be held");
    }
  }
  PressureOptions options;
  options.pressure = number_path(scene.pressure, 1.0);
  options.volume = number_path(scene.volume, unit);
  options.bulk_modulus = scene.bulk_modulus;
  return std::make_shared<Pressure>(body, options);
}

WindField wind_field(const SceneWind& wind) {
  const double speed = wind.velocity.norm();
  if (wind.sway.isZero(0.0)) return steady_wind(wind.velocity);
  const Eigen::Vector3d along = speed > 0.0 ? Eigen::Vector3d(wind.velocity / speed) : Eigen::Vector3d::Zero();
  return [wind, speed, along](const Eigen::Vector3d& point, double time) -> Eigen::Vector3d {
    const double phase = 2.0 * std::numbers::pi * (speed * time - along.dot(point)) / wind.length;
    return wind.velocity + std::sin(phase) * wind.sway;
  };
}

ForcePointer make(const SceneWind& scene, const ElasticSurface& body) {
  DragOptions options;
  options.wind = wind_field(scene);
  options.normal = scene.normal;
  options.tangential = scene.tangential;
  return std::make_shared<Drag>(body, options);
}

ForcePointer make(const SceneObstacle& scene, const ElasticSurface& body) {
  ContactOptions options;
  options.stiffness = scene.stiffness;
  options.friction = scene.friction;
  options.thickness = scene.thickness;
  switch (scene.kind) {
    case SceneObstacle::Kind::Plane:
      return std::make_shared<Contact>(body, plane_obstacle(scene.point, scene.normal), options);
    case SceneObstacle::Kind::Sphere:
      return std::make_shared<Contact>(body, sphere_obstacle(scene.point, scene.radius), options);
    case SceneObstacle::Kind::Box:
      break;
  }
  return std::make_shared<Contact>(body, box_inside_obstacle(scene.point, scene.corner), options);
}

ForcePointer make(const SceneNearestSprings& scene, const Points& points, const ElasticSurface& body) {
  NearestSpringOptions options;
  options.stiffness = {scene.stiffness};
  options.radius = scene.radius;
  return std::make_shared<NearestSprings>(body, points, options);
}

}  // namespace

std::vector<std::shared_ptr<const Force>> scene_forces(const ElasticScene& scene, const SceneMeshes& meshes,
                                                       const ElasticSurface& body) {
  const std::vector<SurfacePlace> places = spring_places(scene, body);
  std::vector<PointSprings::Spring> springs;
  std::vector<ForcePointer> forces;
  std::size_t cloud = 0;
  for (std::size_t i = 0; i < scene.forces.size(); ++i) {
    const SceneForce& force = scene.forces[i];
    made_at(scene, "forces[" + std::to_string(i) + "]", [&] {
      if (const auto* spring = std::get_if<SceneSpring>(&force)) {
        springs.push_back({places[springs.size()], point_path(spring->to), spring->stiffness});
      } else if (const auto* nearest = std::get_if<SceneNearestSprings>(&force)) {
        forces.push_back(make(*nearest, nearest->file.empty() ? nearest->points : meshes.clouds.at(cloud++), body));
      } else if (const auto* gravity = std::get_if<SceneGravity>(&force)) {
        forces.push_back(std::make_shared<Gravity>(body, gravity->acceleration));
      } else if (const auto* pressure = std::get_if<ScenePressure>(&force)) {
        forces.push_back(make(*pressure, body));
      } else if (const auto* wind = std::get_if<SceneWind>(&force)) {
        forces.push_back(make(*wind, body));
      } else {
        forces.push_back(make(std::get<SceneObstacle>(force), body));
      }
    });
  }
  if (!springs.empty()) forces.push_back(std::make_shared<PointSprings>(body, springs));
  return forces;
}

}  // namespace batten::dynamics
