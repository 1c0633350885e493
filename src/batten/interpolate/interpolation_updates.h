/// \file A surface through targets of which a few change at a time: dragging a point, one row of a table.
///
/// What one target does to the control points falls by a constant factor a ring (3.7 on quads), so that a change needs
/// work near it alone, however large the mesh is. After any number of updates the surface is that of a whole solve.
#pragma once
#include <memory>
#include <span>

#include "batten/interpolate/interpolator.h"

namespace batten {

class UpdatedSurface;

/// What an update did. Errors are distances of limit positions from targets, measured at the end in double.
struct UpdateReport {
  bool is_local = true;    ///< false: everything was solved again, since the change, or its component, asked for that
  Index moved = 0;         ///< control points that moved
  std::int64_t steps = 0;  ///< rows of equations looked at
  double max_error = 0.0;  ///< over the vertices whose limit position may have moved (after rings: but what it missed)
  double error_bound = 0.0;            ///< no vertex of the whole mesh is farther from its target
  double max_miss = 0.0;               ///< update_within(): how far the surface leaves what it passed through before
  Index worst_miss = -1;               ///< the vertex where it does
  Index missed = 0;                    ///< vertices that it leaves by more than a solve's tolerance
  Outcome outcome = Outcome::Reached;  ///< of the solve, where everything was solved again
};

/// Targets and control points that stay together. Memory: both, and 4 bytes a vertex. Not for several threads at once.
class InterpolationUpdates {
 public:
  /// Solves for all targets, V-by-k, once, to 1/16 of the tolerance: about a third more work than
  /// Interpolator::solve(). Throws what Interpolator::solve() does.
  InterpolationUpdates(const Interpolator& interpolator, ConstValuesRef targets, const Progress& progress = {});

  /// From control points that are there already: the targets are their limit positions. O(V k).
  /// Throws Error: BadShape, NotFinite.
  static InterpolationUpdates from_control(const Interpolator& interpolator, ConstValuesRef control);

  ~InterpolationUpdates();
  InterpolationUpdates(InterpolationUpdates&&) noexcept;

  /// Targets rows[i] become values.row(i), and the surface passes through all targets again: each is met to 1/16 of the
  /// tolerance of the diagonal that its component had at the last whole solve, or to rounding.
  /// Cost: under 1 ms for one target on quads, whatever V is (docs/performance.md). Everything is solved again where
  /// the change reaches most of the mesh, and for components that are singular or refined (see OnSingular). Throws
  /// Error, and leaves everything as it was: IndexOutOfRange, BadArgument (a row twice), BadShape, NotFinite, and in a
  /// whole solve what Interpolator::solve() does.
  UpdateReport update(std::span<const Index> rows, ConstValuesRef values, const Progress& progress = {});

  /// The same, but only control points within so many rings of faces of a changed vertex move; 0: its own alone. The
  /// surface passes through the changed targets; of all surfaces that do, it has the least sum of squared distances
  /// from the others. What it misses falls by the factor of a ring with each ring more, and becomes the target there:
  /// the surface passes through targets() as before. Where nothing moves, no bit changes. Cost: elimination on the
  /// control points that may move, about 20 us for each of some thousands. Throws Error as update() does, and
  /// SingularSystem where these control points cannot meet the changed targets.
  UpdateReport update_within(int rings, std::span<const Index> rows, ConstValuesRef values,
                             const Progress& progress = {});

  const Values& targets() const;
  /// See Interpolant, whose members these are.
  const Values& control() const;
  const Topology& topology() const;
  const Scheme& scheme() const;
  /// The vertices whose control points the last update moved; all after a whole solve.
  std::span<const Index> moved() const;

 private:
  explicit InterpolationUpdates(std::unique_ptr<UpdatedSurface> state);
  std::unique_ptr<UpdatedSurface> state_;
};

}  // namespace batten
