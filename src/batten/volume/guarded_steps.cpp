#include "batten/volume/guarded_steps.h"

#include <algorithm>
#include <utility>

#include "batten/mesh/self_intersections.h"
#include "batten/volume/segment_measures.h"

namespace batten {

namespace {

/// Pairs of triangles of the surface that meet.
std::int64_t meetings_of(const SurfaceFitter& fitter) {
  constexpr std::int64_t kSearchedFaces = 20000;
  const Mesh control = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  const Mesh fine = surface_of_faces(fitter.topology(), fitter.scheme(), control, kSearchedFaces);
  return find_self_intersections(Topology(fine), fine.points).count;
}

}  // namespace

GuardedSteps::GuardedSteps(SurfaceFitter& fitter, const std::optional<VolumeGrid>& within, FrameWatcher watch)
    : fitter_(fitter), within_(within), watch_(std::move(watch)) {
  if (within_) fitter_.move_to(moved_inside(*within_, fitter_.control()));
  meetings_ = meetings_of(fitter_);
  show();
}

void GuardedSteps::show() const {
  if (watch_) watch_({fitter_.topology(), fitter_.scheme(), fitter_.control()});
}

bool GuardedSteps::take(FitStep step, int halvings) {
  constexpr double kEvenness = 100.0;
  constexpr double kMostEven = 3e-2;
  step.evenness = std::max(step.fairness, std::min(kMostEven, kEvenness * step.fairness));
  const Values before = fitter_.control();
  Values moves = fitter_.find_step(step);
  bool sound = false;
  for (int tried = 0; tried <= halvings && !sound; ++tried, moves *= 0.5) {
    // The fitter looks for folds alone: whether the surface meets itself is looked at more closely here.
    Values stepped = fitter_.stepped(before, moves, Soundness::Unfolded);
    if (within_) stepped = moved_inside(*within_, stepped);
    fitter_.move_to(stepped);
    const std::int64_t after = meetings_of(fitter_);
    sound = after == 0 || after < meetings_;
    if (sound) meetings_ = after;
  }
  if (sound) {
    show();
  } else {
    fitter_.move_to(before);
  }
  fitter_.attach();
  ++(sound ? taken_ : cut_);
  return sound;
}

Points moved_inside(const VolumeGrid& grid, const Points& points) {
  Points indices = grid.to_indices(points);
  bool moved = false;
  for (int c = 0; c < 3; ++c) {
    const double last = grid.size[c] - 0.5;
    moved = moved || indices.col(c).minCoeff() < -0.5 || indices.col(c).maxCoeff() > last;
    indices.col(c) = indices.col(c).cwiseMax(-0.5).cwiseMin(last);
  }
  // Points that are inside keep all their digits.
  return moved ? grid.to_worlds(indices) : points;
}

}  // namespace batten
