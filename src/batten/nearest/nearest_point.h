/// \file The point of the limit surface that is nearest to a given one.
///
/// The answer is proved. A tree of boxes around polynomial parts of the surface rules out all that is farther away;
/// where the squared distance is convex over a part, Newton's method finds and proves its minimum; other parts are
/// halved. The surface includes its creases, boundaries, corners and extraordinary vertices, but no faces of holes.
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

/// Nearest points for a connectivity and control points. Queries are const and safe from several threads.
/// Building takes O(H): 10 to 50 us a face, most where creases meet. Memory: 72 bytes a cell, and 200 to 400 a face. A
/// regular face has 1 to 64 cells, by how much it bends, one next to irregular vertices 4 to 31. A query near the
/// surface takes a few microseconds, one near its medial axis, where many places are equally near, up to some
/// milliseconds. Beside a vertex of high valence all its faces may be equally near: a query takes up to 0.15 ms for
/// each of them.
class NearestPoints {
 public:
  /// control: V-by-3. The callback is called by the calling thread only. Throws Error(NotTriangles, BadShape,
  /// NotFinite, Cancelled), and Error(BadArgument) where there is no face to be near to.
  NearestPoints(const SurfacePatches& patches, ConstValuesRef control, const Progress& progress = {});
  NearestPoints(const Topology& topology, const Scheme& scheme, ConstValuesRef control, const Progress& progress = {});
  ~NearestPoints();
  NearestPoints(NearestPoints&&) noexcept;

  /// Moves the surface to other control points of the same connectivity, V-by-3, by computing the boxes of the tree
  /// anew; the cells and the shape of the tree stay as the first control points made them. Distances are proved as
  /// before. Takes O(H), about a third of the time of building; from the first call on the boxes take their memory, 64
  /// bytes a cell, twice. The result depends on the control points alone, not on those in between.
  /// Building anew pays where many queries follow a large deformation: they may then be faster. Queries took 1.4 times
  /// as long as on a new surface after a twist by 180 degrees, 1.2 times after a bend by 180 degrees, and 1.1 times
  /// after a stretch by 3. No query may run at the same time. The callback is called by the calling thread only. Throws
  /// Error(BadShape, NotFinite, Cancelled), and then the surface is still the one before.
  void set_control(ConstValuesRef control, const Progress& progress = {});

  /// distance - least_distance is at most this: 1e-10 of the diagonal of the surface's box, and what doubles lose on
  /// large coordinates. Only where the surface shrinks to a curve or a point it may be more.
  double tolerance() const;
  /// The diagonal of a box around the surface, which may be a little larger than the surface.
  double diagonal() const;

  /// The nearest point for one query. Throws Error(NotFinite).
  NearestPoint nearest(const Eigen::Vector3d& query) const;
  /// found[i] for row i of queries, which has three columns; threaded. Throws Error(BadShape, Cancelled), and
  /// Error(NotFinite) with the row.
  void nearest(ConstValuesRef queries, std::span<NearestPoint> found, const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
