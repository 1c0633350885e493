/// \file Numbers for tests of linear operators.
#pragma once
#include <random>

#include "batten/types.h"

namespace batten::test {

/// Uniform in [-1, 1], the same at every run.
inline Values random_values(Index rows, Index columns) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Values::NullaryExpr(rows, columns, [&] { return uniform(generator); });
}

}  // namespace batten::test
