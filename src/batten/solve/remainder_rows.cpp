#include "batten/solve/remainder_rows.h"

#include "batten/parallel/parallel.h"

namespace batten {

void RemainderRows::apply(const Values& x, Values& out, const Progress& progress) const {
  out.resize(x.rows(), x.cols());
  const Eigen::Index columns_of_x = x.cols();
  parallel_for(
      x.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t v = begin; v < end; ++v) {
          double* target = out.data() + v * columns_of_x;
          for (Eigen::Index c = 0; c < columns_of_x; ++c) target[c] = 0.0;
          for (std::size_t k = offsets[v]; k < offsets[v + 1]; ++k) {
            const double* from = x.data() + columns[k] * columns_of_x;
            for (Eigen::Index c = 0; c < columns_of_x; ++c) target[c] += weights[k] * from[c];
          }
        }
      },
      kDefaultBlock, progress);
}

}  // namespace batten
