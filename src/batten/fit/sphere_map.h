/// \file A closed triangle mesh without handles, laid on the unit sphere.
#pragma once
#include <memory>

#include "batten/mesh/mesh.h"
#include "batten/progress.h"

namespace batten {

/// A direction for each vertex such that no triangle is turned over on the sphere and the map from the sphere to the
/// surface stretches little (Praun and Hoppe 2003, key PH03): edges collapse until a tetrahedron is left, which is laid
/// on the sphere; then the vertices come back one by one, each inside its ring, and move to where the mean square of
/// the stretch from the sphere to the surface is least. So every part of the surface, a long ear as well, gets its part
/// of the sphere. The result depends on the mesh alone.
class SphereMap {
 public:
  /// mesh: triangles that Topology accepts, one component of genus 0 without boundary. O(V log V), some 0.3
  /// milliseconds a vertex. Throws Error(Cancelled).
  explicit SphereMap(const Mesh& mesh, const Progress& progress = {});
  ~SphereMap();

  /// V-by-3, of length 1.
  const Points& directions() const;

  /// Triangles that are turned over or have no area on the sphere: none, but for rounding.
  Index turned_triangles() const;

  /// Moves vertices, sweep by sweep, to where the stretch is less when lengths of the surface are multiplied by the
  /// root of its density: where it is twice as dense, it gets twice the part of the sphere. The stretch of the map from
  /// the surface to the sphere counts a tenth as much: without it parameters bend where the surface does not, and
  /// surfaces that follow them fold at the tips of ears. density: one a vertex, positive.
  void relax(const Scalars& density, int sweeps);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
