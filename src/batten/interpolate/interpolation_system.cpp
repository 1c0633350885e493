#include "batten/interpolate/interpolation_system.h"

#include <cmath>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

/// Chebyshev starts from the spectrum of regular meshes: [1/4, 9/4] on quads, [1/2, 2] on triangles.
constexpr double kQuadLowerBound = 0.21;
constexpr double kLoopLowerBound = 0.44;
/// Below this, conjugate gradients need fewer passes than a fixed polynomial.
constexpr double kGiveUpBelow = 0.03;

bool is_iteration(SolveMethod method) {
  return method == SolveMethod::Chebyshev || method == SolveMethod::Jacobi || method == SolveMethod::Richardson;
}

const InterpolateOptions& checked(const InterpolateOptions& options) {
  if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
    throw Error(ErrorCode::BadArgument, "the tolerance must be a positive number");
  }
  if (!(options.omega > 0.0) || !std::isfinite(options.omega)) {
    throw Error(ErrorCode::BadArgument, "omega must be a positive number");
  }
  if (options.max_iterations < 0) throw Error(ErrorCode::BadArgument, "max_iterations must not be negative");
  return options;
}

}  // namespace

void append_attempt(SolveReport& report, const SolveReport& next) { report.append(next, ", then "); }

void append_again(SolveReport& report, const SolveReport& next) {
  report.append(next, ", then component by component ");
  report.errors = {};  // of some unknowns only
}

void append_part(SolveReport& report, const SolveReport& next) {
  const SolveReport first = report;
  report.append(next, "; ");
  report.errors = {};  // of some unknowns only
  if (first.method_name.empty()) return;
  report.method = first.method;
  report.converged = first.converged && next.converged;
}

InterpolationSystem::InterpolationSystem(const Topology& topology, const Scheme& scheme,
                                         const InterpolateOptions& options, const Progress& progress)
    : topology_(topology),
      scheme_(scheme),
      options_(checked(options)),
      matrix_(topology, scheme, {options.masks, {}}, progress_within(progress, 0.0, 0.2)),
      curves_(find_crease_curves(matrix_)),
      singular_(find_singular_components(matrix_)) {
  report_progress(progress, 0.25);
  Buffer<std::uint8_t> free(static_cast<std::size_t>(topology.vertex_count()));
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    const LimitRow row = matrix_.row_kind(v);
    free[v] = row == LimitRow::Smooth || row == LimitRow::Special ? 1 : 0;
  }
  for (const Index v : curves_.coupled) free[v] = 1;
  for (const SingularComponent& component : singular_) {
    for (const Index v : component.vertices) free[v] = 0;
  }
  block_ = std::make_unique<FreeBlock>(matrix_, std::move(free));
  if (wants_tiles()) tiles_ = std::make_unique<TiledIteration>(*block_, progress_within(progress, 0.3, 1.0));
  if (tiles_ != nullptr && options.method == SolveMethod::Auto && tiles_->overlap() > TiledIteration::kMostOverlap)
    tiles_.reset();
}

bool InterpolationSystem::wants_tiles() const {
  if (is_iteration(options_.method)) return true;
  // Darts and semi-sharp surroundings make the rows unsymmetric, but their spectrum stays so near the real interval
  // that Chebyshev converges all the same; where it does not, BiCGSTAB goes on.
  return options_.method == SolveMethod::Auto &&
         matrix_.entry_count() <= TiledIteration::kMostEntriesPerRow * topology_.vertex_count();
}

bool InterpolationSystem::is_unknown(Index vertex) const {
  return block_->is_free(vertex) || matrix_.row_kind(vertex) == LimitRow::Smooth;
}

SolveReport InterpolationSystem::iterate(SolveMethod method, ConstValuesRef targets, Values& x,
                                         const StopRule& stop) const {
  IterationOptions iteration;
  iteration.method = method;
  iteration.omega = options_.omega;
  iteration.lower_bound = scheme_.kind == SchemeKind::Loop ? kLoopLowerBound : kQuadLowerBound;
  iteration.give_up_below = options_.method == SolveMethod::Auto ? kGiveUpBelow : 0.0;
  return tiles_->solve(targets, x, iteration, stop);
}

namespace {

/// Elimination; a matrix without pivots is a report that did not converge, and leaves x as it is.
SolveReport try_direct(const FreeBlock& block, ConstValuesRef targets, Values& x, const StopRule& stop) {
  try {
    return block.solve_direct(targets, x, stop);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::SingularSystem) throw;
    SolveReport report;
    report.method = SolveMethod::Direct;
    report.method_name = "sparse LU, which met a singular matrix";
    return report;
  }
}

/// Conjugate gradients or their like, then, if that fails, elimination from the same start.
SolveReport solve_exhaustively(const FreeBlock& block, ConstValuesRef targets, Values& x, const StopRule& stop) {
  const Values start = x;
  SolveReport report = block.solve_krylov(targets, x, stop);
  if (report.converged) return report;
  x = start;
  append_attempt(report, try_direct(block, targets, x, stop));
  return report;
}

}  // namespace

SolveReport InterpolationSystem::solve_block(ConstValuesRef targets, Values& x, const StopRule& stop) const {
  SolveReport report;
  report.converged = true;
  if (block_->free_count() == 0) return report;
  switch (options_.method) {
    case SolveMethod::Direct:
      return try_direct(*block_, targets, x, stop);
    case SolveMethod::ConjugateGradient:
    case SolveMethod::BiCgStab:
      return block_->solve_krylov(targets, x, stop);
    case SolveMethod::Auto:
      break;
    default:
      return iterate(options_.method, targets, x, stop);
  }
  if (tiles_ == nullptr) return solve_exhaustively(*block_, targets, x, stop);
  report = iterate(SolveMethod::Chebyshev, targets, x, stop);
  if (report.converged) return report;
  if (!x.allFinite()) begin(targets, x);
  StopRule rest = stop;
  rest.max_iterations -= report.iterations;
  append_attempt(report, block_->solve_krylov(targets, x, rest));
  if (report.converged) return report;
  begin(targets, x);
  append_attempt(report, try_direct(*block_, targets, x, stop));
  return report;
}

void InterpolationSystem::begin(ConstValuesRef targets, Values& x) const {
  x = targets;
  parallel_for_each(static_cast<std::ptrdiff_t>(curves_.curves.size()),
                    [&](std::ptrdiff_t c) { solve_curve(curves_.curves[c], x); });
}

SolveReport InterpolationSystem::solve(ConstValuesRef targets, Values& x, const StopRule& stop) const {
  begin(targets, x);
  return solve_block(targets, x, stop);
}

SolveReport InterpolationSystem::solve_alone(const LimitMatrix& matrix, Buffer<std::uint8_t> unknown,
                                             ConstValuesRef targets, Values& x, const StopRule& stop) const {
  const FreeBlock part(matrix, std::move(unknown));
  if (is_exhaustive()) return solve_exhaustively(part, targets, x, stop);
  return part.solve_krylov(targets, x, stop);
}

Topology InterpolationSystem::refined(const Progress& progress) const {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (refined_) return *refined_;
  }
  // Outside the lock, since the work is done by several threads; whoever comes second gets the first one's.
  const bool adds_holes = scheme_.boundary == BoundaryRule::None;
  const Topology made =
      child_topology(adds_holes ? with_surface_holes(topology_, scheme_) : topology_, scheme_, progress);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!refined_) refined_.emplace(made);
  return *refined_;
}

std::shared_ptr<const Components> InterpolationSystem::components() const {
  const std::lock_guard<std::mutex> lock(mutex_);  // no threads inside
  if (components_ == nullptr) components_ = std::make_shared<const Components>(connected_components(topology_));
  return components_;
}

}  // namespace batten
