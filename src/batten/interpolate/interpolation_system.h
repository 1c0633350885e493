/// \file What an Interpolator is built of: the limit matrix, cut into what is solved one by one.
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "batten/interpolate/crease_curves.h"
#include "batten/interpolate/free_block.h"
#include "batten/interpolate/interpolator.h"
#include "batten/interpolate/singular_components.h"

namespace batten {

/// Puts a second run's report behind a first one's of the same unknowns: `report.method` is then what solved last.
void append_attempt(SolveReport& report, const SolveReport& next);
/// Puts the report of other unknowns behind: `report.method` stays, unless nothing was solved before.
void append_part(SolveReport& report, const SolveReport& next);

/// Puts the report of some of the same unknowns behind, solved once more.
void append_again(SolveReport& report, const SolveReport& next);

/// Immutable but for what it builds when it is first asked for; safe to share.
class InterpolationSystem {
 public:
  /// Throws Error: BadArgument, NotTriangles, Cancelled.
  InterpolationSystem(const Topology& topology, const Scheme& scheme, const InterpolateOptions& options,
                      const Progress& progress);

  const Topology& topology() const { return topology_; }
  const Scheme& scheme() const { return scheme_; }
  const InterpolateOptions& options() const { return options_; }
  const LimitMatrix& matrix() const { return matrix_; }
  const FreeBlock& block() const { return *block_; }
  /// The components that are recognised as singular; their vertices are not in block().
  const std::vector<SingularComponent>& singular() const { return singular_; }

  /// True for a vertex whose control point is an unknown of a linear system, of block() or of a singular component.
  bool is_unknown(Index vertex) const;

  /// x becomes the control points, but for the vertices of singular(), which get their targets. Where block() is not
  /// solved, the report says so and x holds what the last method left.
  SolveReport solve(ConstValuesRef targets, Values& x, const StopRule& stop) const;

  /// Unknowns by themselves, under a matrix of this connectivity: conjugate gradients or their like and, if the options
  /// allow it, elimination. x: the start (known vertices hold their values) and the result.
  SolveReport solve_alone(const LimitMatrix& matrix, Buffer<std::uint8_t> unknown, ConstValuesRef targets, Values& x,
                          const StopRule& stop) const;

  /// True where the method ends with a factorisation, so that what it cannot solve is singular.
  bool is_exhaustive() const { return options_.method == SolveMethod::Auto || options_.method == SolveMethod::Direct; }

  /// The topology refined once, holes of the boundary rule included. Built when it is first asked for. O(H).
  Topology refined(const Progress& progress) const;
  /// Likewise.
  std::shared_ptr<const Components> components() const;

 private:
  bool wants_tiles() const;
  /// Where the methods start: the targets, with the curves solved.
  void begin(ConstValuesRef targets, Values& x) const;
  SolveReport iterate(SolveMethod method, ConstValuesRef targets, Values& x, const StopRule& stop) const;
  SolveReport solve_block(ConstValuesRef targets, Values& x, const StopRule& stop) const;

  Topology topology_;
  Scheme scheme_;
  InterpolateOptions options_;
  LimitMatrix matrix_;
  CurveSystems curves_;
  std::vector<SingularComponent> singular_;
  std::unique_ptr<FreeBlock> block_;
  std::unique_ptr<TiledIteration> tiles_;
  mutable std::mutex mutex_;
  mutable std::optional<Topology> refined_;
  mutable std::shared_ptr<const Components> components_;
};

}  // namespace batten
