/// \file Single points of a Butterfly surface, at places that refinement would reach, and their normals.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/patch/surface_place.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// A point of level l is computed from about ten points of level l - 1, and these from coarser ones, down to the
/// control points. All computed points are kept. Points near each other therefore cost O(1) each: about 200 bytes and a
/// microsecond. Not safe to share between threads.
class ButterflyPoints {
 public:
  /// The deepest level of a place.
  static constexpr int kMostLevels = 16;

  /// control: V-by-3, copied. Throws Error(NotTriangles, BadShape, BadArgument).
  ButterflyPoints(const Topology& topology, const Scheme& scheme, ConstValuesRef control);
  ~ButterflyPoints();

  /// u and v: multiples of 2^-kMostLevels. normals: unit, on the side of the place's face; zero where there is none.
  void evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points, Eigen::Ref<Points> normals);
  /// The points without their normals.
  void evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
