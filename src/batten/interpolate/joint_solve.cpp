#include "batten/interpolate/joint_solve.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "batten/error.h"
#include "batten/interpolate/component_solve.h"
#include "batten/mesh/unit_scale.h"
#include "batten/refine/part_refinement.h"
#include "batten/refine/refined_values.h"

namespace batten {

namespace {

constexpr double kTwoColourableAlpha = 0.5;
/// Makes the system definite whatever the valences are, two included.
constexpr double kUnsolvableAlpha = kValenceTwoAlpha;

/// The targets' part along the null vector, which no control points reach.
Eigen::RowVectorXd null_part(const SingularComponent& component, ConstValuesRef targets) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(targets.cols());
  for (std::size_t i = 0; i < component.vertices.size(); ++i) {
    sum += component.sign[i] * targets.row(component.vertices[i]);
  }
  return sum / static_cast<double>(component.vertices.size());
}

/// The length of a null part that the tolerance makes nothing of: the component's own size counts.
double allowed_null_part(const SingularComponent& component, ConstValuesRef targets, double tolerance) {
  Values rows(static_cast<Eigen::Index>(component.vertices.size()), targets.cols());
  for (std::size_t i = 0; i < component.vertices.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = targets.row(component.vertices[i]);
  }
  if (rows.size() == 0) return 0.0;
  return std::max(tolerance * bounding_diagonal(rows), kSolverFloor * rows.cwiseAbs().maxCoeff());
}

/// A component that the method could not solve.
struct Unsolved {
  Index label;
  SingularReason reason;
  Buffer<Index> vertices;         ///< ascending
  std::vector<std::size_t> sets;  ///< those on which it failed
};

const char* const kTwoColourable =
    "every vertex has valence 3 and the edges are two-colourable; choose alpha or least squares";
const char* const kUnsolvable =
    "its equations are singular, or so near it that no method solves them; choose alpha or least squares";
const char* const kBeyondAlpha =
    "its equations are singular, or so near it that no method solves them, and alpha does not help; choose least "
    "squares, or change the mesh there";

class JointSolve {
 public:
  JointSolve(const InterpolationSystem& system, std::span<const Targets> sets, const Progress& progress)
      : system_(system), progress_(progress), takes_alpha_(system.singular().size(), 0) {
    const auto count = static_cast<double>(sets.size());
    for (const Targets& given : sets) {
      const auto place = static_cast<double>(sets_.size());
      sets_.emplace_back(system, given, rising(place / count, (place + 1.0) / count));
    }
  }

  std::vector<Interpolant> run() {
    decide_recognised();
    for (ValueSet& set : sets_) solve(set, set.targets(), set.stop, set.x, &set.report);
    for (ValueSet& set : sets_) improve(set);
    treat_unsolved();
    return finish();
  }

 private:
  const LimitMatrix& matrix() const { return damped_ ? *damped_ : system_.matrix(); }
  const Topology& topology() const { return system_.topology(); }
  double tolerance() const { return system_.options().tolerance; }
  OnSingular on_singular() const { return system_.options().on_singular; }

  /// The solvers' own fractions fall back where one takes over from another; the caller's only rise.
  Progress rising(double begin, double end) {
    if (!progress_) return {};
    return [this, begin, end](double done) {
      done_ = std::max(done_, begin + done * (end - begin));
      return progress_(done_);
    };
  }

  /// Which of the recognised components take alpha: those that any set needs it on.
  void decide_recognised() {
    for (std::size_t i = 0; i < system_.singular().size(); ++i) {
      const SingularComponent& component = system_.singular()[i];
      const Index vertex = *std::min_element(component.vertices.begin(), component.vertices.end());
      for (ValueSet& set : sets_) {
        SingularReport report{vertex, static_cast<Index>(component.vertices.size())};
        if (null_part(component, set.targets()).norm() > allowed_null_part(component, set.targets(), tolerance())) {
          if (on_singular() == OnSingular::Refuse) {
            set.refuse(vertex, component.vertices.size(), kTwoColourable);
          }
          if (on_singular() == OnSingular::LeastSquares) report.treatment = SingularTreatment::LeastSquares;
          if (on_singular() == OnSingular::Alpha) takes_alpha_[i] = 1;
        }
        set.singular.push_back(report);
      }
      if (takes_alpha_[i] != 0) act_with_alpha(component.vertices, kTwoColourableAlpha, i);
    }
    if (!vertex_alpha_.empty()) make_damped();
  }

  void act_with_alpha(const Buffer<Index>& vertices, double alpha, std::size_t entry) {
    if (vertex_alpha_.empty()) {
      vertex_alpha_.assign(static_cast<std::size_t>(topology().vertex_count()), system_.scheme().alpha);
    }
    for (const Index v : vertices) vertex_alpha_[v] = alpha;
    for (ValueSet& set : sets_) {
      set.singular[entry].treatment = SingularTreatment::Alpha;
      set.singular[entry].alpha = alpha;
    }
  }

  void make_damped() {
    damped_.emplace(topology(), system_.scheme(), LimitOptions{system_.options().masks, vertex_alpha_});
  }

  /// All that is known to be solvable, from x, which holds the targets.
  void solve(ValueSet& set, ConstValuesRef targets, const StopRule& stop, Values& x, SolveReport* report) {
    *report = system_.solve(targets, x, stop);
    const std::vector<SingularComponent>& singular = system_.singular();
    if (singular.empty()) return;
    const auto count = static_cast<std::size_t>(topology().vertex_count());
    Buffer<std::uint8_t> plain(count, 0);
    Buffer<std::uint8_t> damped(count, 0);
    Values aims = targets;
    for (std::size_t i = 0; i < singular.size(); ++i) {
      const Eigen::RowVectorXd missed = null_part(singular[i], targets);
      for (std::size_t j = 0; j < singular[i].vertices.size(); ++j) {
        const Index v = singular[i].vertices[j];
        (takes_alpha_[i] != 0 ? damped : plain)[v] = 1;
        if (takes_alpha_[i] == 0) aims.row(v) -= singular[i].sign[j] * missed;
      }
    }
    // Conjugate gradients keep to the complement of the null vector.
    solve_recognised(system_.matrix(), std::move(plain), aims, stop, x, *report);
    if (damped_) solve_recognised(*damped_, std::move(damped), targets, stop, x, *report);
    if (set.has_least_squares() && set.aims.size() == 0) set.aims = std::move(aims);
  }

  static void solve_recognised(const LimitMatrix& matrix, Buffer<std::uint8_t> unknown, ConstValuesRef targets,
                               const StopRule& stop, Values& x, SolveReport& report) {
    const FreeBlock part(matrix, std::move(unknown));
    if (part.free_count() > 0) append_part(report, part.solve_krylov(targets, x, stop));
  }

  std::vector<ComponentErrors> judge(const ValueSet& set, const LimitMatrix& matrix, ConstValuesRef control) const {
    const Buffer<double> errors =
        set.aims.size() > 0 ? row_errors(matrix, control, set.aims) : row_errors(matrix, control, set.targets());
    return component_errors(*system_.components(), errors, control.topRows(set.targets().rows()), set.targets());
  }

  /// Of the present x.
  const std::vector<ComponentErrors>& judge(ValueSet& set) const {
    if (set.judged.empty()) set.judged = judge(set, matrix(), set.x);
    return set.judged;
  }

  /// Solves the components that the first run left outside their own tolerance once more, each in its own coordinates.
  void improve(ValueSet& set) {
    if (is_met(set)) return;
    const std::vector<ComponentErrors> components = judge(set);
    std::vector<std::uint8_t> again(components.size(), 0);
    bool any = false;
    for (std::size_t c = 0; c < components.size(); ++c) {
      const bool hopeless = !system_.is_exhaustive() && !(components[c].error <= set.stop.tolerance);
      again[c] = !components[c].is_reached(tolerance()) && !hopeless ? 1 : 0;
      any = any || again[c] != 0;
    }
    if (!any) return;
    const Buffer<Index>& label = system_.components()->of_vertex;
    std::vector<OwnCoordinates> coordinates(components.begin(), components.end());
    Values own = Values::Zero(set.x.rows(), set.x.cols());
    for (Index v = 0; v < own.rows(); ++v) {
      if (again[label[v]] != 0) own.row(v) = coordinates[label[v]].inwards(set.targets().row(v));
    }
    Values y = own;
    SolveReport report;
    solve(set, own, own_stop_rule(system_, set), y, &report);
    const Values before = set.x;
    for (Index v = 0; v < own.rows(); ++v) {
      if (again[label[v]] == 0 || !is_solved_for(v) || !y.row(v).allFinite()) continue;
      set.x.row(v) = coordinates[label[v]].outwards(y.row(v));
    }
    const std::vector<ComponentErrors> after = judge(set, matrix(), set.x);
    for (Index v = 0; v < own.rows(); ++v) {
      if (!(after[label[v]].error <= components[label[v]].error)) set.x.row(v) = before.row(v);
    }
    append_again(set.report, report);
    set.forget_errors();
  }

  bool is_solved_for(Index v) const { return system_.is_unknown(v) || system_.matrix().row_kind(v) == LimitRow::Curve; }

  /// The common case, told without a look at each component.
  bool is_met(ValueSet& set) const {
    if (!set.report.converged || !set.singular.empty() || system_.components()->count > 1) return false;
    set.measured = measure_errors(matrix(), set.x, set.targets(), system_.block(), set.report.errors);
    return max_error(*set.measured) <= tolerance() * set.diagonal;
  }

  static double max_error(const MeasuredErrors& measured) {
    return measured.errors.worst.empty() ? 0.0 : measured.errors.worst.front().error;
  }

  bool is_recognised(Index label) const {
    const Buffer<Index>& labels = system_.components()->of_vertex;
    const auto& all = system_.singular();
    return std::any_of(all.begin(), all.end(),
                       [&](const SingularComponent& one) { return labels[one.vertices.front()] == label; });
  }

  Buffer<Index> vertices_of(Index label) const {
    Buffer<Index> vertices;
    const Buffer<Index>& labels = system_.components()->of_vertex;
    for (Index v = 0; v < topology().vertex_count(); ++v) {
      if (labels[v] == label) vertices.push_back(v);
    }
    return vertices;
  }

  /// The components that are outside their tolerance still. Where the method can tell that from a slow iteration, each
  /// gets a last chance by itself: another one may have spoilt it.
  void find_unsolved(std::size_t place, std::vector<Unsolved>& unsolved) {
    ValueSet& set = sets_[place];
    if (set.measured && max_error(*set.measured) <= tolerance() * set.diagonal) return;
    const std::vector<ComponentErrors> components = judge(set);
    for (Index c = 0; c < static_cast<Index>(components.size()); ++c) {
      const ComponentErrors& component = components[static_cast<std::size_t>(c)];
      if (component.is_reached(tolerance()) || component.is_rounding() || is_recognised(c)) continue;
      Buffer<Index> vertices = vertices_of(c);
      const bool valence_two = has_valence_two(system_.matrix(), vertices);
      if (!system_.is_exhaustive() && !(valence_two && on_singular() == OnSingular::Alpha)) continue;
      if (system_.is_exhaustive()) {
        if (ComponentSolve(system_, set, vertices).solve(system_.matrix(), set)) continue;
      }
      const SingularReason reason = valence_two ? SingularReason::ValenceTwo : SingularReason::Unsolvable;
      const auto known =
          std::find_if(unsolved.begin(), unsolved.end(), [c](const Unsolved& u) { return u.label == c; });
      if (known == unsolved.end()) {
        unsolved.push_back({c, reason, std::move(vertices), {place}});
      } else {
        known->sets.push_back(place);
      }
    }
  }

  void treat_unsolved() {
    std::vector<Unsolved> unsolved;
    for (std::size_t i = 0; i < sets_.size(); ++i) find_unsolved(i, unsolved);
    if (unsolved.empty()) return;
    for (const Unsolved& component : unsolved) {
      const Index vertex = component.vertices.front();
      for (ValueSet& set : sets_) {
        set.singular.push_back({vertex, static_cast<Index>(component.vertices.size()), component.reason});
        set.forget_errors();
      }
      switch (on_singular()) {
        case OnSingular::Refuse:
          sets_[component.sets.front()].refuse(vertex, component.vertices.size(), kUnsolvable);
        case OnSingular::LeastSquares:
          for (const std::size_t place : component.sets) {
            sets_[place].singular.back().treatment = SingularTreatment::LeastSquares;
            ComponentSolve(system_, sets_[place], component.vertices).miss_least(sets_[place]);
          }
          break;
        case OnSingular::Alpha:
          if (system_.scheme().kind != SchemeKind::CatmullClark) {
            sets_[component.sets.front()].refuse(vertex, component.vertices.size(), kBeyondAlpha);
          }
          act_with_alpha(component.vertices, kUnsolvableAlpha, sets_.front().singular.size() - 1);
          break;
      }
    }
    if (on_singular() != OnSingular::Alpha) return;
    make_damped();
    for (ValueSet& set : sets_) {
      for (const Unsolved& component : unsolved) {
        if (ComponentSolve(system_, set, component.vertices).solve(*damped_, set) || !system_.is_exhaustive()) continue;
        set.refuse(component.vertices.front(), component.vertices.size(), kBeyondAlpha);
      }
    }
  }

  std::vector<Interpolant> finish() {
    std::optional<LimitMatrix> refined;
    if (damped_) {
      const Topology whole = system_.refined(rising(1.0, 1.0));
      if (can_refine_parts()) part_ = std::make_shared<const PartRefinement>(topology(), whole, damped_faces());
      refined.emplace(part_ != nullptr ? part_->topology() : whole, system_.scheme().after_first_step(),
                      LimitOptions{system_.options().masks, {}});
    }
    const LimitMatrix& surface = refined ? *refined : system_.matrix();
    std::vector<Interpolant> results;
    for (ValueSet& set : sets_) {
      if (refined) set.forget_errors();  // what is handed out is measured itself
      results.push_back(
          {surface.topology(), surface.scheme(), refined ? refined_control(set) : std::move(set.x), {}, part_});
      Interpolant& result = results.back();
      describe(set, surface, result);
      if (result.report.outcome != Outcome::NotReached) continue;
      if (!replace_diverged(set, surface, result.control, refined ? set.x : result.control)) continue;
      if (refined) result.control = refined_control(set);
      describe(set, surface, result);
    }
    return results;
  }

  Values refined_control(const ValueSet& set) const {
    Values control(refined_vertex_count(topology(), system_.scheme().kind), set.x.cols());
    if (control.size() > 0) refine_values(topology(), system_.scheme(), vertex_alpha_, set.x, control.data());
    return part_ != nullptr ? part_->choose(set.x, control) : control;
  }

  /// The faces of the components that alpha acts on.
  Buffer<std::uint8_t> damped_faces() const {
    Buffer<std::uint8_t> faces(static_cast<std::size_t>(topology().face_count()));
    for (Index f = 0; f < topology().face_count(); ++f) {
      faces[f] = vertex_alpha_[topology().origin(topology().face_begin(f))] != 0.0 ? 1 : 0;
    }
    return faces;
  }

  /// Under BoundaryRule::None the step also decides which faces are part of the surface, on all components.
  bool can_refine_parts() const {
    if (system_.options().refined == RefinedExtent::Everything) return false;
    if (system_.scheme().alpha != 0.0 || system_.scheme().boundary == BoundaryRule::None) return false;
    const Buffer<std::uint8_t> faces = damped_faces();
    return std::find(faces.begin(), faces.end(), 0) != faces.end();
  }

  /// Puts the targets into x where control points went astray. True where any had.
  bool replace_diverged(ValueSet& set, const LimitMatrix& surface, ConstValuesRef control, ValuesRef x) const {
    const std::vector<ComponentErrors> components = judge(set, surface, control);
    const Buffer<Index>& label = system_.components()->of_vertex;
    bool any = false;
    for (Index v = 0; v < topology().vertex_count(); ++v) {
      if (!components[static_cast<std::size_t>(label[v])].is_diverged()) continue;
      x.row(v) = set.targets().row(v);
      any = true;
    }
    if (!any) return false;
    set.forget_errors();
    set.report.errors = {};
    set.report.method_name += ", which diverged: the targets themselves";
    return true;
  }

  void describe(ValueSet& set, const LimitMatrix& surface, Interpolant& result) const {
    InterpolationReport& report = result.report;
    report.name = set.given->name;
    report.solve = set.report;
    if (report.solve.method_name.empty()) report.solve.method_name = method_name(SolveMethod::Auto);
    report.diagonal = set.diagonal;
    report.singular = set.singular;
    std::sort(report.singular.begin(), report.singular.end(),
              [](const SingularReport& a, const SingularReport& b) { return a.vertex < b.vertex; });
    if (!set.measured) {
      const ErrorSummary solved = damped_ ? ErrorSummary() : set.report.errors;
      set.measured = measure_errors(surface, result.control, set.targets(), system_.block(), solved);
    }
    report.worst = set.measured->errors.worst;
    report.max_error = max_error(*set.measured);
    const auto count = static_cast<double>(set.targets().rows());
    report.rms_error = count > 0.0 ? std::sqrt(set.measured->errors.squares / count) : 0.0;
    report.max_movement = set.measured->movement;
    report.outcome = outcome_of(set, surface, result.control);
    report.solve.converged = report.converged();
  }

  Outcome outcome_of(ValueSet& set, const LimitMatrix& surface, ConstValuesRef control) const {
    const bool is_one = set.singular.empty() && system_.components()->count <= 1;
    if (is_one && max_error(*set.measured) <= tolerance() * set.diagonal) return Outcome::Reached;
    Outcome outcome = set.has_least_squares() ? Outcome::LeastSquares : Outcome::Reached;
    if (set.judged.empty()) set.judged = judge(set, surface, control);
    for (const ComponentErrors& component : set.judged) {
      if (component.is_reached(tolerance())) continue;
      if (!component.is_rounding()) return Outcome::NotReached;
      if (outcome == Outcome::Reached) outcome = Outcome::Rounding;
    }
    return outcome;
  }

  const InterpolationSystem& system_;
  const Progress& progress_;
  double done_ = 0.0;
  std::vector<ValueSet> sets_;
  std::vector<std::uint8_t> takes_alpha_;  ///< of the recognised components
  std::vector<double> vertex_alpha_;       ///< empty where alpha acts nowhere but by the scheme
  std::optional<LimitMatrix> damped_;      ///< under vertex_alpha_
  std::shared_ptr<const PartRefinement> part_;
};

/// Gives what was solved for `scale` times the targets their own unit.
void unscale(double scale, Interpolant& result) {
  InterpolationReport& report = result.report;
  result.control /= scale;
  if (!result.control.allFinite())
    throw Error(ErrorCode::NotFinite, report.name + ": control points would not be finite; scale the numbers down");
  for (double* length : {&report.diagonal, &report.max_error, &report.rms_error, &report.max_movement})
    *length /= scale;
  for (RowError& row : report.worst) row.error /= scale;
  for (double& residual : report.solve.residual_history) residual /= scale;
}

}  // namespace

std::vector<Interpolant> solve_jointly(const InterpolationSystem& system, std::span<const Targets> sets,
                                       const Progress& progress) {
  std::vector<double> scales;
  for (const Targets& set : sets) scales.push_back(unit_scale(set.values));
  if (std::all_of(scales.begin(), scales.end(), [](double scale) { return scale == 1.0; }))
    return JointSolve(system, sets, progress).run();
  // Squares of these numbers leave the doubles. A power of two loses nothing on the way there and back.
  std::vector<Values> values;
  std::vector<Targets> scaled;
  values.reserve(sets.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    values.emplace_back(scales[i] * sets[i].values);
    scaled.push_back({sets[i].name, values.back()});
  }
  std::vector<Interpolant> results = JointSolve(system, scaled, progress).run();
  for (std::size_t i = 0; i < results.size(); ++i) unscale(scales[i], results[i]);
  return results;
}

}  // namespace batten
