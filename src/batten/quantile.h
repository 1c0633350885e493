/// \file The number below which a share of many numbers lies.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace batten {

/// share: 0 for the least of the numbers, 1 for the greatest; between two numbers the nearer one is taken. Changes the
/// order of `values`, which has no NaN and at least one number. O(n).
template <typename Numbers>
typename Numbers::value_type quantile(Numbers& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace batten
