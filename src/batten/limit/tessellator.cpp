#include "batten/limit/tessellator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <tuple>

#include "batten/error.h"
#include "batten/limit/piece_grid.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kPointsPerBlock = 16384;

bool needs_first_step(const Topology& topology, const Scheme& scheme) {
  return scheme.kind == SchemeKind::CatmullClark && (topology.uniform_face_size() != 4 || scheme.alpha > 0.0);
}

/// Where the vertices of a refined base stand.
struct Layout {
  Index steps;
  bool quads;
  std::int64_t edge_start;  ///< of the points inside edges
  std::int64_t face_start;
  std::int64_t per_edge;
  std::int64_t per_face;
  std::int64_t vertices;
  std::int64_t faces_per_face;

  Layout(const Topology& base, bool quads_in, int levels) : steps(Index{1} << levels), quads(quads_in) {
    per_edge = steps - 1;
    per_face = quads ? per_edge * per_edge : per_edge * (per_edge - 1) / 2;
    edge_start = base.vertex_count();
    face_start = edge_start + per_edge * base.edge_count();
    vertices = face_start + per_face * base.face_count();
    faces_per_face = std::int64_t{steps} * steps;
  }
  std::int64_t inside_face(Index face, Index j) const {
    const std::int64_t rows = j - 1;
    return face_start + per_face * face + (quads ? rows * per_edge : rows * per_edge - rows * (rows + 1) / 2);
  }
  /// Number of grid points in row j.
  Index row_length(Index j) const { return quads ? steps + 1 : steps + 1 - j; }
};

}  // namespace

template <typename Scalar>
struct TableCache {
  std::array<std::once_flag, 4> made;
  std::array<std::unique_ptr<PieceTables<Scalar>>, 4> tables;
};

struct Tessellator::Parts {
  const Topology& control;
  Scheme scheme;
  std::unique_ptr<Refinement> first;  ///< to the base, where the control mesh itself is not
  Pieces pieces;
  Layout layout;
  Buffer<Index> face_rank;  ///< number of drawn base faces before each; empty: all are drawn
  Index drawn_faces;
  mutable std::tuple<TableCache<float>, TableCache<double>> caches;

  Parts(const Topology& topology, const Scheme& scheme_in, int levels)
      : control(topology),
        scheme(scheme_in),
        first(needs_first_step(topology, scheme_in) ? std::make_unique<Refinement>(topology, scheme_in) : nullptr),
        pieces(base(), scheme.after_first_step(), first == nullptr ? levels : levels - 1),
        layout(base(), scheme.kind == SchemeKind::CatmullClark, pieces.levels()),
        drawn_faces(base().face_count()) {
    count_drawn_faces();
    const std::int64_t indices = layout.faces_per_face * drawn_faces * (layout.quads ? 4 : 3);
    if (layout.vertices > std::numeric_limits<Index>::max() ||
        layout.faces_per_face * drawn_faces > std::numeric_limits<Index>::max()) {
      throw Error(ErrorCode::TooLarge, std::to_string(levels) + " levels would make " +
                                           std::to_string(layout.vertices) + " vertices and " +
                                           std::to_string(indices) + " corners, more than 2^31 - 1; refine less");
    }
  }

  const Topology& base() const { return first == nullptr ? control : first->child(); }

  void count_drawn_faces() {
    const Buffer<std::uint8_t> holes = surface_holes(control, scheme);
    if (std::find(holes.begin(), holes.end(), 1) == holes.end()) return;
    drawn_faces = 0;
    for (Index f = 0; f < control.face_count(); ++f) {
      const Index children = first == nullptr ? 1 : control.face_size(f);
      for (Index c = 0; c < children; ++c) {
        face_rank.push_back(holes[f] != 0 ? -1 : drawn_faces);
        drawn_faces += holes[f] != 0 ? 0 : 1;
      }
    }
  }

  /// Made when first asked for.
  template <typename Scalar>
  const PieceTables<Scalar>& tables(TileValue value) const {
    auto& cache = std::get<TableCache<Scalar>>(caches);
    const auto place = static_cast<std::size_t>(value);
    std::call_once(cache.made[place],
                   [&] { cache.tables[place] = std::make_unique<PieceTables<Scalar>>(pieces, value); });
    return *cache.tables[place];
  }

  template <typename Scalar>
  void evaluate(ConstValuesRef control_values, bool limit, std::span<Scalar> out, std::span<Scalar> normals) const;
};

namespace {

/// Unit normals in place of the first tangent; zero where the tangents are parallel.
template <typename Scalar>
void normals_of(PieceGrid<Scalar>& u, const PieceGrid<Scalar>& v) {
  Scalar* __restrict x = u.plane(0);
  Scalar* __restrict y = u.plane(1);
  Scalar* __restrict z = u.plane(2);
  const Scalar* __restrict vx = v.plane(0);
  const Scalar* __restrict vy = v.plane(1);
  const Scalar* __restrict vz = v.plane(2);
  for (std::ptrdiff_t i = 0; i < u.plane_size(); ++i) {
    const Scalar nx = y[i] * vz[i] - z[i] * vy[i];
    const Scalar ny = z[i] * vx[i] - x[i] * vz[i];
    const Scalar nz = x[i] * vy[i] - y[i] * vx[i];
    const Scalar square = nx * nx + ny * ny + nz * nz;
    const Scalar scale = Scalar(1) / std::sqrt(std::max(square, std::numeric_limits<Scalar>::min()));
    x[i] = nx * scale;
    y[i] = ny * scale;
    z[i] = nz * scale;
  }
}

/// Copies what a face owns of its grid: inner points, an edge by the face of its lower half-edge, a vertex by the face
/// of its first.
template <typename Scalar>
class GridWriter {
 public:
  GridWriter(const Topology& base, const Layout& layout, Scalar* out) : base_(base), layout_(layout), out_(out) {}

  void write(Index face, const PieceGrid<Scalar>& grid) const {
    const Index n = layout_.steps;
    for (Index j = 1; j < n; ++j) {
      const Index inside = layout_.row_length(j) - 2;
      if (inside > 0) copy(grid, layout_.inside_face(face, j), grid.place(1, j), 1, inside);
    }
    const Index first = base_.face_begin(face);
    const Index corners = layout_.quads ? 4 : 3;
    for (Index c = 0; c < corners; ++c) {
      const Index h = first + c;
      const std::ptrdiff_t here = corner_place(c, grid);
      const std::ptrdiff_t step = (corner_place((c + 1) % corners, grid) - here) / n;
      if (base_.vertex_half_edge(base_.origin(h)) == h) copy(grid, base_.origin(h), here, 1, 1);
      if (base_.edge_half_edge(base_.edge(h)) != h) continue;
      copy(grid, layout_.edge_start + layout_.per_edge * base_.edge(h), here + step, step, n - 1);
    }
  }

 private:
  void copy(const PieceGrid<Scalar>& grid, std::int64_t vertex, std::ptrdiff_t place, std::ptrdiff_t step,
            std::ptrdiff_t count) const {
    const std::ptrdiff_t k = grid.columns;
    Scalar* __restrict to = out_ + vertex * k;
    if (k == 3 && step == 1) {
      const Scalar* __restrict x = grid.plane(0) + place;
      const Scalar* __restrict y = grid.plane(1) + place;
      const Scalar* __restrict z = grid.plane(2) + place;
      for (std::ptrdiff_t i = 0; i < count; ++i) {
        to[3 * i] = x[i];
        to[3 * i + 1] = y[i];
        to[3 * i + 2] = z[i];
      }
      return;
    }
    for (int c = 0; c < k; ++c) {
      const Scalar* from = grid.plane(c) + place;
      for (std::ptrdiff_t i = 0; i < count; ++i) to[k * i + c] = from[step * i];
    }
  }

  std::ptrdiff_t corner_place(Index corner, const PieceGrid<Scalar>& grid) const {
    const Index n = layout_.steps;
    if (layout_.quads) return grid.place(corner == 1 || corner == 2 ? n : 0, corner >= 2 ? n : 0);
    return grid.place(corner == 1 ? n : 0, corner == 2 ? n : 0);
  }

  const Topology& base_;
  const Layout& layout_;
  Scalar* out_;
};

}  // namespace

template <typename Scalar>
void Tessellator::Parts::evaluate(ConstValuesRef control_values, bool limit, std::span<Scalar> out,
                                  std::span<Scalar> normals) const {
  require_vertex_rows(control, control_values);
  const auto k = static_cast<int>(control_values.cols());
  const auto wanted = static_cast<std::size_t>(layout.vertices) * static_cast<std::size_t>(k);
  const bool with_normals = !normals.empty();
  if (out.size() != wanted || (with_normals && (k != 3 || normals.size() != wanted))) {
    throw Error(ErrorCode::BadShape, "the tessellation has " + std::to_string(layout.vertices) + " vertices of " +
                                         std::to_string(k) + " numbers; the output must have room for just these" +
                                         (with_normals ? ", and normals need three columns" : ""));
  }
  if (wanted == 0) return;
  const Values stepped = first == nullptr ? Values() : first->apply(control_values);
  const Eigen::Ref<const Values, 0, Eigen::OuterStride<>> base_values =
      first == nullptr ? Eigen::Ref<const Values, 0, Eigen::OuterStride<>>(control_values)
                       : Eigen::Ref<const Values, 0, Eigen::OuterStride<>>(stepped);
  const LevelValues values(pieces, base_values);
  const PieceTables<Scalar>& positions = tables<Scalar>(limit ? TileValue::Limit : TileValue::Refined);
  const PieceTables<Scalar>* tangent_u = with_normals ? &tables<Scalar>(TileValue::TangentU) : nullptr;
  const PieceTables<Scalar>* tangent_v = with_normals ? &tables<Scalar>(TileValue::TangentV) : nullptr;
  const std::ptrdiff_t block = std::max<std::ptrdiff_t>(1, kPointsPerBlock / layout.faces_per_face);
  parallel_for(
      base().face_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        GridFiller<Scalar> filler(pieces, positions, values);
        const GridWriter<Scalar> writer(base(), layout, out.data());
        PieceGrid<Scalar> grid(layout.steps, k);
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          filler.fill(f, grid);
          writer.write(f, grid);
        }
        if (!with_normals) return;
        GridFiller<Scalar> filler_u(pieces, *tangent_u, values);
        GridFiller<Scalar> filler_v(pieces, *tangent_v, values);
        const GridWriter<Scalar> normal_writer(base(), layout, normals.data());
        PieceGrid<Scalar> other(layout.steps, k);
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          filler_u.fill(f, grid);
          filler_v.fill(f, other);
          normals_of(grid, other);
          normal_writer.write(f, grid);
        }
      },
      block);
  for (Index v = 0; v < base().vertex_count(); ++v) {
    if (!base().is_isolated(v)) continue;
    for (int c = 0; c < k; ++c) out[static_cast<std::size_t>(v) * k + c] = static_cast<Scalar>(base_values(v, c));
    if (with_normals) std::fill_n(&normals[3 * static_cast<std::size_t>(v)], 3, Scalar(0));
  }
}

Tessellator::Tessellator(const Topology& topology, const Scheme& scheme, int levels) {
  if (levels < 1 || levels > 15) {
    throw Error(ErrorCode::BadArgument, "a tessellation has 1 to 15 levels, not " + std::to_string(levels));
  }
  parts_ = std::make_unique<Parts>(topology, scheme, levels);
}

Tessellator::~Tessellator() = default;
Tessellator::Tessellator(Tessellator&&) noexcept = default;

Index Tessellator::vertex_count() const { return static_cast<Index>(parts_->layout.vertices); }
Index Tessellator::face_count() const {
  return static_cast<Index>(parts_->layout.faces_per_face * parts_->drawn_faces);
}
Index Tessellator::face_size() const { return parts_->layout.quads ? 4 : 3; }
const Topology& Tessellator::base() const { return parts_->base(); }
Index Tessellator::steps() const { return parts_->layout.steps; }

template <typename Scalar>
void Tessellator::refined(ConstValuesRef control, std::span<Scalar> out) const {
  parts_->evaluate<Scalar>(control, false, out, {});
}

template <typename Scalar>
void Tessellator::limit(ConstValuesRef control, std::span<Scalar> out, std::span<Scalar> normals) const {
  parts_->evaluate<Scalar>(control, true, out, normals);
}

Index Tessellator::vertex(Index base_face, Index i, Index j) const {
  const Layout& layout = parts_->layout;
  const Topology& base = parts_->base();
  const Index n = layout.steps;
  const Index first = base.face_begin(base_face);
  const auto on_edge = [&](Index c, Index from_origin) {
    const Index h = first + c;
    if (from_origin == 0) return base.origin(h);
    const bool lower = base.edge_half_edge(base.edge(h)) == h;
    return static_cast<Index>(layout.edge_start + layout.per_edge * base.edge(h) +
                              (lower ? from_origin : n - from_origin) - 1);
  };
  if (layout.quads) {
    if (j == 0 && i < n) return on_edge(0, i);
    if (i == n && j < n) return on_edge(1, j);
    if (j == n && i > 0) return on_edge(2, n - i);
    if (i == 0) return on_edge(3, n - j);
  } else {
    if (j == 0 && i < n) return on_edge(0, i);
    if (i + j == n && j < n) return on_edge(1, j);
    if (i == 0) return on_edge(2, n - j);
  }
  return static_cast<Index>(layout.inside_face(base_face, j) + i - 1);
}

void Tessellator::faces(std::span<Index> out) const {
  const Layout& layout = parts_->layout;
  const Topology& base = parts_->base();
  const std::size_t per_face = static_cast<std::size_t>(layout.faces_per_face) * static_cast<std::size_t>(face_size());
  if (out.size() != per_face * static_cast<std::size_t>(parts_->drawn_faces)) {
    throw Error(ErrorCode::BadShape, "the tessellation has " + std::to_string(face_count()) + " faces of " +
                                         std::to_string(face_size()) +
                                         " vertices; the output must have room for just these");
  }
  const std::ptrdiff_t block = std::max<std::ptrdiff_t>(1, kPointsPerBlock / layout.faces_per_face);
  parallel_for(
      base.face_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Buffer<Index> low(static_cast<std::size_t>(layout.steps) + 1);
        Buffer<Index> high(low.size());
        const auto number_row = [&](Index f, Index j, Buffer<Index>& row) {
          const Index last = layout.row_length(j) - 1;
          const bool inner = j > 0 && j < layout.steps;
          row[0] = vertex(f, 0, j);
          row[last] = vertex(f, last, j);
          const auto first = static_cast<Index>(inner ? layout.inside_face(f, j) : 0);
          for (Index i = 1; i < last; ++i) row[i] = inner ? first + i - 1 : vertex(f, i, j);
        };
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          const Index rank = parts_->face_rank.empty() ? f : parts_->face_rank[f];
          if (rank < 0) continue;
          Index* to = out.data() + static_cast<std::size_t>(rank) * per_face;
          number_row(f, 0, low);
          for (Index j = 0; j < layout.steps; ++j) {
            number_row(f, j + 1, high);
            if (layout.quads) {
              for (Index i = 0; i < layout.steps; ++i, to += 4) {
                to[0] = low[i];
                to[1] = low[i + 1];
                to[2] = high[i + 1];
                to[3] = high[i];
              }
            } else {
              for (Index i = 0; i + j < layout.steps; ++i) {
                const bool turned = i + j + 1 < layout.steps;
                to[0] = low[i];
                to[1] = low[i + 1];
                to[2] = high[i];
                to += 3;
                if (!turned) continue;
                to[0] = high[i + 1];
                to[1] = high[i];
                to[2] = low[i + 1];
                to += 3;
              }
            }
            std::swap(low, high);
          }
        }
      },
      block);
}

template <typename Scalar>
Tessellation<Scalar> tessellate(const Topology& topology, const Scheme& scheme, ConstValuesRef control, int levels,
                                const TessellateOptions& options) {
  const Tessellator tessellator(topology, scheme, levels);
  Tessellation<Scalar> result;
  result.face_size = tessellator.face_size();
  const auto numbers = 3 * static_cast<std::size_t>(tessellator.vertex_count());
  if (control.cols() != 3) throw Error(ErrorCode::BadShape, "points have three columns");
  result.points.resize(numbers);
  if (options.normals) result.normals.resize(numbers);
  if (options.limit || options.normals) {
    tessellator.limit<Scalar>(control, result.points, result.normals);
  } else {
    tessellator.refined<Scalar>(control, result.points);
  }
  result.faces.resize(static_cast<std::size_t>(tessellator.face_count()) * static_cast<std::size_t>(result.face_size));
  tessellator.faces(result.faces);
  return result;
}

template void Tessellator::refined(ConstValuesRef, std::span<float>) const;
template void Tessellator::refined(ConstValuesRef, std::span<double>) const;
template void Tessellator::limit(ConstValuesRef, std::span<float>, std::span<float>) const;
template void Tessellator::limit(ConstValuesRef, std::span<double>, std::span<double>) const;
template Tessellation<float> tessellate(const Topology&, const Scheme&, ConstValuesRef, int, const TessellateOptions&);
template Tessellation<double> tessellate(const Topology&, const Scheme&, ConstValuesRef, int, const TessellateOptions&);

}  // namespace batten
