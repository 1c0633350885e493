#include "batten/mesh/checked_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

bool is_finite_row(const double* row, std::ptrdiff_t count) {
  int bad = 0;
  for (std::ptrdiff_t c = 0; c < count; ++c) bad |= std::abs(row[c]) <= std::numeric_limits<double>::max() ? 0 : 1;
  return bad == 0;
}

}  // namespace

void require_finite(ConstValuesRef values, const char* what) {
  const std::ptrdiff_t stride = values.outerStride();
  const auto first_bad = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    // Rows that follow each other are tested as one long row, which the compiler vectorises.
    const bool one = stride == values.cols();
    if (one && is_finite_row(values.data() + begin * stride, (end - begin) * stride)) return values.rows();
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      if (!is_finite_row(values.data() + row * stride, values.cols())) return row;
    }
    return values.rows();
  };
  const std::ptrdiff_t bad = parallel_reduce(values.rows(), values.rows(), first_bad,
                                             [](std::ptrdiff_t a, std::ptrdiff_t b) { return std::min(a, b); });
  if (bad == values.rows()) return;
  throw Error(ErrorCode::NotFinite, "row " + std::to_string(bad) + " of the " + what + " is not finite");
}

void require_shape(const ValuesRef& result, std::ptrdiff_t rows, std::ptrdiff_t columns) {
  if (result.rows() == rows && result.cols() == columns) return;
  throw Error(ErrorCode::BadShape, "the result has " + std::to_string(result.rows()) + " rows and " +
                                       std::to_string(result.cols()) + " columns, but must have " +
                                       std::to_string(rows) + " rows and " + std::to_string(columns) + " columns");
}

}  // namespace batten
