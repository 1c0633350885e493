#include "batten/interpolate/measured_error.h"

#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

double row_error(const LimitMatrix& matrix, Index v, ConstValuesRef control, ConstValuesRef targets,
                 Buffer<double>& miss) {
  const std::ptrdiff_t columns = targets.cols();
  for (std::ptrdiff_t c = 0; c < columns; ++c) miss[c] = control(v, c) - targets(v, c);
  matrix.visit_row(v, [&](Index column, double weight) {
    for (std::ptrdiff_t c = 0; c < columns; ++c) miss[c] += weight * (control(column, c) - control(v, c));
  });
  double square = 0.0;
  for (const double part : miss) square += part * part;
  return std::sqrt(square);
}

}  // namespace

MeasuredErrors measure_errors(const LimitMatrix& matrix, ConstValuesRef control, ConstValuesRef targets,
                              const FreeBlock& block, const ErrorSummary& solved) {
  const bool skip_free = !solved.worst.empty();
  const auto measure_rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    MeasuredErrors part;
    Buffer<double> miss(static_cast<std::size_t>(targets.cols()));
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      double movement = 0.0;
      for (std::ptrdiff_t c = 0; c < targets.cols(); ++c) {
        movement += (control(v, c) - targets(v, c)) * (control(v, c) - targets(v, c));
      }
      part.movement = larger_or_nan(part.movement, movement);
      if (skip_free && block.is_free(v)) continue;
      part.errors.add({v, row_error(matrix, v, control, targets, miss)});
    }
    return part;
  };
  const auto combine = [](MeasuredErrors left, const MeasuredErrors& right) {
    left.errors.add(right.errors);
    left.movement = larger_or_nan(left.movement, right.movement);
    return left;
  };
  MeasuredErrors all = parallel_reduce(targets.rows(), MeasuredErrors(), measure_rows, combine);
  if (skip_free) all.errors.add(solved);
  all.movement = std::sqrt(all.movement);
  return all;
}

Buffer<double> row_errors(const LimitMatrix& matrix, ConstValuesRef control, ConstValuesRef targets) {
  Buffer<double> errors(static_cast<std::size_t>(targets.rows()));
  parallel_for(targets.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Buffer<double> miss(static_cast<std::size_t>(targets.cols()));
    for (auto v = static_cast<Index>(begin); v < end; ++v) errors[v] = row_error(matrix, v, control, targets, miss);
  });
  return errors;
}

}  // namespace batten
