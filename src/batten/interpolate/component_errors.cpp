#include "batten/interpolate/component_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/solve/solver.h"

namespace batten {

namespace {

constexpr double kFarthestDiagonals = 1e6;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// An error is the sum of some ten products of control points that are rounded themselves.
constexpr double kRoundings = 4.0;
/// What elimination leaves on systems that are far from singular, and some.
constexpr double kNear = 1e-12;
/// Targets are rounded; what was measured in one order of sums may come out so much larger in another.
constexpr double kTargetRounding = 1e-15;
constexpr double kMostSlack = 0.01;

}  // namespace

bool ComponentErrors::is_reached(double tolerance) const {
  const double asked = tolerance * diagonal;
  return error <= asked + std::min(kTargetRounding * largest, kMostSlack * asked);
}

bool ComponentErrors::is_rounding() const { return error <= kRoundings * kEpsilon * farthest && !is_diverged(); }

bool ComponentErrors::is_near() const { return error <= kNear * farthest; }

bool ComponentErrors::is_diverged() const {
  return !(movement <= kFarthestDiagonals * diagonal + kRoundings * kEpsilon * largest);
}

std::vector<ComponentErrors> component_errors(const Components& components, const Buffer<double>& errors,
                                              ConstValuesRef control, ConstValuesRef targets) {
  std::vector<ComponentErrors> all(static_cast<std::size_t>(components.count));
  std::vector<ValueRow> high(all.size());
  const auto count = static_cast<Index>(targets.rows());
  for (Index v = 0; v < count; ++v) {
    const auto c = static_cast<std::size_t>(components.of_vertex[v]);
    ComponentErrors& component = all[c];
    const auto target = targets.row(v);
    if (component.centre.size() == 0) {
      component.centre = target;  // the low corner until all are seen
      high[c] = target;
    }
    component.centre = component.centre.cwiseMin(target);
    high[c] = high[c].cwiseMax(target);
    component.error = larger_or_nan(component.error, errors[v]);
    component.farthest = larger_or_nan(component.farthest, control.row(v).squaredNorm());
    component.movement = larger_or_nan(component.movement, (control.row(v) - target).squaredNorm());
  }
  for (std::size_t c = 0; c < all.size(); ++c) {
    ComponentErrors& component = all[c];
    if (component.centre.size() == 0) continue;  // no columns
    component.largest = std::max(component.centre.cwiseAbs().maxCoeff(), high[c].cwiseAbs().maxCoeff());
    component.diagonal = (high[c] - component.centre).stableNorm();
    component.centre = 0.5 * component.centre + 0.5 * high[c];
    component.farthest = std::sqrt(component.farthest);
    component.movement = std::sqrt(component.movement);
  }
  return all;
}

OwnCoordinates::OwnCoordinates(const ComponentErrors& component) : centre_(component.centre) {
  constexpr int kMostExponent = 1000;  // of what the scale can be
  if (!(component.diagonal > 0.0) || !std::isfinite(component.diagonal)) return;
  int exponent = 0;
  std::frexp(component.diagonal, &exponent);
  scale_ = std::ldexp(1.0, std::min(-exponent, kMostExponent));
}

}  // namespace batten
