#include "batten/tessellate/piece_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "batten/limit/vertex_limit.h"
#include "batten/patch/corner_parameters.h"

namespace batten {

namespace {

/// out[i] = origin + sum over four terms of weight[j * weight_stride] * in[j * stride + i].
template <typename Scalar>
void combine_four(Scalar* __restrict out, Scalar origin, const Scalar* weight, std::ptrdiff_t weight_stride,
                  const Scalar* __restrict in, std::ptrdiff_t stride, std::ptrdiff_t count) {
  const Scalar w0 = weight[0];
  const Scalar w1 = weight[weight_stride];
  const Scalar w2 = weight[2 * weight_stride];
  const Scalar w3 = weight[3 * weight_stride];
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    out[i] = origin + ((w0 * in[i] + w3 * in[3 * stride + i]) + (w1 * in[stride + i] + w2 * in[2 * stride + i]));
  }
}

template <typename Scalar>
constexpr std::ptrdiff_t kSumLanes = std::min<std::ptrdiff_t>(kGridLanes,
                                                              kSumVectors* kVectorBytes /
                                                                  static_cast<std::ptrdiff_t>(sizeof(Scalar)));

/// out[c][i] = origin[c] + sum over j of control[j * columns + first + c] * weights[j * stride + i]; out planes are
/// `stride` apart.
template <int C, typename Scalar>
void combine_many(Scalar* __restrict out, const Scalar* origin, const Scalar* control, int count, int columns,
                  const Scalar* __restrict weights, std::ptrdiff_t stride) {
  constexpr std::ptrdiff_t kLanes = kSumLanes<Scalar>;
  for (std::ptrdiff_t first = 0; first < stride; first += kLanes) {
    Scalar sum[C][kLanes] = {};
    for (int j = 0; j < count; ++j) {
      const Scalar* row = weights + j * stride + first;
      for (int c = 0; c < C; ++c) {
        const Scalar weight = control[j * columns + c];
        for (std::ptrdiff_t i = 0; i < kLanes; ++i) sum[c][i] += weight * row[i];
      }
    }
    for (int c = 0; c < C; ++c) {
      for (std::ptrdiff_t i = 0; i < kLanes; ++i) out[c * stride + first + i] = origin[c] + sum[c][i];
    }
  }
}

/// out: the given rows less the origin, where they are not missing. K is the number of columns, 0 when it is known only
/// at run time. False when a row is missing.
template <int K, typename Scalar>
bool gather_rows(const double* values, std::ptrdiff_t stride, const Index* rows, int count, int columns,
                 const Scalar* origin, Scalar* __restrict out) {
  const int k = K > 0 ? K : columns;
  bool complete = true;
  for (int i = 0; i < count; ++i, out += k) {
    if (rows[i] == RegularPatch::kMissing) {
      complete = false;
      continue;
    }
    const double* from = values + rows[i] * stride;
    for (int c = 0; c < k; ++c) out[c] = static_cast<Scalar>(from[c] - origin[c]);
  }
  return complete;
}

/// Tangents of any length will do, but their products must not leave the range of Scalar.
template <typename Scalar>
void scale_to_one(Scalar* control, const Index* rows, int count, int columns) {
  Scalar most = 0;
  for (int i = 0; i < count; ++i) {
    if (rows[i] == RegularPatch::kMissing) continue;
    for (int c = 0; c < columns; ++c) most = std::max(most, std::abs(control[i * columns + c]));
  }
  if (most < std::numeric_limits<Scalar>::min()) return;
  const Scalar scale = Scalar(1) / most;
  for (int i = 0; i < count * columns; ++i) control[i] *= scale;
}

}  // namespace

template <typename Scalar>
GridFiller<Scalar>::GridFiller(const Pieces& pieces, std::span<const Tables* const> tables, const LevelValues& values)
    : pieces_(pieces), tables_(tables), values_(values), quads_(pieces.scheme().kind == SchemeKind::CatmullClark) {}

/// Sums run around a point of the piece, so that rounding is in proportion to the piece. The weights of a position sum
/// to 1, those of a tangent to 0.
template <typename Scalar>
void GridFiller<Scalar>::gather(const Piece& piece, int count, int columns) {
  const auto needed = static_cast<std::size_t>(count) * static_cast<std::size_t>(columns);
  if (control_.size() < needed) control_.resize(needed);
  const Index* rows = piece.kind == Piece::Kind::Ring ? pieces_.ring(piece, scratch_ring_).data() : pieces_.rows(piece);
  ConstValuesRef values = values_.at(piece.level);
  origin_.resize(static_cast<std::size_t>(columns));
  Index middle = 0;
  while (rows[middle] == RegularPatch::kMissing) ++middle;
  for (int c = 0; c < columns; ++c) origin_[c] = static_cast<Scalar>(values(rows[middle], c));
  const double* first = values.data();
  const std::ptrdiff_t stride = values.outerStride();
  const bool complete = columns == 3
                            ? gather_rows<3>(first, stride, rows, count, columns, origin_.data(), control_.data())
                            : gather_rows<0>(first, stride, rows, count, columns, origin_.data(), control_.data());
  if (complete) return;
  complete_patch(quads_, rows, control_.data(), columns);
}

template <typename Scalar>
void GridFiller<Scalar>::turn_to_tangents(const Piece& piece, int count, int columns) {
  scale_to_one(control_.data(), pieces_.rows(piece), count, columns);
  std::fill(origin_.begin(), origin_.end(), Scalar(0));
}

/// Along u first: four curves; then every row is a sum of the four.
template <typename Scalar>
void GridFiller<Scalar>::fill_quad_patch(const Piece& piece, const typename Tables::Patch& table,
                                         PieceGrid<Scalar>& grid) {
  const int k = grid.columns;
  const std::ptrdiff_t n = table.stride;
  if (scratch_.size() < static_cast<std::size_t>(4 * n)) scratch_.resize(static_cast<std::size_t>(4 * n));
  for (int c = 0; c < k; ++c) {
    for (int curve = 0; curve < 4; ++curve) {
      combine_four(&scratch_[curve * n], Scalar(0), &control_[4 * curve * k + c], k, table.u.data(), n, n);
    }
    Scalar* out = grid.plane(c) + grid.place(piece.x, piece.y);
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      combine_four(out + j * grid.width(), origin_[c], &table.v[j], n, scratch_.data(), n, n);
    }
  }
}

/// Every point by itself, a sum over the ring.
template <typename Scalar>
void GridFiller<Scalar>::fill_points(const Piece& piece, const Scalar* weights, std::ptrdiff_t stride, int count,
                                     PieceGrid<Scalar>& grid) {
  const int k = grid.columns;
  if (scratch_.size() < static_cast<std::size_t>(3 * stride)) scratch_.resize(static_cast<std::size_t>(3 * stride));
  const std::ptrdiff_t sign = piece.turned ? -1 : 1;
  const bool whole = quads_ && piece.size == grid.steps;  // then the grid's planes are the rows of weights
  for (int first = 0; first < k;) {
    const int columns = k - first >= 3 ? 3 : 1;
    if (columns == 3) {
      combine_many<3>(whole ? grid.plane(first) : scratch_.data(), &origin_[first], &control_[first], count, k, weights,
                      stride);
    } else {
      combine_many<1>(whole ? grid.plane(first) : scratch_.data(), &origin_[first], &control_[first], count, k, weights,
                      stride);
    }
    if (whole) {
      first += columns;
      continue;
    }
    for (int c = 0; c < columns; ++c, ++first) {
      Scalar* out = grid.plane(first) + grid.place(piece.x, piece.y);
      const Scalar* from = scratch_.data() + c * stride;
      for (Index j = 0; j <= piece.size; ++j, out += sign * grid.width()) {
        const Index length = piece.size + 1 - (quads_ ? 0 : j);
        for (Index i = 0; i < length; ++i) out[sign * i] = from[i];
        from += length;
      }
    }
  }
}

/// Beyond so many faces at a vertex its limit position is kept for the next cell.
constexpr Index kManyFaces = 16;

template <typename Scalar>
void GridFiller<Scalar>::fill_cell(const Piece& piece, TileValue value, PieceGrid<Scalar>& grid) {
  const int sign = piece.turned ? -1 : 1;
  const Topology& topology = pieces_.topology(piece.level);
  ConstValuesRef values = values_.at(piece.level);
  Index half_edge = piece.half_edge;
  const Index* rows = pieces_.rows(piece);
  const int corners = quads_ ? 4 : 3;
  for (int corner = 0; corner < corners; ++corner) {
    const std::array<double, 2> step = corner_parameters(corners, corner);
    const std::ptrdiff_t place =
        grid.place(piece.x + sign * static_cast<Index>(step[0]), piece.y + sign * static_cast<Index>(step[1]));
    if (value == TileValue::Refined) {
      for (int c = 0; c < grid.columns; ++c) grid.plane(c)[place] = static_cast<Scalar>(values(rows[corner], c));
    } else if (value == TileValue::Limit && piece.level == last_level_ && rows[corner] == last_vertex_) {
      for (int c = 0; c < grid.columns; ++c) grid.plane(c)[place] = static_cast<Scalar>(last_limit_[c]);
    } else {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(grid.columns);
      visit_vertex_limit(topology, pieces_.scheme(), value, half_edge,
                         [&](Index vertex, double weight) { sum += weight * values.row(vertex); });
      for (int c = 0; c < grid.columns; ++c) grid.plane(c)[place] = static_cast<Scalar>(sum[c]);
      if (value == TileValue::Limit && pieces_.topology(piece.level).vertex_face_count(rows[corner]) > kManyFaces) {
        last_level_ = piece.level;
        last_vertex_ = rows[corner];
        last_limit_ = sum;
      }
    }
    half_edge = topology.next(half_edge);
  }
}

template <typename Scalar>
void GridFiller<Scalar>::fill_patch(const Piece& piece, const Tables& tables, PieceGrid<Scalar>& grid) {
  const auto& patch = tables.patch(piece.size);
  if (patch.dense) {
    fill_points(piece, patch.u.data(), patch.stride, patch_size(quads_), grid);
  } else {
    fill_quad_patch(piece, patch, grid);
  }
}

template <typename Scalar>
void GridFiller<Scalar>::fill(Index face, std::span<PieceGrid<Scalar>> grids) {
  const int k = grids.front().columns;
  for (const Piece* piece = pieces_.begin(face); piece != pieces_.end(face); ++piece) {
    if (piece->kind == Piece::Kind::Cell) {
      for (std::size_t i = 0; i < grids.size(); ++i) fill_cell(*piece, tables_[i]->value(), grids[i]);
      continue;
    }
    const bool shared = piece->kind == Piece::Kind::Ring;
    const int count = shared ? tables_.front()->ring(piece->shared_ring).vertices : patch_size(quads_);
    gather(*piece, count, k);
    bool tangents = false;
    for (std::size_t i = 0; i < grids.size(); ++i) {
      const Tables& tables = *tables_[i];
      if (!tangents && is_tangent(tables.value())) {
        turn_to_tangents(*piece, count, k);
        tangents = true;
      }
      if (shared) {
        const auto& ring = tables.ring(piece->shared_ring);
        fill_points(*piece, ring.weights.data(), ring.stride, ring.vertices, grids[i]);
      } else {
        fill_patch(*piece, tables, grids[i]);
      }
    }
  }
}

template class GridFiller<float>;
template class GridFiller<double>;

}  // namespace batten
