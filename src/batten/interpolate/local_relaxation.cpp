#include "batten/interpolate/local_relaxation.h"

namespace batten {

void row_residual(const LimitMatrix& matrix, Index vertex, ConstValuesRef targets, ConstValuesRef control,
                  double* residual) {
  const std::ptrdiff_t columns = targets.cols();
  const double* own = control.data() + vertex * control.outerStride();
  for (std::ptrdiff_t c = 0; c < columns; ++c) residual[c] = targets(vertex, c) - own[c];
  matrix.visit_row(vertex, [&](Index column, double weight) {
    const double* other = control.data() + column * control.outerStride();
    for (std::ptrdiff_t c = 0; c < columns; ++c) residual[c] -= weight * (other[c] - own[c]);
  });
}

void LocalRelaxation::make_room(const LocalRows& rows) {
  const auto count = static_cast<std::size_t>(rows.size());
  change_.resize(count * columns_, 0.0);
  residual_.resize(count * columns_);
  is_measured_.resize(count, 0);
  changed_.resize(count, 0);
  is_waiting_.resize(count, 0);
}

bool LocalRelaxation::solve(LocalRows& rows, std::span<const Index> changed, const LocalSystem& system,
                            std::int64_t most_steps) {
  columns_ = static_cast<std::size_t>(system.targets.cols());
  steps_ = 0;
  change_.clear();
  is_measured_.clear();
  changed_.clear();
  is_waiting_.clear();
  wave_.clear();
  next_wave_.clear();
  for (const Index v : changed) wave_.push_back(rows.place_of(v));
  make_room(rows);
  return columns_ == 3 ? relax<3>(rows, system, most_steps) : relax<0>(rows, system, most_steps);
}

template <int K>
bool LocalRelaxation::relax(LocalRows& rows, const LocalSystem& system, std::int64_t most_steps) {
  const std::size_t columns = K > 0 ? K : columns_;
  std::vector<double> own(K > 0 ? 0 : columns);
  double fixed[K > 0 ? K : 1];
  double* const miss = K > 0 ? fixed : own.data();
  for (; !wave_.empty(); wave_.swap(next_wave_), next_wave_.clear()) {
    steps_ += static_cast<std::int64_t>(wave_.size());
    if (steps_ > most_steps) return false;
    for (const Index place : wave_) {
      is_waiting_[place] = 0;
      const Index v = rows.vertex(place);
      const std::span<const LocalRows::Entry> row = rows.row(place);
      if (is_measured_[place] == 0) {
        make_room(rows);
        row_residual(rows.matrix(), v, system.targets, system.control, residual_.data() + place * columns);
        is_measured_[place] = 1;
      }
      for (std::size_t c = 0; c < columns; ++c) miss[c] = residual_[place * columns + c];
      for (const LocalRows::Entry& entry : row) {
        const double* other = change_.data() + entry.place * columns;
        for (std::size_t c = 0; c < columns; ++c) miss[c] -= entry.weight * other[c];
      }
      double square = 0.0;
      for (std::size_t c = 0; c < columns; ++c) square += miss[c] * miss[c];
      const double tolerance = system.tolerance[system.component.empty() ? 0 : system.component[v]];
      if (square <= tolerance * tolerance) continue;
      const double diagonal = rows.diagonal(place);
      if (!(diagonal > 0.0)) return false;
      changed_[place] = 1;
      for (std::size_t c = 0; c < columns; ++c) change_[place * columns + c] += miss[c] / diagonal;
      for (const LocalRows::Entry& entry : row) {
        if (is_waiting_[entry.place] != 0) continue;
        is_waiting_[entry.place] = 1;
        next_wave_.push_back(entry.place);
      }
    }
  }
  return true;
}

}  // namespace batten
