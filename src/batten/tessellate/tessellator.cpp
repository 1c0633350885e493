#include "batten/tessellate/tessellator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/reached_faces.h"
#include "batten/progress.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refined_values.h"
#include "batten/tessellate/butterfly_grids.h"
#include "batten/tessellate/corner_tessellation.h"
#include "batten/tessellate/grid_faces.h"
#include "batten/tessellate/linear_values.h"
#include "batten/tessellate/piece_grid.h"
#include "batten/tessellate/tessellation_layout.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kPointsPerBlock = 16384;

}  // namespace

template <typename Scalar>
struct TableCache {
  std::array<std::once_flag, 4> made;
  std::array<std::unique_ptr<PieceTables<Scalar>>, 4> tables;
};

struct Tessellator::Parts {
  SurfacePatches patches;
  TessellationLayout layout;
  Buffer<Index> face_rank;  ///< number of drawn base faces before each, -1 for holes; empty: all are drawn
  Index drawn_faces;
  mutable std::once_flag cut;
  mutable std::unique_ptr<Pieces> cut_pieces;
  mutable std::tuple<TableCache<float>, TableCache<double>> caches;

  Parts(const SurfacePatches& patches_in, int levels)
      : patches(patches_in),
        layout(base(), patches.quads(), patches.has_first_step() ? levels - 1 : levels),
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

  const Topology& base() const { return patches.base(); }
  const Topology& control() const { return patches.topology(); }
  const Scheme& scheme() const { return patches.scheme(); }

  void count_drawn_faces() {
    const Buffer<std::uint8_t>& holes = patches.holes();
    if (holes.empty()) return;
    drawn_faces = 0;
    for (Index f = 0; f < base().face_count(); ++f) {
      face_rank.push_back(holes[f] != 0 ? -1 : drawn_faces);
      drawn_faces += holes[f] != 0 ? 0 : 1;
    }
  }

  /// Made when first asked for.
  const Pieces& pieces() const {
    std::call_once(cut, [&] { cut_pieces = std::make_unique<Pieces>(base(), patches.base_scheme(), layout.levels); });
    return *cut_pieces;
  }

  template <typename Scalar>
  const PieceTables<Scalar>& tables(TileValue value) const {
    auto& cache = std::get<TableCache<Scalar>>(caches);
    const auto place = static_cast<std::size_t>(value);
    std::call_once(cache.made[place],
                   [&] { cache.tables[place] = std::make_unique<PieceTables<Scalar>>(pieces(), value); });
    return *cache.tables[place];
  }

  /// One level by itself: cutting it into pieces takes longer than the rules themselves.
  bool is_one_step() const { return !patches.has_first_step() && layout.levels == 1; }

  /// use(control values of the base).
  template <typename Use>
  void with_base_values(ConstValuesRef control_values, const Use& use) const {
    if (patches.has_first_step()) return use(patches.base_values(control_values));
    use(control_values);
  }

  template <typename Scalar>
  void check_output(ConstValuesRef control_values, std::span<Scalar> out, std::span<Scalar> normals) const;
  template <typename Scalar>
  void fill_interpolating(ConstValuesRef control_values, std::span<Scalar> out, std::span<Scalar> normals,
                          const Progress& progress) const;
  /// A vertex of the control mesh, which is one of the base too, where it has no faces.
  template <typename Scalar>
  void fill_isolated(Index vertex, ConstValuesRef base_values, std::span<Scalar> out, std::span<Scalar> normals) const;
  /// some: base faces to fill, or none for all.
  template <typename Scalar>
  void fill_faces(std::optional<std::span<const Index>> some, ConstValuesRef base_values, bool limit,
                  std::span<Scalar> out, std::span<Scalar> normals, const Progress& progress) const;
  template <typename Scalar>
  void evaluate(ConstValuesRef control_values, bool limit, std::span<Scalar> out, std::span<Scalar> normals,
                const Progress& progress) const;
  template <typename Scalar>
  std::vector<Index> evaluate_around(std::span<const Index> moved, ConstValuesRef control_values, std::span<Scalar> out,
                                     std::span<Scalar> normals) const;
};

namespace {

/// Unit normals in place of the first tangents, plane by plane; zero where the tangents are parallel. A function of its
/// own, because the compiler believes __restrict of parameters, and then uses whole vector registers.
template <typename Scalar>
[[gnu::noinline]] void normals_of(Scalar* __restrict x, Scalar* __restrict y, Scalar* __restrict z,
                                  const Scalar* __restrict vx, const Scalar* __restrict vy, const Scalar* __restrict vz,
                                  std::ptrdiff_t count) {
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Scalar nx = y[i] * vz[i] - z[i] * vy[i];
    const Scalar ny = z[i] * vx[i] - x[i] * vz[i];
    const Scalar nz = x[i] * vy[i] - y[i] * vx[i];
    // Tangents were scaled, so the smallest number changes nothing but a zero; a branch would cost the registers too.
    const Scalar square = (nx * nx + ny * ny + nz * nz) + std::numeric_limits<Scalar>::min();
    const Scalar scale = Scalar(1) / std::sqrt(square);
    x[i] = nx * scale;
    y[i] = ny * scale;
    z[i] = nz * scale;
  }
}

}  // namespace

template <typename Scalar>
void Tessellator::Parts::check_output(ConstValuesRef control_values, std::span<Scalar> out,
                                      std::span<Scalar> normals) const {
  require_vertex_rows(control(), control_values);
  const std::ptrdiff_t k = control_values.cols();
  const auto wanted = static_cast<std::size_t>(layout.vertices) * static_cast<std::size_t>(k);
  if (out.size() == wanted && (normals.empty() || (k == 3 && normals.size() == wanted))) return;
  throw Error(ErrorCode::BadShape, "the tessellation has " + std::to_string(layout.vertices) + " vertices of " +
                                       std::to_string(k) + " numbers; the output must have room for just these" +
                                       (normals.empty() ? "" : ", and normals need three columns"));
}

/// Refined points are on the limit surface.
template <typename Scalar>
void Tessellator::Parts::fill_interpolating(ConstValuesRef control_values, std::span<Scalar> out,
                                            std::span<Scalar> normals, const Progress& progress) const {
  if (normals.empty()) {
    return fill_butterfly_grids(base(), scheme(), control_values, layout.levels, out.data(), progress);
  }
  constexpr double kFilled = 0.5;  // of the time
  Values points(layout.vertices, 3);
  fill_butterfly_grids(base(), scheme(), control_values, layout.levels, points.data(),
                       progress_within(progress, 0.0, kFilled));
  const auto rounded = [](double number) { return static_cast<Scalar>(number); };
  std::transform(points.data(), points.data() + points.size(), out.begin(), rounded);
  const Values exact = butterfly_grid_normals(base(), scheme(), points, layout.levels).vertices;
  std::transform(exact.data(), exact.data() + exact.size(), normals.begin(), rounded);
  report_progress(progress, 1.0);
}

template <typename Scalar>
void Tessellator::Parts::fill_isolated(Index vertex, ConstValuesRef base_values, std::span<Scalar> out,
                                       std::span<Scalar> normals) const {
  if (!base().is_isolated(vertex)) return;
  const auto k = static_cast<std::size_t>(base_values.cols());
  for (std::size_t c = 0; c < k; ++c)
    out[static_cast<std::size_t>(vertex) * k + c] = static_cast<Scalar>(base_values(vertex, static_cast<int>(c)));
  if (!normals.empty()) std::fill_n(&normals[3 * static_cast<std::size_t>(vertex)], 3, Scalar(0));
}

template <typename Scalar>
void Tessellator::Parts::fill_faces(std::optional<std::span<const Index>> some, ConstValuesRef base_values, bool limit,
                                    std::span<Scalar> out, std::span<Scalar> normals, const Progress& progress) const {
  const auto k = static_cast<int>(base_values.cols());
  const bool with_normals = !normals.empty();
  const LevelValues values(pieces(), base_values);
  std::vector<const PieceTables<Scalar>*> kinds{&tables<Scalar>(limit ? TileValue::Limit : TileValue::Refined)};
  if (with_normals) {
    kinds.push_back(&tables<Scalar>(TileValue::TangentU));
    kinds.push_back(&tables<Scalar>(TileValue::TangentV));
  }
  const std::ptrdiff_t block = std::max<std::ptrdiff_t>(1, kPointsPerBlock / layout.faces_per_face);
  parallel_for(
      some ? static_cast<std::ptrdiff_t>(some->size()) : base().face_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        GridFiller<Scalar> filler(pieces(), kinds, values);
        std::vector<PieceGrid<Scalar>> grids(kinds.size(), PieceGrid<Scalar>(layout.steps, k));
        const GridWriter<Scalar> writer(base(), layout, out.data());
        const GridWriter<Scalar> normal_writer(base(), layout, normals.data());
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Index f = some ? (*some)[static_cast<std::size_t>(i)] : static_cast<Index>(i);
          filler.fill(f, grids);
          writer.write(f, grids[0]);
          if (!with_normals) continue;
          normals_of(grids[1].plane(0), grids[1].plane(1), grids[1].plane(2), grids[2].plane(0), grids[2].plane(1),
                     grids[2].plane(2), grids[1].plane_size());
          normal_writer.write(f, grids[1]);
        }
      },
      block, progress);
}

template <typename Scalar>
void Tessellator::Parts::evaluate(ConstValuesRef control_values, bool limit, std::span<Scalar> out,
                                  std::span<Scalar> normals, const Progress& progress) const {
  check_output(control_values, out, normals);
  if (out.empty()) return;
  if (is_interpolating(scheme().kind)) return fill_interpolating(control_values, out, normals, progress);
  if (!limit && is_one_step()) return refine_values(control(), scheme(), {}, control_values, out.data(), progress);
  with_base_values(control_values, [&](ConstValuesRef base_values) {
    fill_faces(std::nullopt, base_values, limit, out, normals, progress);
    for (Index v = 0; v < base().vertex_count(); ++v) fill_isolated(v, base_values, out, normals);
  });
}

template <typename Scalar>
std::vector<Index> Tessellator::Parts::evaluate_around(std::span<const Index> moved, ConstValuesRef control_values,
                                                       std::span<Scalar> out, std::span<Scalar> normals) const {
  check_output(control_values, out, normals);
  for (const Index vertex : moved) {
    if (vertex >= 0 && vertex < control().vertex_count()) continue;
    throw Error(ErrorCode::IndexOutOfRange, "there is no control vertex " + std::to_string(vertex) + " among " +
                                                std::to_string(control().vertex_count()));
  }
  std::vector<Index> written;
  if (moved.empty()) return written;
  if (is_interpolating(scheme().kind)) {
    fill_interpolating(control_values, out, normals, {});
    written.resize(static_cast<std::size_t>(layout.vertices));
    std::iota(written.begin(), written.end(), Index{0});
    return written;
  }
  const std::vector<Index> faces = reached_faces(patches, moved);
  with_base_values(control_values, [&](ConstValuesRef base_values) {
    fill_faces<Scalar>(faces, base_values, true, out, normals, {});
    for (const Index vertex : moved) fill_isolated(vertex, base_values, out, normals);
  });
  const GridWriter<Scalar> writer(base(), layout, out.data());
  for (const Index face : faces)
    writer.for_each_run(face, [&](std::int64_t vertex, std::ptrdiff_t, std::ptrdiff_t, std::ptrdiff_t count) {
      for (std::ptrdiff_t i = 0; i < count; ++i) written.push_back(static_cast<Index>(vertex + i));
    });
  for (const Index vertex : moved)
    if (base().is_isolated(vertex)) written.push_back(vertex);
  return written;
}

Tessellator::Tessellator(const SurfacePatches& patches, int levels) {
  if (levels < 1 || levels > 15) {
    throw Error(ErrorCode::BadArgument, "a tessellation has 1 to 15 levels, not " + std::to_string(levels));
  }
  parts_ = std::make_unique<Parts>(patches, levels);
}

Tessellator::Tessellator(const Topology& topology, const Scheme& scheme, int levels)
    : Tessellator(SurfacePatches(topology, scheme), levels) {}

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
void Tessellator::refined(ConstValuesRef control, std::span<Scalar> out, const Progress& progress) const {
  parts_->evaluate<Scalar>(control, false, out, {}, progress);
}

template <typename Scalar>
void Tessellator::limit(ConstValuesRef control, std::span<Scalar> out, std::span<Scalar> normals,
                        const Progress& progress) const {
  parts_->evaluate<Scalar>(control, true, out, normals, progress);
}

template <typename Scalar>
std::vector<Index> Tessellator::limit_around(std::span<const Index> moved, ConstValuesRef control,
                                             std::span<Scalar> out, std::span<Scalar> normals) const {
  return parts_->evaluate_around<Scalar>(moved, control, out, normals);
}

Index Tessellator::vertex(Index base_face, Index i, Index j) const {
  return parts_->layout.vertex(parts_->base(), base_face, i, j);
}

void Tessellator::faces(std::span<Index> out) const {
  const TessellationLayout& layout = parts_->layout;
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
        const GridNumbering numbering{base, layout};
        GridFaces grids(layout, numbering);
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          const Index rank = parts_->face_rank.empty() ? f : parts_->face_rank[f];
          if (rank >= 0) grids.write(f, out.data() + static_cast<std::size_t>(rank) * per_face);
        }
      },
      block);
}

Attribute Tessellator::at_corners(const Attribute& attribute) const {
  const Parts& parts = *parts_;
  if (!parts.patches.has_first_step())
    return tessellate_corners(parts.base(), parts.layout, parts.face_rank, attribute);
  const Attribute stepped = refine_at_corners(parts.control(), parts.scheme().kind, attribute);
  return tessellate_corners(parts.base(), parts.layout, parts.face_rank, stepped);
}

Values Tessellator::midpoints(ConstValuesRef control, const Progress& progress) const {
  const Parts& parts = *parts_;
  require_vertex_rows(parts.control(), control);
  if (!parts.patches.has_first_step()) return linear_values(parts.base(), parts.layout, control, progress);
  const Values stepped = refine_midpoints(parts.control(), parts.scheme().kind, control);
  return linear_values(parts.base(), parts.layout, stepped, progress);
}

template <typename Scalar>
Tessellation<Scalar> tessellate(const Topology& topology, const Scheme& scheme, ConstValuesRef control, int levels,
                                const TessellateOptions& options, const Progress& progress) {
  constexpr double kConnected = 0.1;  // of the time
  constexpr double kFilled = 0.9;
  const SurfacePatches patches(topology, scheme, progress_within(progress, 0.0, kConnected));
  const Tessellator tessellator(patches, levels);
  const Progress filling = progress_within(progress, kConnected, kFilled);
  Tessellation<Scalar> result;
  result.face_size = tessellator.face_size();
  const auto numbers = 3 * static_cast<std::size_t>(tessellator.vertex_count());
  if (control.cols() != 3) throw Error(ErrorCode::BadShape, "points have three columns");
  result.points.resize(numbers);
  if (options.normals) result.normals.resize(numbers);
  if (options.limit || options.normals) {
    tessellator.limit<Scalar>(control, result.points, result.normals, filling);
  } else {
    tessellator.refined<Scalar>(control, result.points, filling);
  }
  result.faces.resize(static_cast<std::size_t>(tessellator.face_count()) * static_cast<std::size_t>(result.face_size));
  tessellator.faces(result.faces);
  report_progress(progress, 1.0);
  return result;
}

template void Tessellator::refined(ConstValuesRef, std::span<float>, const Progress&) const;
template void Tessellator::refined(ConstValuesRef, std::span<double>, const Progress&) const;
template void Tessellator::limit(ConstValuesRef, std::span<float>, std::span<float>, const Progress&) const;
template void Tessellator::limit(ConstValuesRef, std::span<double>, std::span<double>, const Progress&) const;
template std::vector<Index> Tessellator::limit_around(std::span<const Index>, ConstValuesRef, std::span<float>,
                                                      std::span<float>) const;
template std::vector<Index> Tessellator::limit_around(std::span<const Index>, ConstValuesRef, std::span<double>,
                                                      std::span<double>) const;
template Tessellation<float> tessellate(const Topology&, const Scheme&, ConstValuesRef, int, const TessellateOptions&,
                                        const Progress&);
template Tessellation<double> tessellate(const Topology&, const Scheme&, ConstValuesRef, int, const TessellateOptions&,
                                         const Progress&);

}  // namespace batten
