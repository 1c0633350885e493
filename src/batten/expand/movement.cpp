#include "batten/expand/movement.h"

#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

double root_mean(double squares, Eigen::Index count) {
  return std::sqrt(squares / std::max<double>(1.0, static_cast<double>(count)));
}

}  // namespace

Movement measure_movement(ConstValuesRef before, ConstValuesRef after) {
  struct Squares {
    double sum = 0.0;
    double most = 0.0;
    Index vertex = -1;
  };
  const auto rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Squares squares;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const double square = (after.row(v) - before.row(v)).squaredNorm();
      squares.sum += square;
      if (squares.vertex >= 0 && square <= squares.most) continue;
      squares.most = square;
      squares.vertex = static_cast<Index>(v);
    }
    return squares;
  };
  const Squares all = parallel_reduce(before.rows(), Squares(), rows, [](const Squares& a, const Squares& b) {
    const Squares& most = b.vertex >= 0 && (a.vertex < 0 || b.most > a.most) ? b : a;
    return Squares{a.sum + b.sum, most.most, most.vertex};
  });
  return {root_mean(all.sum, before.rows()), std::sqrt(all.most), all.vertex};
}

double measure_movement_along(ConstValuesRef normals, ConstValuesRef before, ConstValuesRef after) {
  const auto squares = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0.0;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const double along = (after.row(v) - before.row(v)).dot(normals.row(v));
      sum += along * along;
    }
    return sum;
  };
  return root_mean(parallel_reduce(before.rows(), 0.0, squares, [](double a, double b) { return a + b; }),
                   before.rows());
}

}  // namespace batten
