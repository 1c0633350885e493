/// \file Steps of a fit that leave the surface sound: it neither meets itself nor leaves a box of voxels.
#pragma once
#include <cstdint>
#include <optional>

#include "batten/fit/surface_film.h"
#include "batten/fit/surface_fitter.h"
#include "batten/volume/volume.h"

namespace batten {

/// Takes one step after the other, but for those after which the surface meets itself.
class GuardedSteps {
 public:
  /// within: control points outside of its voxels, now or after a step, go to their outer faces; as the surface lies in
  /// the hull of its control points, it is inside, too. The fitter must outlive this.
  /// watch: is shown the start and the surface after each step that is taken.
  explicit GuardedSteps(SurfaceFitter& fitter, const std::optional<VolumeGrid>& within = {}, FrameWatcher watch = {});

  /// Needs SurfaceFitter::attach() first and leaves the surface attached. halvings: how often a shorter step is tried.
  /// False where the step was taken back.
  bool take(FitStep step, int halvings = 0);

  /// Looks at the finer surface that is measured in the end. Where that meets itself, between two places that steps
  /// look at, control points move towards the mean of their neighbours until it does not.
  void mend();

  /// Pairs of triangles that meet where steps look.
  std::int64_t meetings() const { return meetings_; }
  int taken() const { return taken_; }
  int cut() const { return cut_; }

 private:
  void show() const;

  SurfaceFitter& fitter_;
  std::optional<VolumeGrid> within_;
  FrameWatcher watch_;
  std::int64_t meetings_ = 0;
  int taken_ = 0;
  int cut_ = 0;
};

/// Points outside of a grid's voxels moved to the nearest place of its outer faces along its indices.
Points moved_inside(const VolumeGrid& grid, const Points& points);

}  // namespace batten
