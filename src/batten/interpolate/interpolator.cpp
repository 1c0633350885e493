#include "batten/interpolate/interpolator.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "batten/error.h"
#include "batten/interpolate/crease_curves.h"
#include "batten/interpolate/free_block.h"
#include "batten/interpolate/singular_components.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Chebyshev starts from the spectrum of regular meshes: [1/4, 9/4] on quads, [1/2, 2] on triangles (MATH 3).
constexpr double kQuadLowerBound = 0.21;
constexpr double kLoopLowerBound = 0.44;
/// Below this, conjugate gradients need fewer passes than a fixed polynomial.
constexpr double kGiveUpBelow = 0.03;
constexpr double kSingularAlpha = 0.5;

bool is_iteration(SolveMethod method) {
  return method == SolveMethod::Chebyshev || method == SolveMethod::Jacobi || method == SolveMethod::Richardson;
}

/// The largest absolute value; NaN where any number is.
double largest_number(ConstValuesRef values) {
  return parallel_reduce(
      values.rows(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double most = 0.0;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          for (std::ptrdiff_t c = 0; c < values.cols(); ++c) most = larger_or_nan(most, std::abs(values(i, c)));
        }
        return most;
      },
      larger_or_nan);
}

/// Control points of a system with a solution stay within some hundred diagonals of their targets. Where they have gone
/// farther without arriving, the system was singular, and what they hold is rounding.
constexpr double kFarthest = 1e6;

}  // namespace

struct Interpolator::Parts {
  Topology topology;
  Scheme scheme;
  InterpolateOptions options;
  LimitMatrix matrix;
  CreaseCurves curves;
  std::vector<SingularComponent> singular;
  std::unique_ptr<FreeBlock> block;
  std::unique_ptr<TiledIteration> tiles;

  Parts(const Topology& topology_in, const Scheme& scheme_in, const InterpolateOptions& options_in,
        const Progress& progress)
      : topology(topology_in),
        scheme(scheme_in),
        options(options_in),
        matrix(topology_in, scheme_in, {options_in.masks, {}}, progress_within(progress, 0.0, 0.2)),
        curves(find_crease_curves(matrix)),
        singular(find_singular_components(matrix)) {
    report_progress(progress, 0.25);
    Buffer<std::uint8_t> free(static_cast<std::size_t>(topology.vertex_count()));
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      const LimitRow row = matrix.row_kind(v);
      free[v] = row == LimitRow::Smooth || row == LimitRow::Special ? 1 : 0;
    }
    for (const Index v : curves.coupled) free[v] = 1;
    for (const SingularComponent& component : singular) {
      for (const Index v : component.vertices) free[v] = 0;
    }
    block = std::make_unique<FreeBlock>(matrix, std::move(free));
    if (wants_tiles()) tiles = std::make_unique<TiledIteration>(*block, progress_within(progress, 0.3, 1.0));
    if (tiles != nullptr && options.method == SolveMethod::Auto && tiles->overlap() > TiledIteration::kMostOverlap)
      tiles.reset();
  }

  bool wants_tiles() const {
    if (is_iteration(options.method)) return true;
    // Darts and semi-sharp surroundings make the rows unsymmetric, but their spectrum stays so near the real interval
    // that Chebyshev converges all the same; where it does not, BiCGSTAB goes on.
    return options.method == SolveMethod::Auto &&
           matrix.entry_count() <= TiledIteration::kMostEntriesPerRow * topology.vertex_count();
  }

  SolveReport iterate(SolveMethod method, ConstValuesRef targets, Values& x, const StopRule& stop) const {
    IterationOptions iteration;
    iteration.method = method;
    iteration.omega = options.omega;
    iteration.lower_bound = scheme.kind == SchemeKind::Loop ? kLoopLowerBound : kQuadLowerBound;
    iteration.give_up_below = options.method == SolveMethod::Auto ? kGiveUpBelow : 0.0;
    return tiles->solve(targets, x, iteration, stop);
  }

  SolveReport solve_block(ConstValuesRef targets, Values& x, const StopRule& stop) const {
    SolveReport report;
    report.converged = true;
    if (block->free_count() == 0) return report;
    if (options.method == SolveMethod::Direct) return block->solve_direct(targets, x, stop);
    if (is_iteration(options.method)) return iterate(options.method, targets, x, stop);
    if (options.method == SolveMethod::ConjugateGradient) return block->solve_krylov(targets, x, stop);
    const Values start = x;
    if (tiles != nullptr) {
      report = iterate(SolveMethod::Chebyshev, targets, x, stop);
      if (report.converged) return report;
      if (!x.allFinite()) x = start;
    }
    report.append(block->solve_krylov(targets, x, stop), ", then ");
    if (!report.converged) {
      x = start;
      report.append(block->solve_direct(targets, x, stop), ", then ");
    }
    return report;
  }

  std::string component_name(const SingularComponent& component) const {
    return "the component of vertex " + std::to_string(component.vertices.front()) + " (" +
           std::to_string(component.vertices.size()) + " vertices)";
  }

  /// The targets' part along the null vector, which no control points reach.
  Eigen::RowVectorXd null_part(const SingularComponent& component, ConstValuesRef targets) const {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(targets.cols());
    for (std::size_t i = 0; i < component.vertices.size(); ++i) {
      sum += component.sign[i] * targets.row(component.vertices[i]);
    }
    return sum / static_cast<double>(component.vertices.size());
  }

  /// One component after the other; all are small in practice, and conjugate gradients keep to the complement of the
  /// null vector.
  void solve_singular(ConstValuesRef targets, const StopRule& stop, Interpolant& result) const {
    Values aims = targets;
    Buffer<std::uint8_t> plain(static_cast<std::size_t>(topology.vertex_count()), 0);
    Buffer<std::uint8_t> damped(static_cast<std::size_t>(topology.vertex_count()), 0);
    for (const SingularComponent& component : singular) {
      const Eigen::RowVectorXd missed = null_part(component, targets);
      bool alpha = false;
      if (missed.norm() > stop.tolerance) {
        if (options.on_singular == OnSingular::Refuse) {
          throw Error(
              ErrorCode::SingularSystem,
              "no surface passes through these targets on " + component_name(component) +
                  ": every vertex has valence 3 and the edges are two-colourable; choose alpha or least squares " +
                  "(--on-singular alpha|least-squares)");
        }
        alpha = options.on_singular == OnSingular::Alpha;
      }
      for (std::size_t i = 0; i < component.vertices.size(); ++i) {
        const Index v = component.vertices[i];
        (alpha ? damped : plain)[v] = 1;
        if (!alpha) aims.row(v) -= component.sign[i] * missed;
      }
    }
    solve_part(matrix, std::move(plain), aims, stop, result);
    solve_with_alpha(damped, kSingularAlpha, targets, stop, result);
  }

  static void solve_part(const LimitMatrix& a, Buffer<std::uint8_t> free, ConstValuesRef targets, const StopRule& stop,
                         Interpolant& result) {
    const FreeBlock part(a, std::move(free));
    if (part.free_count() == 0) return;
    result.report.append(part.solve_krylov(targets, result.control, stop), "; ");
  }

  void solve_with_alpha(const Buffer<std::uint8_t>& vertices, double alpha, ConstValuesRef targets,
                        const StopRule& stop, Interpolant& result) const {
    if (std::count(vertices.begin(), vertices.end(), 1) == 0) return;
    if (result.vertex_alpha.empty()) {
      result.vertex_alpha.assign(static_cast<std::size_t>(topology.vertex_count()), scheme.alpha);
    }
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (vertices[v] == 0) continue;
      result.vertex_alpha[v] = alpha;
      result.control.row(v) = targets.row(v);
    }
    const LimitMatrix damped(topology, scheme, {options.masks, result.vertex_alpha});
    solve_part(damped, vertices, targets, stop, result);
  }

  /// The block failed, and there are vertices of valence 2, where it may be singular: alpha = 1 makes it definite.
  void rescue_valence_two(ConstValuesRef targets, const StopRule& stop, Interpolant& result) const {
    const Buffer<Index> valence_two = find_valence_two_components(matrix);
    if (valence_two.empty() || options.on_singular != OnSingular::Alpha || scheme.kind == SchemeKind::Loop) return;
    Buffer<std::uint8_t> vertices(static_cast<std::size_t>(topology.vertex_count()), 0);
    for (const Index v : valence_two) vertices[v] = matrix.row_kind(v) == LimitRow::Smooth ? 1 : 0;
    solve_with_alpha(vertices, kValenceTwoAlpha, targets, stop, result);
  }

  void measure(ConstValuesRef targets, Interpolant& result) const {
    if (result.vertex_alpha.empty()) return measure_with(matrix, targets, result);
    measure_with(LimitMatrix(topology, scheme, {options.masks, result.vertex_alpha}), targets, result);
  }

  /// Row by row from the limit matrix, in double. Free rows whose errors the solver measured so already are not done
  /// again.
  void measure_with(const LimitMatrix& a, ConstValuesRef targets, Interpolant& result) const {
    const Values& control = result.control;
    const ErrorSummary& solved = result.report.errors;
    const bool skip_free = !solved.worst.empty();
    struct Measured {
      ErrorSummary errors;
      double movement = 0.0;
    };
    const auto measure_rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      Measured part;
      Buffer<double> row(static_cast<std::size_t>(control.cols()));
      for (auto v = static_cast<Index>(begin); v < end; ++v) {
        double movement = 0.0;
        for (std::ptrdiff_t c = 0; c < control.cols(); ++c) {
          movement += (control(v, c) - targets(v, c)) * (control(v, c) - targets(v, c));
        }
        part.movement = std::max(part.movement, movement);
        if (skip_free && block->is_free(v)) continue;
        for (std::ptrdiff_t c = 0; c < control.cols(); ++c) row[c] = -targets(v, c);
        a.visit_row(v, [&](Index column, double weight) {
          for (std::ptrdiff_t c = 0; c < control.cols(); ++c) row[c] += weight * control(column, c);
        });
        double square = 0.0;
        for (const double miss : row) square += miss * miss;
        part.errors.add({v, std::sqrt(square)});
      }
      return part;
    };
    const auto combine = [](Measured left, const Measured& right) {
      left.errors.add(right.errors);
      left.movement = std::max(left.movement, right.movement);
      return left;
    };
    Measured all = parallel_reduce(control.rows(), Measured(), measure_rows, combine);
    if (skip_free) all.errors.add(solved);
    result.worst = all.errors.worst;
    result.max_error = result.worst.empty() ? 0.0 : result.worst.front().error;
    result.rms_error = control.rows() > 0 ? std::sqrt(all.errors.squares / static_cast<double>(control.rows())) : 0.0;
    result.max_movement = std::sqrt(all.movement);
  }
};

Interpolator::Interpolator(const Topology& topology, const Scheme& scheme, const InterpolateOptions& options,
                           const Progress& progress)
    : parts_(std::make_unique<Parts>(topology, scheme, options, progress)) {
  if (!(options.tolerance > 0.0)) throw Error(ErrorCode::BadArgument, "the tolerance must be positive");
  if (!(options.omega > 0.0)) throw Error(ErrorCode::BadArgument, "omega must be positive");
}

Interpolator::~Interpolator() = default;
Interpolator::Interpolator(Interpolator&&) noexcept = default;

const LimitMatrix& Interpolator::limit_matrix() const { return parts_->matrix; }

Interpolant Interpolator::solve(ConstValuesRef targets, const Progress& progress) const {
  const Parts& parts = *parts_;
  require_vertex_rows(parts.topology, targets);
  const double largest = largest_number(targets);
  if (!std::isfinite(largest)) throw Error(ErrorCode::NotFinite, "the targets hold a number that is not finite");
  Interpolant result;
  result.control = targets;
  result.singular_components = static_cast<Index>(parts.singular.size());
  const double diagonal = bounding_diagonal(targets);
  // Rounding of the targets themselves is the floor of what can be asked for.
  const double floor = 1e-15 * largest;
  StopRule stop{std::max(parts.options.tolerance * diagonal, floor), parts.options.max_iterations, progress};
  parallel_for_each(static_cast<std::ptrdiff_t>(parts.curves.curves.size()),
                    [&](std::ptrdiff_t c) { solve_curve(parts.curves.curves[c], result.control); });
  try {
    result.report = parts.solve_block(targets, result.control, stop);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::SingularSystem || find_valence_two_components(parts.matrix).empty()) throw;
  }
  if (!result.report.converged) parts.rescue_valence_two(targets, stop, result);
  if (!parts.singular.empty()) parts.solve_singular(targets, stop, result);
  if (result.report.method_name.empty()) result.report.method_name = method_name(SolveMethod::Auto);
  parts.measure(targets, result);
  // Judged by what was measured over all rows, not by what the last of several solvers thought of its part.
  result.report.converged = result.max_error <= stop.tolerance + floor;
  if (!result.report.converged && !(result.max_movement <= kFarthest * diagonal)) {
    result.control = targets;
    result.report.errors = {};
    result.report.method_name += ", which diverged: the targets themselves";
    parts.measure(targets, result);
  }
  return result;
}

RefinedSurface ordinary_surface(const Topology& topology, const Scheme& scheme, const Interpolant& interpolant,
                                const Progress& progress) {
  if (interpolant.vertex_alpha.empty() && scheme.alpha == 0.0) return {topology, interpolant.control};
  Refinement step(topology, scheme, interpolant.vertex_alpha, progress_within(progress, 0.0, 0.5));
  Values refined = step.apply(interpolant.control, progress_within(progress, 0.5, 1.0));
  return {std::move(step).child(), std::move(refined)};
}

Mesh interpolate(const Mesh& mesh, const InterpolateOptions& options, const Progress& progress) {
  const Topology topology(mesh, progress_within(progress, 0.0, 0.3));
  const Scheme scheme = choose_scheme(mesh);
  const Interpolator interpolator(topology, scheme, options, progress_within(progress, 0.3, 0.7));
  const Interpolant interpolant = interpolator.solve(mesh.points, progress_within(progress, 0.7, 0.9));
  const RefinedSurface surface = ordinary_surface(topology, scheme, interpolant, progress_within(progress, 0.9, 1.0));
  if (surface.topology.vertex_count() == mesh.vertex_count()) {
    Mesh control = mesh;
    control.points = surface.values;
    return control;
  }
  Mesh control = mesh_from_topology(surface.topology);
  control.points = surface.values;
  state_scheme(scheme, control);
  return control;
}

}  // namespace batten
