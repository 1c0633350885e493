#include "batten/nearest/cell_shapes.h"

#include <algorithm>

namespace batten {

namespace {

/// Irregular faces are halved so many times before rings are left to the search.
constexpr int kRingLevels = 3;
/// Rings whose halves would have more weights a control point are left to the search before that: at a vertex of
/// valence N, N points of a half depend on all 2 N points of the ring from the second level on.
constexpr std::size_t kMostWeightsAPoint = 64;

/// The net of a patch, on those of its control points that are not missing.
template <typename Net>
SparseRows net_rows(const RegularPatch& patch) {
  std::array<std::array<double, Net::kSplinePoints>, Net::kPoints> weights{};
  for (int k = 0; k < Net::kSplinePoints; ++k) {
    if (patch.rows[k] == RegularPatch::kMissing) continue;
    std::array<Double4, 16> points{};
    points[k] = Double4{1.0, 1.0, 1.0, 1.0};
    complete_patch<Net>(patch.rows.data(), points.data());
    std::array<Double4, Net::kPoints> net;
    spline_matrix<Net>().apply(points.data(), net.data());
    for (int r = 0; r < Net::kPoints; ++r) weights[r][k] = net[r][0];
  }
  SparseRows rows;
  for (const auto& row : weights) {
    for (int k = 0; k < Net::kSplinePoints; ++k) {
      if (row[k] != 0.0) rows.add(k, row[k]);
    }
    rows.end_row();
  }
  return rows;
}

/// At least the number of weights that the product of two matrices has.
std::size_t most_weights(const SparseRows& left, const SparseRows& right, Index columns) {
  std::size_t sum = 0;
  for (Index r = 0; r < left.count(); ++r) {
    std::size_t of_row = 0;
    for (Index e = left.starts[r]; e < left.starts[r + 1]; ++e) {
      const Index row = left.columns[e];
      of_row += static_cast<std::size_t>(right.starts[row + 1] - right.starts[row]);
    }
    sum += std::min(of_row, static_cast<std::size_t>(columns));
  }
  return sum;
}

}  // namespace

template <typename Net>
CellShapes<Net>::CellShapes(const SurfacePatches& patches) {
  for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
    const auto first = static_cast<Index>(shapes_.size());
    add_regular(spline_matrix<Net>(), {}, halvings);
    regular_[halvings] = {first, static_cast<Index>(shapes_.size()) - first};
  }
  const Pieces& pieces = patches.pieces();
  for (std::size_t i = 0; i < pieces.shared_rings().size(); ++i) {
    const Pieces::SharedRing& shared = pieces.shared_rings()[i];
    const Index type = patches.ring_type(static_cast<std::int32_t>(i));
    const Index count = shared.points;
    int levels = kRingLevels;
    for (Index size = shared.size; size < (Index{1} << pieces.levels()); size *= 2) --levels;
    const auto first = static_cast<Index>(shapes_.size());
    add_ring(patches.ring_types(), type, {identity_rows(count), count}, {}, std::max(levels, 1));
    irregular_.push_back({first, static_cast<Index>(shapes_.size()) - first});
  }
}

template <typename Net>
void CellShapes<Net>::add_shape(const Placement& placement, Index type, const Matrix& matrix) {
  shapes_.push_back({placement, type, matrix.rows.count(), matrix.rows});
  most_points_ = std::max({most_points_, matrix.rows.count(), matrix.columns});
}

template <typename Net>
void CellShapes<Net>::add_regular(const SplineMatrix<Net>& matrix, const Placement& placement, int halvings) {
  if (halvings == 0) {
    shapes_.push_back({placement, RingTypes::kPatch, Net::kPoints, {}});
    regular_matrices_.push_back(matrix);
    return;
  }
  for (int child = 0; child < 4; ++child) {
    add_regular(product(half_matrix<Net>(child), matrix), placement.of(half<Net>(child)), halvings - 1);
  }
}

template <typename Net>
void CellShapes<Net>::add_ring(const RingTypes& steps, Index type, const Matrix& ring, const Placement& placement,
                               int levels) {
  const std::size_t most = kMostWeightsAPoint * static_cast<std::size_t>(ring.columns);
  for (int number = 0; number < 4 && levels > 0; ++number) {
    if (most_weights(steps.child(type, number).rows, ring.rows, ring.columns) > most) levels = 0;
  }
  if (levels == 0) {
    add_shape(placement, type, ring);
    return;
  }
  for (int number = 0; number < 4; ++number) {
    const RingTypes::Child& child = steps.child(type, number);
    Matrix part{product(child.rows, ring.rows, ring.columns), ring.columns};
    const Placement at = placement.of(half<Net>(number));
    if (child.type != RingTypes::kPatch) {
      add_ring(steps, child.type, part, at, levels - 1);
      continue;
    }
    part.rows = product(net_rows<Net>(child.patch), part.rows, ring.columns);
    add_shape(at, RingTypes::kPatch, part);
  }
}

template <typename Net>
void CellShapes<Net>::points(Index shape, const Double4* control, Double4* points) const {
  if (static_cast<std::size_t>(shape) < regular_matrices_.size()) {
    regular_matrices_[shape].apply(control, points);
    return;
  }
  combine_rows(shapes_[shape].weights, control, points);
}

[[gnu::flatten]] void combine_rows(const SparseRows& rows, const Double4* from, Double4* to) {
  for (Index r = 0; r < rows.count(); ++r) to[r] = combine(rows, r, from);
}

template <typename Net>
void ring_child_points(const RingTypes::Child& child, const Double4* ring, Double4* points) {
  combine_rows(child.rows, ring, points);
  if (child.type == RingTypes::kPatch) complete_patch<Net>(child.patch.rows.data(), points);
}

template class CellShapes<QuadNet>;
template class CellShapes<TriangleNet>;
template void ring_child_points<QuadNet>(const RingTypes::Child&, const Double4*, Double4*);
template void ring_child_points<TriangleNet>(const RingTypes::Child&, const Double4*, Double4*);

}  // namespace batten
