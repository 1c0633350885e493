#include "batten/tessellate/piece_tables.h"

#include "batten/parallel/parallel.h"
#include "batten/tessellate/piece_grid.h"

namespace batten {

namespace {

/// Point-major to weight-major with padded rows, rounded to Scalar.
template <typename Scalar>
Buffer<Scalar> transposed(const Buffer<double>& weights, std::ptrdiff_t per_point, std::ptrdiff_t stride) {
  const std::ptrdiff_t points = static_cast<std::ptrdiff_t>(weights.size()) / per_point;
  Buffer<Scalar> result(static_cast<std::size_t>(per_point * stride), Scalar(0));
  for (std::ptrdiff_t p = 0; p < points; ++p) {
    for (std::ptrdiff_t j = 0; j < per_point; ++j) {
      result[j * stride + p] = static_cast<Scalar>(weights[p * per_point + j]);
    }
  }
  return result;
}

/// Up to this size a sum of all sixteen points takes less time than two passes of four (measured: decisions 5 and 17);
/// with four floats a vector, as in WebAssembly, it takes more vectors.
constexpr int kLargestDensePatch = kVectorBytes > 16 ? 8 : 2;

/// Weights of the tensor product, point by point.
Buffer<double> product(const Buffer<double>& u, const Buffer<double>& v) {
  Buffer<double> weights;
  weights.reserve(u.size() * v.size());
  for (std::size_t j = 0; j < v.size(); j += 4) {
    for (std::size_t i = 0; i < u.size(); i += 4) {
      for (std::size_t b = 0; b < 4; ++b) {
        for (std::size_t a = 0; a < 4; ++a) weights.push_back(v[j + b] * u[i + a]);
      }
    }
  }
  return weights;
}

}  // namespace

template <typename Scalar>
typename PieceTables<Scalar>::Patches PieceTables<Scalar>::patches_of(SchemeKind kind, int levels, TileValue value) {
  const bool quads = kind == SchemeKind::CatmullClark;
  std::vector<Patch> patches;
  for (int level = 0; level <= levels; ++level) {
    const int size = 1 << level;
    Patch patch;
    if (quads) {
      const TileValue plain = value == TileValue::Refined ? TileValue::Refined : TileValue::Limit;
      const auto u = curve_weights(size, value == TileValue::TangentU ? value : plain);
      const auto v = curve_weights(size, value == TileValue::TangentV ? TileValue::TangentU : plain);
      patch.dense = size <= kLargestDensePatch;
      if (patch.dense) {
        patch.stride = padded(std::ptrdiff_t{size + 1} * (size + 1));
        patch.u = transposed<Scalar>(product(u, v), 16, patch.stride);
      } else {
        patch.stride = size + 1;
        patch.u = transposed<Scalar>(u, 4, patch.stride);
        patch.v = transposed<Scalar>(v, 4, patch.stride);
      }
    } else {
      patch.dense = true;
      patch.stride = padded(std::ptrdiff_t{size + 1} * (size + 2) / 2);
      patch.u = transposed<Scalar>(triangle_weights(size, value), kTrianglePatchSize, patch.stride);
    }
    patches.push_back(std::move(patch));
  }
  return std::make_shared<const std::vector<Patch>>(std::move(patches));
}

/// The points of the ring's face 0, once, with the one-ring's unit vectors for values.
template <typename Scalar>
typename PieceTables<Scalar>::Ring PieceTables<Scalar>::ring_of(const Pieces::SharedRing& shared, const Scheme& scheme,
                                                                const PieceTables<double>& tables) {
  int levels = 0;
  while ((Index{1} << levels) < shared.size) ++levels;
  const Pieces own(shared.topology, scheme, levels, 0);
  const Index vertices = shared.topology.vertex_count();
  const Values unit = Values::Identity(vertices, vertices);
  const LevelValues values(own, unit);
  PieceGrid<double> grid(shared.size, vertices);
  const PieceTables<double>* const kinds[] = {&tables};
  GridFiller<double>(own, kinds, values).fill(0, std::span(&grid, 1));
  const bool quads = scheme.kind == SchemeKind::CatmullClark;
  Buffer<double> weights;
  for (Index j = 0; j <= shared.size; ++j) {
    for (Index x = 0; x <= shared.size - (quads ? 0 : j); ++x) {
      for (Index k = 0; k < vertices; ++k) weights.push_back(grid.plane(k)[grid.place(x, j)]);
    }
  }
  Ring ring;
  ring.vertices = vertices;
  ring.stride = padded(static_cast<std::ptrdiff_t>(weights.size()) / vertices);
  ring.weights = transposed<Scalar>(weights, vertices, ring.stride);
  return ring;
}

template <typename Scalar>
PieceTables<Scalar>::PieceTables(const Pieces& pieces, TileValue value)
    : value_(value),
      patches_(patches_of(pieces.scheme().kind, pieces.levels(), value)),
      rings_(pieces.shared_rings().size()) {
  if (rings_.empty()) return;
  const PieceTables<double> tables(value,
                                   PieceTables<double>::patches_of(pieces.scheme().kind, pieces.levels(), value));
  parallel_for_each(static_cast<std::ptrdiff_t>(rings_.size()),
                    [&](std::ptrdiff_t i) { rings_[i] = ring_of(pieces.shared_rings()[i], pieces.scheme(), tables); });
}

template <typename Scalar>
const typename PieceTables<Scalar>::Patch& PieceTables<Scalar>::patch(Index size) const {
  return (*patches_)[static_cast<std::size_t>(__builtin_ctz(static_cast<unsigned>(size)))];
}

template class PieceTables<float>;
template class PieceTables<double>;

}  // namespace batten
