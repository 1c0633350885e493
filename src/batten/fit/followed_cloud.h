/// \file A cloud some of whose points are outliers.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/fit/point_cloud.h"
#include "batten/progress.h"

namespace batten {

/// All points of a cloud, and those without outliers, both with normals. Where a cloud has none, those of points that
/// are no outliers come from such points alone.
class FollowedCloud {
 public:
  /// cloud: with normals or without; outliers: one flag a point. Throws what estimate_normals() throws.
  FollowedCloud(const PointCloud& cloud, const Buffer<std::uint8_t>& outliers, const Progress& progress = {});

  const PointCloud& all() const { return all_; }
  const PointCloud& followed() const { return followed_.points.rows() > 0 ? followed_ : all_; }

 private:
  PointCloud all_;
  PointCloud followed_;  ///< without points where all are followed
};

}  // namespace batten
