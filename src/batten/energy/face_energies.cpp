#include "batten/energy/face_energies.h"

#include <algorithm>

#include "batten/energy/level_sums.h"
#include "batten/energy/regular_energies.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

using Eigen::MatrixXd;

constexpr std::array<EnergyKind, 3> kKinds{EnergyKind::Mass, EnergyKind::Membrane, EnergyKind::ThinPlate};
constexpr Index kNone = -1;

MatrixXd symmetric_part(const MatrixXd& matrix) { return 0.5 * (matrix + matrix.transpose()); }

/// R^T K R.
MatrixXd pulled_back(const MatrixXd& matrix, const MatrixXd& rows) { return rows.transpose() * matrix * rows; }

/// Works out the energies of ring types, children before their parents.
class RingEnergyBuilder {
 public:
  RingEnergyBuilder(bool quads, const RingTypes& types) : types_(types) {
    const auto count = static_cast<std::size_t>(types.type_count());
    energies_.resize(count);
    places_.resize(count);
    waves_of_.assign(count, kNone);
    for (Index type = 0; type < types.type_count(); ++type) visit(type);
    for (const EnergyKind kind : kKinds) regular_[static_cast<std::size_t>(kind)] = regular_energy(quads, kind);
  }

  void sum_levels(EnergyKind kind);
  void cut_off_levels(EnergyKind kind, int levels);
  std::vector<FaceEnergy> take() { return std::move(energies_); }

 private:
  void visit(Index type);
  void find_points(Index type);
  bool mark_points(Index type, int child, Buffer<std::uint8_t>& used) const;
  MatrixXd child_rows(Index type, int child) const;
  MatrixXd sum_of_children(Index type, EnergyKind kind, Index except) const;
  const MatrixXd& matrix(Index type, EnergyKind kind) const {
    return type == RingTypes::kPatch ? regular_[static_cast<std::size_t>(kind)] : energies_[type].matrix(kind);
  }

  const RingTypes& types_;
  std::array<MatrixXd, 3> regular_;
  std::vector<FaceEnergy> energies_;
  std::vector<Buffer<Index>> places_;  ///< of each ring's points among those that count, or kNone
  Buffer<Index> waves_of_;             ///< of each type: children other than itself are in lower waves
  std::vector<std::vector<Index>> waves_;
};

void RingEnergyBuilder::visit(Index type) {
  if (waves_of_[type] != kNone) return;
  waves_of_[type] = 0;  // a child of the same type finds it
  Index wave = 0;
  for (int c = 0; c < 4; ++c) {
    const Index child = types_.child(type, c).type;
    if (child == RingTypes::kPatch || child == type) continue;
    visit(child);
    wave = std::max(wave, waves_of_[child] + 1);
  }
  waves_of_[type] = wave;
  if (waves_.size() <= static_cast<std::size_t>(wave)) waves_.resize(static_cast<std::size_t>(wave) + 1);
  waves_[wave].push_back(type);
  find_points(type);
}

/// Marks what a child's points are made of; true where something was not marked before.
bool RingEnergyBuilder::mark_points(Index type, int child, Buffer<std::uint8_t>& used) const {
  const RingTypes::Step& step = types_.step(type);
  const Buffer<Index>& rows = step.children[child];
  const Index child_type = types_.child(type, child).type;
  bool changed = false;
  for (std::size_t p = 0; p < rows.size(); ++p) {
    const bool counts =
        child_type == RingTypes::kPatch || (child_type == type ? used[p] != 0 : places_[child_type][p] != kNone);
    if (!counts) continue;
    for (Index e = step.rows.starts[rows[p]]; e < step.rows.starts[rows[p] + 1]; ++e) {
      changed = changed || used[step.rows.columns[e]] == 0;
      used[step.rows.columns[e]] = 1;
    }
  }
  return changed;
}

/// What lies beyond a sharp crease is in the ring and has no say.
void RingEnergyBuilder::find_points(Index type) {
  Buffer<std::uint8_t> used(static_cast<std::size_t>(types_.step(type).ring_size), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int c = 0; c < 4; ++c) changed = mark_points(type, c, used) || changed;
  }
  Buffer<Index>& points = energies_[type].points;
  places_[type].assign(used.size(), kNone);
  for (std::size_t p = 0; p < used.size(); ++p) {
    if (used[p] == 0) continue;
    places_[type][p] = static_cast<Index>(points.size());
    points.push_back(static_cast<Index>(p));
  }
}

/// What counts of a child's points, by what counts of the type's.
MatrixXd RingEnergyBuilder::child_rows(Index type, int child) const {
  const RingTypes::Step& step = types_.step(type);
  const Buffer<Index>& rows = step.children[child];
  const Index child_type = types_.child(type, child).type;
  const bool is_patch = child_type == RingTypes::kPatch;
  const std::size_t count = is_patch ? rows.size() : energies_[child_type].points.size();
  MatrixXd matrix =
      MatrixXd::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(energies_[type].points.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const Index row = rows[is_patch ? static_cast<Index>(i) : energies_[child_type].points[i]];
    for (Index e = step.rows.starts[row]; e < step.rows.starts[row + 1]; ++e) {
      matrix(static_cast<Eigen::Index>(i), places_[type][step.rows.columns[e]]) = step.rows.weights[e];
    }
  }
  return matrix;
}

MatrixXd RingEnergyBuilder::sum_of_children(Index type, EnergyKind kind, Index except) const {
  const auto count = static_cast<Eigen::Index>(energies_[type].points.size());
  MatrixXd sum = MatrixXd::Zero(count, count);
  for (int c = 0; c < 4; ++c) {
    const Index child = types_.child(type, c).type;
    if (child != except || child == RingTypes::kPatch) sum += pulled_back(matrix(child, kind), child_rows(type, c));
  }
  return sum;
}

void RingEnergyBuilder::sum_levels(EnergyKind kind) {
  for (const std::vector<Index>& wave : waves_) {
    parallel_for_each(static_cast<std::ptrdiff_t>(wave.size()), [&](std::ptrdiff_t i) {
      const Index type = wave[i];
      int again = 0;
      while (again < 4 && types_.child(type, again).type != type) ++again;
      const MatrixXd rest = sum_of_children(type, kind, type);
      MatrixXd& result = energies_[type].matrices[static_cast<std::size_t>(kind)];
      if (again < 4) {
        result = level_sum(kind, rest, child_rows(type, again));
      } else {
        result = child_scale(kind) * symmetric_part(rest);
        if (kind != EnergyKind::Mass) remove_constants(result);
      }
    });
  }
}

/// Starts with rings that have no energy and puts a level above them again and again.
void RingEnergyBuilder::cut_off_levels(EnergyKind kind, int levels) {
  const auto count = static_cast<std::ptrdiff_t>(energies_.size());
  std::vector<MatrixXd> next(energies_.size());
  for (FaceEnergy& energy : energies_) {
    const auto size = static_cast<Eigen::Index>(energy.points.size());
    energy.matrices[static_cast<std::size_t>(kind)] = MatrixXd::Zero(size, size);
  }
  for (int level = 0; level < levels; ++level) {
    parallel_for_each(count, [&](std::ptrdiff_t i) {
      next[i] = child_scale(kind) * symmetric_part(sum_of_children(static_cast<Index>(i), kind, kNone));
      remove_constants(next[i]);
    });
    for (std::ptrdiff_t i = 0; i < count; ++i) energies_[i].matrices[static_cast<std::size_t>(kind)].swap(next[i]);
  }
}

}  // namespace

FaceEnergy patch_energy(bool quads, const PatchLayout& layout) {
  FaceEnergy energy;
  energy.points = distinct_points(quads, layout);
  const MatrixXd points = layout_points(quads, layout);
  for (const EnergyKind kind : kKinds) {
    energy.matrices[static_cast<std::size_t>(kind)] = symmetric_part(pulled_back(regular_energy(quads, kind), points));
  }
  return energy;
}

std::vector<FaceEnergy> ring_energies(bool quads, const RingTypes& types, std::optional<int> cutoff) {
  RingEnergyBuilder builder(quads, types);
  builder.sum_levels(EnergyKind::Mass);
  builder.sum_levels(EnergyKind::Membrane);
  if (cutoff) {
    builder.cut_off_levels(EnergyKind::ThinPlate, *cutoff);
  } else {
    builder.sum_levels(EnergyKind::ThinPlate);
  }
  return builder.take();
}

}  // namespace batten
