/// \file Solving A P = Q where only a few targets have changed.
///
/// Gauss-Seidel from row to row: a row whose equation is off by more than the tolerance is relaxed, and then the rows
/// that its control point is part of are looked at. So the work spreads as far as the change matters and no farther
/// (docs/decisions/012-local-updates.md). Rows of every kind are relaxed alike; curves, which no surface row acts upon,
/// settle first by themselves.
#pragma once
#include "batten/interpolate/local_rows.h"

namespace batten {

/// The equations, and how well they shall hold.
struct LocalSystem {
  ConstValuesRef targets;
  ConstValuesRef control;
  const Buffer<Index>& component;   ///< of each vertex; empty: all are of component 0
  const Buffer<double>& tolerance;  ///< of each component: the largest |Q - A P| of a row
};

/// Working memory is kept from call to call. Not for several threads at once.
class LocalRelaxation {
 public:
  /// rows: empty at first; those whose errors may have changed afterwards. most_steps: how many rows may be looked at.
  /// True where all equations around the changed vertices hold as well as asked. The control points stay as they are:
  /// what is to be added to them is change().
  bool solve(LocalRows& rows, std::span<const Index> changed, const LocalSystem& system, std::int64_t most_steps);

  /// k numbers, for the vertex rows.vertex(place).
  const double* change(Index place) const { return change_.data() + static_cast<std::size_t>(place) * columns_; }
  bool is_changed(Index place) const { return changed_[place] != 0; }
  /// Rows looked at.
  std::int64_t steps() const { return steps_; }

 private:
  template <int K>
  bool relax(LocalRows& rows, const LocalSystem& system, std::int64_t most_steps);
  /// Room for all numbers that `rows` has given out.
  void make_room(const LocalRows& rows);

  std::size_t columns_ = 0;
  std::int64_t steps_ = 0;
  std::vector<double> change_;
  std::vector<double> residual_;  ///< of the start
  std::vector<std::uint8_t> is_measured_;
  std::vector<std::uint8_t> changed_;
  std::vector<std::uint8_t> is_waiting_;
  std::vector<Index> wave_;
  std::vector<Index> next_wave_;
};

/// Q - A P of one row into `residual`, k numbers: as P - Q + sum a (P_j - P), which keeps the digits wherever the
/// origin is.
void row_residual(const LimitMatrix& matrix, Index vertex, ConstValuesRef targets, ConstValuesRef control,
                  double* residual);

}  // namespace batten
