/// \file How blurred an image is, and where a bent surface lies beside its blurred edge.
///
/// Blur moves the edge of a bent surface towards the centre of the bend. Behind a Gaussian of covariance S the places
/// of a surface z = (k1 x^2 + k2 y^2) / 2 sink by m1 + m2 in the mean, with m = k t' S t / 2 for each principal
/// curvature k and its direction t; the derivative along the normal n is greatest where these sinks are most frequent,
/// about
///
///     d = m1 + m2 - 4 (m1^3 + m2^3) / (n' S n + 2 m1^2 + 2 m2^2)
///
/// inwards: sigma^2 / R on a ball, to the first order (Verbeek and van Vliet 1994, key VV94).
#pragma once
#include <span>

#include "batten/surface/limit_surface.h"
#include "batten/volume/edge_search.h"

namespace batten {

/// The covariance, mm^2, of all smoothing that the edges have gone through: that of the search itself, of `width`, and
/// the blur of the image, which is learnt from how fast the derivative falls beside the edges. The blur is taken to be
/// a Gaussian along each index of the grid. Edges without a weight say nothing. curvatures: of the surface where the
/// edges were searched, one each.
Eigen::Matrix3d edge_covariance(const VolumeGrid& grid, double width, const FoundEdges& edges,
                                std::span<const PointCurvature> curvatures);

/// d of the formula above, mm, positive where the surface lies outwards of its edge; at most sqrt(n' S n) either way; 0
/// where there is no curvature.
double edge_shift(const PointCurvature& curvature, const Eigen::Matrix3d& covariance);

}  // namespace batten
