#include "batten/volume/guarded_steps.h"

#include <algorithm>
#include <array>
#include <utility>

#include "batten/fit/point_tree.h"
#include "batten/mesh/self_intersections.h"
#include "batten/mesh/vertex_fans.h"
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

/// Marks the control points whose faces lie at triangles of the fine surface that meet, and returns how many pairs do.
std::int64_t mark_meetings(const SurfaceFitter& fitter, Buffer<std::uint8_t>& marks) {
  constexpr Index kListed = 1000;
  const Mesh control = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  const Mesh fine = surface_of_faces(fitter.topology(), fitter.scheme(), control, kMeasuredFaces);
  const Topology topology(fine);
  const SelfIntersections found = find_self_intersections(topology, fine.points, {}, kListed);
  // The fine mesh begins with the control points' own places on the surface.
  const PointTree places(Points(fine.points.topRows(fitter.topology().vertex_count())));
  for (const std::array<Index, 2>& pair : found.faces) {
    for (const Index face : pair) {
      std::array<Index, 4> near{};
      std::array<double, 4> squares{};
      const Index corner = topology.origin(topology.face_begin(face));
      places.nearest(fine.points.row(corner), 4, near.data(), squares.data());
      for (const Index vertex : near) marks[vertex] = 1;
    }
  }
  return found.count;
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

void GuardedSteps::mend() {
  constexpr int kRounds = 20;
  constexpr double kShare = 0.5;
  const Topology& topology = fitter_.topology();
  Values control = fitter_.control();
  for (int round = 0; round < kRounds; ++round) {
    Buffer<std::uint8_t> marks(static_cast<std::size_t>(topology.vertex_count()), 0);
    if (mark_meetings(fitter_, marks) == 0) break;
    const Values before = control;
    for (Index vertex = 0; vertex < topology.vertex_count(); ++vertex) {
      if (marks[vertex] == 0) continue;
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      int count = 0;
      for_each_spoke(topology, vertex, [&](Index, Index neighbour) {
        sum += before.row(neighbour);
        ++count;
      });
      if (count > 0) control.row(vertex) += kShare * (sum / count - before.row(vertex));
    }
    fitter_.move_to(control);
  }
  meetings_ = meetings_of(fitter_);
  fitter_.attach();
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
