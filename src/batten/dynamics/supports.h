/// \file What of an elastic surface is held, or led along a path.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "batten/dynamics/elastic_surface.h"
#include "batten/patch/surface_place.h"
#include "batten/surface/surface_weights.h"
#include "batten/types.h"

namespace batten {

/// A point in space for each time in seconds.
using PointPath = std::function<Eigen::Vector3d(double time)>;

/// A path that stays.
inline PointPath stay_at(const Eigen::Vector3d& point) {
  return [point](double) { return point; };
}
/// A path of straight pieces: at times[i] it is at points[i]; before the first and after the last it stays. Times
/// increase. Throws Error(BadShape, BadArgument, NotFinite).
PointPath straight_path(std::vector<double> times, std::vector<Eigen::Vector3d> points);

/// Held exactly, whatever the forces.
struct Supports {
  /// A control point.
  struct FixedPoint {
    Index vertex;
    PointPath path;
  };
  /// A place of the surface, or a derivative there: its point, or du, dv and so on, is where the path says.
  struct Pin {
    SurfacePlace place;
    PointPath path;
    JetPart part = JetPart::Point;
  };

  std::vector<FixedPoint> points;
  std::vector<Pin> pins;

  bool empty() const { return points.empty() && pins.empty(); }
};

/// Holds the control points of all boundary vertices where they are at rest.
Supports hold_boundary(const ElasticSurface& surface);

/// The same supports on body.refined(), for the body as `state` has it. Control points of the refined mesh that depend
/// on fixed ones alone are fixed where these lead them. Where a fixed point leads none, the place of its vertex on the
/// surface is pinned instead: it stays where it is now, or moves along as the point did. Throws Error(BadArgument) for
/// derivatives pinned in triangles: no smaller triangle has both of their directions.
Supports refined_supports(const ElasticSurface& body, const Supports& supports, const ElasticState& state);

}  // namespace batten
