/// \file Points that a fit shall not follow.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/fit/point_tree.h"

namespace batten {

/// Judges points by their neighbours, built once for a cloud. Memory: 100 bytes a point.
class OutlierFilter {
 public:
  /// O(N log N).
  OutlierFilter(const PointTree& tree, const Progress& progress = {});

  /// The median distance between neighbouring points.
  double spacing() const { return spacing_; }

  /// One flag a point. Lonely points: their mean distance to the nearest others is three times what it is for these, or
  /// six times the usual.
  Buffer<std::uint8_t> lonely() const;

  /// Adds those whose distance from a surface is eight times the median of their neighbours', and above one and a half
  /// spacings: a part of the shape that the surface has not reached is far as a whole.
  void add_far(const Scalars& distances, Buffer<std::uint8_t>& flags) const;

 private:
  NeighbourTable neighbours_;
  Buffer<double> own_;  ///< mean distance of each point's neighbours
  double spacing_ = 0.0;
  double usual_ = 0.0;  ///< the median of own_
};

}  // namespace batten
