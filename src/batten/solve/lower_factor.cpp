#include "batten/solve/lower_factor.h"

namespace batten {

void LowerFactor::solve(Buffer<Double4>& x) const {
  const auto count = static_cast<int>(x.size());
  for (int j = 0; j < count; ++j) {
    const Double4 value = x[j] / weights[starts[j]];
    x[j] = value;
    for (int e = starts[j] + 1; e < starts[j + 1]; ++e) x[rows[e]] -= weights[e] * value;
  }
  for (int j = count - 1; j >= 0; --j) {
    Double4 even = x[j];
    Double4 odd{};
    int e = starts[j] + 1;
    for (; e + 1 < starts[j + 1]; e += 2) {
      even -= weights[e] * x[rows[e]];
      odd -= weights[e + 1] * x[rows[e + 1]];
    }
    if (e < starts[j + 1]) even -= weights[e] * x[rows[e]];
    x[j] = (even + odd) / weights[starts[j]];
  }
}

}  // namespace batten
