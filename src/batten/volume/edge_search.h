/// \file Edges of an image along the normals of a surface.
#pragma once
#include "batten/volume/recursive_filter.h"

namespace batten {

/// One row for each place.
struct FoundEdges {
  Points places;    ///< N-by-3, in the world; the place itself where none was found
  Scalars weights;  ///< 0 to 1: 0 where none was found
};

/// The derivatives of a smoothed image.
class EdgeSearch {
 public:
  /// width: of the smoothing, mm: alpha is 2 / width. Throws what gradient() throws.
  EdgeSearch(const Volume& image, double width);

  /// The strongest derivative of the image along the normal, within `reach` mm to either side; farther ones have to be
  /// stronger: by 1 / (1 - (distance / (1.5 reach))^2). Where most of the surface has the same step, from bright to
  /// dark or back (the sum of signed derivatives is above 0.6 of that of their sizes), only such steps count. The
  /// weight is the strength as a share of the upper quartile's, 1 at most, squared: weak edges hold little. points,
  /// normals: N-by-3, in the world; threaded.
  FoundEdges find(const Points& points, const Points& normals, double reach) const;

 private:
  /// At a place of the world: the derivative along a direction, whose components along the indices are given. Quadratic
  /// B-splines have no kinks at voxels, to which the places of edges would be drawn.
  double derivative(const Eigen::Vector3d& place, const Eigen::Vector3d& along) const;

  Gradient slope_;
  Eigen::Matrix3d to_index_;
  double step_;   ///< mm
  double least_;  ///< derivatives up to this are rounding
};

}  // namespace batten
