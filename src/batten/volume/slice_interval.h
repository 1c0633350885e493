/// \file What lies between two filled slices of a part.
#pragma once
#include <vector>

#include "batten/volume/slice_regions.h"

namespace batten {

/// One slice, filled.
struct FilledSlice {
  double level = 0.0;  ///< its place along the slices' normal, mm
  std::vector<SliceRegion> regions;
  Buffer<float> distances;  ///< of all regions together
};

/// The space between two neighbouring slices, or beyond the first or the last one.
class SliceInterval {
 public:
  /// Between slices[above - 1] and slices[above], where these are there: above is 0 to as many as there are. slices:
  /// two at least, on a grid of one layer; they must outlive this.
  SliceInterval(const VolumeGrid& plane, const std::vector<FilledSlice>& slices, std::ptrdiff_t above);

  /// Less than 0 inside. place: of the slices' grid.
  double value(double level, std::ptrdiff_t place) const;

 private:
  /// Regions of both slices that are joined in the space between, because they overlap.
  struct Bridge {
    std::vector<std::size_t> below;
    std::vector<std::size_t> above;
  };
  /// Regions that do not overlap, of a thin part that moves by more than its width.
  struct Passage {
    const SliceRegion* below;
    const SliceRegion* above;
    Eigen::Vector2d way;  ///< from one centre to the other, in cells

    double value(const VolumeGrid& plane, double up, std::ptrdiff_t place) const;
  };
  /// Over a region that goes on nowhere in the other slice.
  struct Cap {
    const SliceRegion* region;
    double height;  ///< a share of the way to the next slice

    double value(double away, std::ptrdiff_t place) const;
  };

  static std::vector<Bridge> bridges_between(const std::vector<SliceRegion>& below,
                                             const std::vector<SliceRegion>& above);
  static Cap cap_of(const SliceRegion& region, const FilledSlice* inner);
  void add_passages(std::vector<const SliceRegion*>& below, std::vector<const SliceRegion*>& above);
  double bridge_value(const Bridge& bridge, double up, std::ptrdiff_t place) const;

  const VolumeGrid& plane_;
  const FilledSlice* above_ = nullptr;
  const FilledSlice* below_ = nullptr;
  const FilledSlice* further_up_ = nullptr;
  const FilledSlice* further_down_ = nullptr;
  double height_ = 0.0;
  std::vector<Bridge> bridges_;
  std::vector<Passage> passages_;
  std::vector<Cap> caps_below_;
  std::vector<Cap> caps_above_;
};

}  // namespace batten
