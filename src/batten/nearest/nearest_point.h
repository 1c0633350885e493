/// \file The point of the limit surface that is nearest to a given one.
///
/// The answer is proved: a tree of boxes around polynomial parts of the surface, convexity of the squared distance over
/// a part, and where it is convex Newton's method leave nothing that could be nearer. Creases, boundaries, corners and
/// extraordinary vertices are reached as they are; faces of holes are no part of the surface.
#pragma once
#include <memory>
#include <span>

#include "batten/surface/limit_surface.h"

namespace batten {

/// A point of the surface, as seen from a query.
struct NearestPoint {
  SurfacePlace place;           ///< for LimitSurface::jet of the same surface
  Eigen::Vector3d point;        ///< of the surface, at the place
  double distance = 0.0;        ///< from the query
  double least_distance = 0.0;  ///< proved: no point of the surface is nearer than this
};

/// Built for a connectivity and control points; asking is const and safe from several threads.
/// Build O(H): 10 to 50 us a face, most where creases meet. Memory: 72 bytes a cell, and 200 to 400 a face; a regular
/// face has 1 to 64 cells, by how much it bends, one next to irregular vertices 10 to 31. A query near the surface
/// takes a few microseconds, one near its medial axis, where many places are equally near, up to some milliseconds.
class NearestPoints {
 public:
  /// control: V-by-3. Throws Error(NotTriangles, BadShape, NotFinite, Cancelled), and
  /// Error(BadArgument) where there is no face to be near to.
  NearestPoints(const Topology& topology, const Scheme& scheme, ConstValuesRef control, const Progress& progress = {});
  ~NearestPoints();
  NearestPoints(NearestPoints&&) noexcept;

  /// distance - least_distance is at most this: 1e-10 of the diagonal of the surface's box, and what doubles lose on
  /// large coordinates. Only where the surface shrinks to a curve or a point it may be more.
  double tolerance() const;
  /// Of the box around the surface.
  double diagonal() const;

  /// Throws Error(NotFinite).
  NearestPoint nearest(const Eigen::Vector3d& query) const;
  /// found[i] for row i of queries, which has three columns; threaded. Throws Error(BadShape, Cancelled), and
  /// Error(NotFinite) with the row.
  void nearest(ConstValuesRef queries, std::span<NearestPoint> found, const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
