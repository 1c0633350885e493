/// \file A scene for an elastic surface: plain data, as a scene file holds it. docs/simulate.md describes the format.
///
/// Units are metres, seconds and kilograms, or any other consistent ones. What a file does not give has the values
/// below. `ElasticRun` (dynamics/elastic_run.h) brings a scene to life.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/elastic_surface.h"
#include "batten/mesh/up_axis.h"
#include "batten/patch/surface_place.h"
#include "batten/types.h"

namespace batten {

/// A place on the surface: exactly one of the three.
struct ScenePlace {
  std::optional<SurfacePlace> place;         ///< a face of the surface's base (patch/surface_place.h), u and v
  std::optional<Index> vertex;               ///< where the surface has its vertex: the limit position
  std::optional<Eigen::Vector3d> near = {};  ///< the point of the rest shape that is nearest to this one
};

/// Points at times, which increase; straight between them, staying before and after. Without times: one point. Without
/// points: not given.
struct ScenePath {
  std::vector<double> times;  ///< seconds
  std::vector<Eigen::Vector3d> points;
};

/// Numbers at times, in the same way.
struct SceneNumbers {
  std::vector<double> times;
  std::vector<double> values;
};

/// A spring from a place of the surface to a point.
struct SceneSpring {
  ScenePlace at;
  ScenePath to;
  double stiffness = 1.0;  ///< N/m
};
/// Springs from points to the nearest places of the surface, wherever it moves.
struct SceneNearestSprings {
  std::string file;        ///< of points, or
  Points points;           ///< these
  double stiffness = 1.0;  ///< N/m, of each
  double radius = 0.0;     ///< how wide each pull is spread over the surface
};
/// A constant acceleration of everything.
struct SceneGravity {
  Eigen::Vector3d acceleration{0.0, 0.0, -9.81};  ///< m/s^2
};
/// Along the outward normals: a pressure, or what holds the volume of a closed surface.
struct ScenePressure {
  SceneNumbers pressure;      ///< N/m^2, or
  SceneNumbers volume;        ///< wanted, as a multiple of that of the rest shape, with
  double bulk_modulus = 0.0;  ///< N/m^2: the pressure is this times (1 - volume / wanted volume)
};
/// Air that moves: velocity + sway * sin(2 pi (speed * time - distance along the wind) / length).
struct SceneWind {
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< m/s
  Eigen::Vector3d sway{0.0, 0.0, 0.0};      ///< m/s: waves that travel with the wind
  double length = 1.0;                      ///< m, of the waves
  double normal = 1.0;                      ///< force per area and speed along the normal: kg/(m^2 s)
  double tangential = 0.0;                  ///< across it
};
/// What the surface cannot enter, or for a box with `inside` cannot leave.
struct SceneObstacle {
  enum class Kind { Plane, Sphere, Box };
  Kind kind = Kind::Plane;
  Eigen::Vector3d point{0.0, 0.0, 0.0};   ///< of the plane, centre of the sphere, least corner of the box
  Eigen::Vector3d normal{0.0, 0.0, 1.0};  ///< of the plane, towards the free side
  Eigen::Vector3d corner{0.0, 0.0, 0.0};  ///< greatest corner of the box
  double radius = 0.0;                    ///< of the sphere
  double stiffness = 1e4;                 ///< N/m per area: N/m^3
  double friction = 0.0;                  ///< Coulomb's coefficient
  double thickness = 0.0;                 ///< the surface is kept so far away
};
/// One entry of a scene's list of forces.
using SceneForce =
    std::variant<SceneSpring, SceneNearestSprings, SceneGravity, ScenePressure, SceneWind, SceneObstacle>;

/// Control points that are held where they start, or led from there.
struct SceneHold {
  bool boundary = false;                                           ///< those of all boundary vertices, or
  std::vector<Index> vertices;                                     ///< these, or
  std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> box;  ///< those that start in this box
  ScenePath move;                                                  ///< by how much at which time
};
/// A place of the surface that is held where it starts, or led along a path.
struct ScenePin {
  ScenePlace at;
  ScenePath to;
};
/// One entry of a scene's list of what is held or led.
using SceneSupport = std::variant<SceneHold, ScenePin>;

/// The body does not move any more: the root mean square of its speed, and the greatest force on a control point that
/// nothing balances, are at most these. Not given: a thousandth of the diagonal per second, and the force that gives a
/// control point of average mass an acceleration of a hundredth of the diagonal per second squared.
struct SceneRest {
  std::optional<double> speed;
  std::optional<double> force;
};

/// How long the scene lasts, by what steps it goes, and when it is refined.
struct SceneTime {
  double seconds = 1.0;
  MotionOptions motion;
  std::optional<double> step_error;  ///< step control: the error of a step, as a share of the diagonal
  SceneRest rest;
  bool until_rest = false;        ///< stop when it does not move any more
  std::vector<double> refine_at;  ///< times at which the control mesh is refined, increasing
  int refine_at_rest = 0;         ///< so often, each time when it does not move any more
};

/// What is written of the motion.
struct SceneOutput {
  double frames_per_second = 24.0;
  std::optional<int> levels;  ///< refinement of the surface that is written
  std::optional<UpAxis> up;
};

/// A whole scene. Paths of files are as they are to be opened.
struct ElasticScene {
  std::string name = "scene";               ///< the file, for messages
  std::string mesh;                         ///< the control mesh of the rest shape
  int refine = 0;                           ///< steps of refinement before anything else, of `start` too
  std::string start;                        ///< a mesh with the same faces: where it starts; empty: the rest shape
  Eigen::Vector3d move{0.0, 0.0, 0.0};      ///< where it starts is moved by this
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< of all points at the start, m/s
  std::optional<SchemeKind> scheme;         ///< not given: choose_scheme of the mesh
  std::optional<BoundaryRule> boundary;
  ElasticOptions body;
  std::vector<SceneForce> forces;
  std::vector<SceneSupport> supports;
  SceneTime time;
  SceneOutput output;
};

/// Reads a scene from JSON. name: for messages, "NAME: forces[2].stiffness: -3 is negative; give 0 or more". Paths stay
/// as they are written; no file is opened. Throws Error(BadFile).
ElasticScene parse_scene(const std::string& name, std::string_view text);

/// Reads a scene file; paths in it are relative to its folder. "-" is standard input. Throws Error(FileNotReadable,
/// BadFile).
ElasticScene read_scene(const std::string& path);

}  // namespace batten
