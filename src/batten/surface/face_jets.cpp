#include "batten/surface/face_jets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "batten/patch/halving.h"
#include "batten/patch/spline_jet.h"

namespace batten {

namespace {

/// Derivatives' weights deep down are large, and shrink on their way up only as far as they sum to zero: without this,
/// rounding would not shrink with them.
void keep_sums_zero(std::span<const JetRow> rows, FaceJet& jet) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    if (rows[r] != JetRow::Value) jet(row, 0) -= jet.row(row).sum();
  }
}

/// The weights of a patch's points.
void patch_jet_rows(bool quads, double u, double v, std::span<const JetRow> rows, FaceJet& jet) {
  JetWeights weights;
  ThirdWeights third;
  jet_weights(quads, u, v, weights);
  const std::array<double, 16>* const all[] = {&weights.value, &weights.du, &weights.dv, &weights.duu, &weights.duv,
                                               &weights.dvv,   &third.duuu, &third.duuv, &third.duvv,  &third.dvvv};
  if (std::any_of(rows.begin(), rows.end(), [](JetRow row) { return order_of(row) == 3; })) {
    third_weights(quads, u, v, third);
  }
  jet.resize(static_cast<Eigen::Index>(rows.size()), patch_size(quads));
  for (Eigen::Index r = 0; r < jet.rows(); ++r) {
    const std::array<double, 16>& row = *all[static_cast<std::size_t>(rows[static_cast<std::size_t>(r)])];
    for (Eigen::Index i = 0; i < jet.cols(); ++i) jet(r, i) = row[static_cast<std::size_t>(i)];
  }
}

/// Weights of the points of a ring's child become weights of the ring's points.
void to_ring(const RingTypes::Step& step, const Buffer<Index>& child, FaceJet& jet) {
  FaceJet of_ring = FaceJet::Zero(jet.rows(), step.ring_size);
  for (std::size_t p = 0; p < child.size(); ++p) {
    for (Index e = step.rows.starts[child[p]]; e < step.rows.starts[child[p] + 1]; ++e) {
      of_ring.col(step.rows.columns[e]) += step.rows.weights[e] * jet.col(static_cast<Eigen::Index>(p));
    }
  }
  jet.swap(of_ring);
}

}  // namespace

bool face_jet(bool quads, const RingTypes& types, Index type, double u, double v, std::span<const JetRow> rows,
              FaceJet& jet) {
  double scale = 1.0;
  std::vector<std::pair<Index, int>> path;
  while (type != RingTypes::kPatch) {
    if (path.size() == kHalvingsToVertex) return false;
    const Halving step = halve(quads, u, v);
    scale *= step.factor;
    path.emplace_back(type, step.child);
    type = types.child(type, step.child).type;
  }
  patch_jet_rows(quads, u, v, rows, jet);
  if (path.empty()) return true;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    jet.row(static_cast<Eigen::Index>(r)) *= std::pow(scale, order_of(rows[r]));
  }
  keep_sums_zero(rows, jet);
  for (std::size_t i = path.size(); i-- > 0;) {
    const RingTypes::Step& step = types.step(path[i].first);
    to_ring(step, step.children[path[i].second], jet);
    keep_sums_zero(rows, jet);
  }
  return true;
}

}  // namespace batten
