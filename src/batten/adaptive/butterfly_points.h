/// \file Single points of a Butterfly surface, at the places that refinement would reach, with their normals.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/patch/surface_place.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// A point of level l is made of some ten points of level l - 1, and those of others, down to the control points; what
/// has been made is kept. So points cost O(1) each where many are asked for near each other: some 200 bytes and about a
/// microsecond. Not safe to share between threads.
class ButterflyPoints {
 public:
  /// Places lie this many levels deep at most.
  static constexpr int kMostLevels = 16;

  /// control: V-by-3, copied. Throws Error(NotTriangles, BadShape, BadArgument).
  ButterflyPoints(const Topology& topology, const Scheme& scheme, ConstValuesRef control);
  ~ButterflyPoints();

  /// u and v: multiples of 2^-kMostLevels. normals: unit, of the side of the place's face; zero where there is none.
  void evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points, Eigen::Ref<Points> normals);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
