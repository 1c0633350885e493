#include "batten/interpolate/component_solve.h"

#include <algorithm>

#include "batten/interpolate/least_squares.h"
#include "batten/interpolate/measured_error.h"

namespace batten {

namespace {

ComponentErrors extent(const ValueSet& set, const Buffer<Index>& vertices) {
  const Components one{Buffer<Index>(vertices.size(), 0), 1};
  Values rows(static_cast<Eigen::Index>(vertices.size()), set.x.cols());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = set.targets().row(vertices[i]);
  }
  return component_errors(one, Buffer<double>(vertices.size(), 0.0), rows, rows).front();
}

}  // namespace

ComponentSolve::ComponentSolve(const InterpolationSystem& system, const ValueSet& set, const Buffer<Index>& vertices)
    : system_(system),
      vertices_(vertices),
      coordinates_(extent(set, vertices)),
      unknown_(static_cast<std::size_t>(set.x.rows()), 0),
      targets_(Values::Zero(set.x.rows(), set.x.cols())) {
  for (const Index v : vertices) targets_.row(v) = coordinates_.inwards(set.targets().row(v));
  x_ = targets_;
  for (const Index v : vertices) {
    if (system.is_unknown(v)) {
      unknown_[v] = 1;
    } else {
      x_.row(v) = coordinates_.inwards(set.x.row(v));
    }
  }
}

void ComponentSolve::put_back(ValueSet& set) const {
  for (const Index v : vertices_) {
    if (unknown_[v] != 0 && x_.row(v).allFinite()) set.x.row(v) = coordinates_.outwards(x_.row(v));
  }
  set.forget_errors();
}

bool ComponentSolve::solve(const LimitMatrix& matrix, ValueSet& set) {
  const StopRule stop = own_stop_rule(system_, set);
  append_again(set.report, system_.solve_alone(matrix, unknown_, targets_, x_, stop));
  const Buffer<double> errors = row_errors(matrix, x_, targets_);
  const Components one{Buffer<Index>(errors.size(), 0), 1};
  const ComponentErrors reached = component_errors(one, errors, x_, targets_).front();
  const bool solved = (reached.error <= stop.tolerance || reached.is_near()) && !reached.is_diverged();
  if (solved) put_back(set);
  return solved;
}

void ComponentSolve::miss_least(ValueSet& set) {
  const SolveReport report = solve_least_squares(system_.matrix(), unknown_, targets_, x_, own_stop_rule(system_, set));
  put_back(set);
  append_again(set.report, report);
  if (!report.converged) return;
  if (set.aims.size() == 0) set.aims = set.targets();
  // What is missed by design is no error of the solution.
  const Values reached = system_.matrix().apply(x_);
  for (const Index v : vertices_) {
    if (unknown_[v] != 0) set.aims.row(v) = coordinates_.outwards(reached.row(v));
  }
}

StopRule own_stop_rule(const InterpolationSystem& system, const ValueSet& set) {
  StopRule stop = set.stop;
  stop.tolerance = OwnCoordinates::kLeastDiagonal * std::max(system.options().tolerance, kSolverFloor);
  return stop;
}

}  // namespace batten
