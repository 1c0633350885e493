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

/// Triangles of the surface that meet, of which `listed` pairs are named; the surface has so many faces.
struct Meetings {
  Mesh fine;
  SelfIntersections found;
};

Meetings find_meetings(const SurfaceFitter& fitter, std::int64_t faces, Index listed) {
  const Mesh control = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  Mesh fine = surface_of_faces(fitter.topology(), fitter.scheme(), control, faces);
  SelfIntersections found = find_self_intersections(Topology(fine), fine.points, {}, listed);
  return {std::move(fine), std::move(found)};
}

/// Pairs of triangles that meet where each step looks.
std::int64_t meetings_of(const SurfaceFitter& fitter) {
  constexpr std::int64_t kSearchedFaces = 20000;
  return find_meetings(fitter, kSearchedFaces, 0).found.count;
}

/// The control points beside triangles that meet, one flag each.
Buffer<std::uint8_t> beside_meetings(const Meetings& meetings, Index count) {
  Buffer<std::uint8_t> marks(static_cast<std::size_t>(count), 0);
  // The fine mesh begins with the control points' own places on the surface.
  const PointTree places(Points(meetings.fine.points.topRows(count)));
  for (const std::array<Index, 2>& pair : meetings.found.faces) {
    for (const Index face : pair) {
      std::array<Index, 4> near{};
      std::array<double, 4> squares{};
      const Index corner = meetings.fine.face_vertices[meetings.fine.face_offsets[face]];
      const Index found = places.nearest(meetings.fine.points.row(corner), 4, near.data(), squares.data());
      for (Index k = 0; k < found; ++k) marks[near[k]] = 1;
    }
  }
  return marks;
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
  constexpr Index kListed = 1000;
  constexpr double kShare = 0.5;
  const Topology& topology = fitter_.topology();
  bool mended = false;
  for (int round = 0; round < kRounds; ++round) {
    const Meetings meetings = find_meetings(fitter_, kMeasuredFaces, kListed);
    if (meetings.found.count == 0) break;
    const Buffer<std::uint8_t> marks = beside_meetings(meetings, topology.vertex_count());
    const Values before = fitter_.control();
    Values control = before;
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
    mended = true;
  }
  if (!mended) return;
  meetings_ = meetings_of(fitter_);
  fitter_.attach();
  show();
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
