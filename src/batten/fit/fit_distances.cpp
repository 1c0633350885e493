#include "batten/fit/fit_distances.h"

#include <vector>

#include "batten/fit/point_tree.h"
#include "batten/surface/quadrature.h"

namespace batten {

DistanceSummary measure_to_points(const SurfaceFitter& fitter) {
  constexpr int kPlaces = 4;
  const LimitSurface surface(fitter.topology(), fitter.scheme(), fitter.control());
  const SurfaceQuadrature quadrature = surface_quadrature(surface.patches(), {kPlaces, 0});
  std::vector<Jet> jets(quadrature.places.size());
  surface.jets(quadrature.places, jets);
  const PointTree tree(fitter.cloud().points);
  Scalars distances(static_cast<Eigen::Index>(jets.size()));
  for (std::size_t i = 0; i < jets.size(); ++i)
    distances[static_cast<Eigen::Index>(i)] = tree.distance(jets[i].point.transpose());
  return summarize_distances(distances);
}

Scalars measure_to_surface(const SurfaceFitter& fitter, const Points& points) {
  const NearestPoints nearest(fitter.topology(), fitter.scheme(), fitter.control());
  std::vector<NearestPoint> found(static_cast<std::size_t>(points.rows()));
  nearest.nearest(points, found);
  Scalars distances(points.rows());
  for (std::size_t i = 0; i < found.size(); ++i) distances[static_cast<Eigen::Index>(i)] = found[i].distance;
  return distances;
}

DistanceSummary summarize_followed(const Scalars& distances, const Buffer<std::uint8_t>& outliers, Index& left_out) {
  std::vector<Index> followed;
  for (Index i = 0; i < static_cast<Index>(outliers.size()); ++i) {
    if (outliers[i] == 0) followed.push_back(i);
  }
  left_out = static_cast<Index>(outliers.size() - followed.size());
  DistanceSummary summary = summarize_distances(distances(followed));
  summary.max_point = followed[static_cast<std::size_t>(summary.max_point)];
  return summary;
}

}  // namespace batten
