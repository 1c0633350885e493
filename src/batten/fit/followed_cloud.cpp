#include "batten/fit/followed_cloud.h"

#include <vector>

namespace batten {

FollowedCloud::FollowedCloud(const PointCloud& cloud, const Buffer<std::uint8_t>& outliers, const Progress& progress)
    : all_(cloud) {
  const bool has_normals = cloud.normals.rows() > 0;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < outliers.size(); ++i) {
    if (outliers[i] == 0) rows.push_back(static_cast<Eigen::Index>(i));
  }
  if (!has_normals) all_.normals = estimate_normals(all_.points, {}, progress);
  if (rows.size() == outliers.size()) return;
  followed_.points = cloud.points(rows, Eigen::all);
  followed_.normals = has_normals ? Points(cloud.normals(rows, Eigen::all)) : estimate_normals(followed_.points);
  all_.normals(rows, Eigen::all) = followed_.normals;
}

}  // namespace batten
