#include "batten/interpolate/value_set.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The largest absolute value. Throws Error(NotFinite), naming the vertex.
double largest_number(const Targets& targets) {
  const auto& values = targets.values;
  const double largest = parallel_reduce(
      values.rows(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double most = 0.0;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          for (std::ptrdiff_t c = 0; c < values.cols(); ++c) most = larger_or_nan(most, std::abs(values(i, c)));
        }
        return most;
      },
      larger_or_nan);
  if (std::isfinite(largest)) return largest;
  for (std::ptrdiff_t v = 0; v < values.rows(); ++v) {
    if (values.row(v).allFinite()) continue;
    throw Error(ErrorCode::NotFinite, targets.name + " of vertex " + std::to_string(v) +
                                          ": not a finite number; give it a value, or leave '" + targets.name +
                                          "' out");
  }
  return largest;
}

std::string component_name(Index vertex, std::size_t count) {
  return "the component of vertex " + std::to_string(vertex) + " (" + std::to_string(count) +
         (count == 1 ? " vertex)" : " vertices)");
}

}  // namespace

ValueSet::ValueSet(const InterpolationSystem& system, const Targets& given_in, const Progress& progress)
    : given(&given_in) {
  require_vertex_rows(system.topology(), targets());
  const double largest = largest_number(*given);
  diagonal = bounding_diagonal(targets());
  if (!std::isfinite(diagonal)) {
    throw Error(ErrorCode::NotFinite,
                given->name + ": numbers up to " + std::to_string(largest) + " have no finite square; scale them down");
  }
  const double floor = kSolverFloor * largest;
  stop = {std::max(system.options().tolerance * diagonal, floor), system.options().max_iterations, progress};
  x = targets();
}

bool ValueSet::has_least_squares() const {
  return std::any_of(singular.begin(), singular.end(),
                     [](const SingularReport& one) { return one.treatment == SingularTreatment::LeastSquares; });
}

void ValueSet::refuse(Index vertex, std::size_t count, const std::string& reason) const {
  const std::string& name = given->name;
  const std::string what = name == "points" || name == "targets" ? "passes through the " + name + " of "
                                                                 : "has the values '" + name + "' on ";
  throw Error(ErrorCode::SingularSystem, "no surface " + what + component_name(vertex, count) + ": " + reason);
}

}  // namespace batten
