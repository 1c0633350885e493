#include "batten/fit/point_cloud.h"

#include <algorithm>

#include "batten/error.h"
#include "batten/fit/cloud_samples.h"
#include "batten/fit/orientation.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/unit_scale.h"
#include "batten/parallel/parallel.h"

namespace batten {

Buffer<Index> sorted_rows(const Points& points, const Points& then) {
  Buffer<Index> rows(static_cast<std::size_t>(points.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Index>(i);
  const bool more = then.rows() == points.rows();
  std::sort(rows.begin(), rows.end(), [&](Index a, Index b) {
    for (Index c = 0; c < 3; ++c) {
      if (points(a, c) != points(b, c)) return points(a, c) < points(b, c);
    }
    for (Index c = 0; more && c < 3; ++c) {
      if (then(a, c) != then(b, c)) return then(a, c) < then(b, c);
    }
    return a < b;
  });
  return rows;
}

Points estimate_normals(ConstValuesRef points, const NormalEstimate& options, const Progress& progress) {
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "normals are estimated for points of three coordinates");
  if (options.neighbours < 3 || options.neighbours > 100)
    throw Error(ErrorCode::BadArgument, "normals are estimated from 3 to 100 neighbours");
  require_finite(points, "points");
  const Points all = points * unit_scale(points);
  const Buffer<Index> rows = sorted_rows(all);
  Buffer<Index> place(rows.size());
  Points different(all.rows(), 3);
  Index count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || all.row(rows[i]) != all.row(rows[i - 1])) different.row(count++) = all.row(rows[i]);
    place[rows[i]] = count - 1;
  }
  different.conservativeResize(count, 3);
  const PointTree tree(different);
  const NeighbourTable neighbours = find_neighbours(tree, options.neighbours, progress_within(progress, 0.0, 0.6));
  LocalPlanes planes = local_planes(different, neighbours);
  report_progress(progress, 0.8);
  orient_normals(different, neighbours, planes.normals);
  Points normals(all.rows(), 3);
  for (Eigen::Index row = 0; row < all.rows(); ++row) normals.row(row) = planes.normals.row(place[row]);
  return normals;
}

}  // namespace batten
