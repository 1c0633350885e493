#include "batten/energy/congruence.h"

#include "batten/energy/matrix_rows.h"

namespace batten {

EnergyMatrix congruence(const EnergyMatrix& form, const EnergyMatrix& map) {
  struct Scratch {
    RowSum row;
  };
  const EnergyMatrix transposed = map.transpose();
  const auto count = static_cast<Index>(map.cols());
  return matrix_of_rows<Scratch>(
      count, count, [&] { return std::make_unique<Scratch>(Scratch{RowSum(count)}); },
      [&](Index row, Scratch& scratch) {
        scratch.row.add(std::span<const Index>(&row, 1), [](Index) { return 0.0; });
        for (EnergyMatrix::InnerIterator left(transposed, row); left; ++left) {
          for (EnergyMatrix::InnerIterator entry(form, left.col()); entry; ++entry) {
            const double weight = left.value() * entry.value();
            const int begin = map.outerIndexPtr()[entry.col()];
            const auto size = static_cast<std::size_t>(map.outerIndexPtr()[entry.col() + 1] - begin);
            const double* const values = map.valuePtr() + begin;
            scratch.row.add(std::span<const Index>(map.innerIndexPtr() + begin, size),
                            [&](Index j) { return weight * values[j]; });
          }
        }
      },
      {});
}

}  // namespace batten
