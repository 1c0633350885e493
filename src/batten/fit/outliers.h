/// \file Points that a surface shall not follow.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/fit/point_tree.h"

namespace batten {

/// The neighbours that the functions below judge a point by.
inline constexpr Index kCloudNeighbours = 12;

/// The mean distance of each point's nearest few.
Scalars spacing_of(const NeighbourTable& neighbours, Index size);

/// The median distance between neighbouring points of a large cloud, estimated around 200 of them. reach: some
/// spacings; no more than a sphere of that radius is looked at around each. Where points are no more than 20,000 all
/// are taken. O(N).
double sampled_spacing(const Points& points, double reach);

/// Judges points by their neighbours, built once for a cloud. Memory: 200 bytes a point.
class OutlierFilter {
 public:
  /// O(N log N).
  explicit OutlierFilter(const Points& points, const Progress& progress = {});

  /// The median distance between neighbouring points.
  double spacing() const { return spacing_; }

  /// One flag a point, 1 for those that are much farther from their neighbours than those are from theirs, and those
  /// that are far from everything and not in one plane with what is around them. Others may become lonely once they are
  /// gone: three rounds.
  const Buffer<std::uint8_t>& lonely() const { return lonely_; }

  /// Any of them.
  bool has_lonely() const;
  /// The lonely ones that are more than one and a half spacings from a surface.
  Buffer<std::uint8_t> lonely_and_far(const Scalars& distances) const;

  /// Adds those whose distance from a surface is eight times the median of their neighbours', and above one and a half
  /// spacings: a part of the shape that the surface has not reached is far as a whole. Lonely neighbours do not count.
  void add_far(const Scalars& distances, Buffer<std::uint8_t>& flags) const;

  /// belonging() of these points, N, of which `far` are outliers for sure. offsets: N-by-3, from a surface.
  Scalars belonging_to(const Buffer<std::uint8_t>& far, const Points& offsets) const;

  /// The same for all points of a cloud from which this filter's points were thinned, by the neighbours that they have
  /// among those: flags points more than one and a half `spacing` (of all) away whose nearest point here is lonely, or
  /// that are eight times as far as the median of their neighbours here and of those in the whole cloud.
  /// distances: of all; own: of this filter's points.
  Buffer<std::uint8_t> far_of(const Points& all, const Scalars& distances, const Scalars& own, double spacing) const;

 private:
  void find_lonely(const Points& points);
  void leave_far_parts(const Points& all, const Scalars& distances, Buffer<std::uint8_t>& flags) const;

  PointTree tree_;
  NeighbourTable neighbours_;
  Buffer<std::uint8_t> lonely_;
  double spacing_ = 0.0;
};

}  // namespace batten
