/// \file Four doubles in one register.
#pragma once
#include <cmath>

namespace batten {

/// The compiler's vector type. It holds four columns of a row, or a point and one unused number.
using Double4 = double __attribute__((vector_size(32)));

/// Of each.
inline Double4 square_roots(Double4 numbers) {
  for (int lane = 0; lane < 4; ++lane) numbers[lane] = std::sqrt(numbers[lane]);
  return numbers;
}

}  // namespace batten
