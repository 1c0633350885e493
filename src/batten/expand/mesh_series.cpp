#include "batten/expand/mesh_series.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/expand/cotangent_rows.h"
#include "batten/limit/ring_rows.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"
#include "batten/solve/tiled_polynomial.h"

namespace batten {

namespace {

/// The smooth vertices with two faces, block by block.
std::vector<Buffer<Index>> vertices_of_valence_two(const Topology& topology) {
  std::vector<Buffer<Index>> found(static_cast<std::size_t>(block_count(topology.vertex_count())));
  parallel_for(topology.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (topology.is_isolated(v) || topology.is_boundary_vertex(v)) continue;
      const Index first = topology.vertex_half_edge(v);
      const Index second = topology.twin(topology.previous(first));
      if (second == first || topology.twin(topology.previous(second)) == first)
        found[begin / kDefaultBlock].push_back(v);
    }
  });
  return found;
}

/// Alpha = 1 at the components with a smooth vertex of valence 2, or nothing where there is none.
std::vector<double> safe_alpha(const Topology& topology, const Scheme& scheme) {
  if (scheme.kind == SchemeKind::Loop) return {};
  const std::vector<Buffer<Index>> found = vertices_of_valence_two(topology);
  if (std::all_of(found.begin(), found.end(), [](const Buffer<Index>& block) { return block.empty(); })) return {};
  const Components components = connected_components(topology);
  std::vector<std::uint8_t> marked(static_cast<std::size_t>(components.count), 0);
  for (const Buffer<Index>& block : found) {
    for (const Index v : block) marked[components.of_vertex[v]] = 1;
  }
  std::vector<double> alpha(static_cast<std::size_t>(topology.vertex_count()), scheme.alpha);
  parallel_for(topology.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (marked[components.of_vertex[v]] != 0) alpha[v] = kValenceTwoAlpha;
    }
  });
  return alpha;
}

/// The rows of A with those of the kept vertices replaced by the identity's.
class KeptRows : public RowSource {
 public:
  KeptRows(const LimitMatrix& matrix, const Buffer<std::uint8_t>& kept)
      : RowSource(matrix.topology().vertex_count()), matrix_(matrix), kept_(kept) {}
  void row(Index row, RowEntries& entries) const override {
    if (is_kept(row)) return entries.add(row, 1.0);
    matrix_.visit_row(row, [&](Index column, double weight) { entries.add(column, weight); });
  }
  Index weights_key(Index row) const override { return is_kept(row) ? 0 : ring_key(matrix_, row); }
  void columns_of(Index row, Index* columns) const override { ring_columns(matrix_, row, columns); }

 private:
  bool is_kept(Index row) const { return !kept_.empty() && kept_[row] != 0; }

  const LimitMatrix& matrix_;
  const Buffer<std::uint8_t>& kept_;
};

/// G^index A as a polynomial in G = E - A: G^index - G^(index + 1).
std::vector<double> term_coefficients(int index) {
  if (index < 0) throw Error(ErrorCode::BadArgument, "terms are counted from 0");
  std::vector<double> coefficients(static_cast<std::size_t>(index) + 2, 0.0);
  coefficients[coefficients.size() - 2] = 1.0;
  coefficients.back() = -1.0;
  return coefficients;
}

/// The sum of the terms 0 .. last: E - G^(last + 1).
std::vector<double> sum_coefficients(int last) {
  if (last < 0) throw Error(ErrorCode::BadArgument, "terms are counted from 0");
  std::vector<double> coefficients(static_cast<std::size_t>(last) + 2, 0.0);
  coefficients.front() = 1.0;
  coefficients.back() = -1.0;
  return coefficients;
}

/// The Butterfly schemes pass through their control points: nothing would happen.
const Scheme& require_approximating(const Scheme& scheme) {
  if (is_interpolating(scheme.kind)) {
    throw Error(ErrorCode::BadArgument,
                "the Butterfly schemes pass through their control points, so their limit matrix smooths nothing; take "
                "Loop");
  }
  return scheme;
}

}  // namespace

struct MeshSeries::Parts {
  Topology topology;
  Buffer<std::uint8_t> kept;
  LimitMatrix matrix;
  std::unique_ptr<TiledPolynomial> tiles;
  std::unique_ptr<CotangentRows> cotangents;  ///< without the rows once they are in tiles

  Parts(const Topology& topology_in, const Scheme& scheme, const SeriesOptions& options, const Progress& progress)
      : topology(topology_in),
        kept(options.kept),
        matrix(topology_in, require_approximating(scheme), {LimitMasks::Exact, safe_alpha(topology_in, scheme)},
               progress_within(progress, 0.0, 0.2)) {
    if (!kept.empty() && static_cast<Index>(kept.size()) != topology.vertex_count())
      throw Error(ErrorCode::BadShape, "kept must be empty or have one entry a vertex");
    const Progress rest = progress_within(progress, 0.2, 1.0);
    if (options.matrix == SeriesMatrix::Cotangent) {
      cotangents =
          std::make_unique<CotangentRows>(cotangent_rows(matrix, options.shape, kept, progress_within(rest, 0.0, 0.5)));
      const RemainderRows& rows = cotangents->remainder;
      make_tiles(rows, static_cast<double>(rows.columns.size()), progress_within(rest, 0.5, 1.0));
      if (tiles) cotangents->remainder = {};
    } else {
      make_tiles(KeptRows(matrix, kept), matrix.entry_count(), rest);
    }
  }

  /// Leaves `tiles` empty where they would cost more than they save.
  template <typename Rows>
  void make_tiles(const Rows& rows, double entry_count, const Progress& progress) {
    if (entry_count > TiledIteration::kMostEntriesPerRow * topology.vertex_count()) return;
    tiles = std::make_unique<TiledPolynomial>(rows, progress);
    if (!tiles->fits() || tiles->overlap() > TiledIteration::kMostOverlap) tiles.reset();
  }

  /// G y, one application over the whole mesh.
  void remainder(const Values& y, Values& next) const {
    if (cotangents) return cotangents->remainder.apply(y, next);
    next.resize(y.rows(), y.cols());
    matrix.apply_unchecked(y, next);
    parallel_for(y.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t v = begin; v < end; ++v) {
        if (!kept.empty() && kept[v] != 0) {
          next.row(v).setZero();
        } else {
          next.row(v) = y.row(v) - next.row(v);
        }
      }
    });
  }

  void sweep(const std::vector<double>& coefficients, int passes, ValuesRef x, const Progress& progress) const {
    Values y;
    Values next;
    const double steps = static_cast<double>(passes) * static_cast<double>(coefficients.size() - 1);
    double done = 0.0;
    for (int pass = 0; pass < passes; ++pass) {
      y = x;
      x *= coefficients[0];
      for (std::size_t i = 1; i < coefficients.size(); ++i, done += 1.0) {
        report_progress(progress, done / steps);
        remainder(y, next);
        std::swap(y, next);
        if (coefficients[i] != 0.0) x += coefficients[i] * y;
      }
    }
  }
};

MeshSeries::MeshSeries(const Topology& topology, const Scheme& scheme, const SeriesOptions& options,
                       const Progress& progress)
    : parts_(std::make_unique<Parts>(topology, scheme, options, progress)) {}

MeshSeries::~MeshSeries() = default;
MeshSeries::MeshSeries(MeshSeries&&) noexcept = default;

const Topology& MeshSeries::topology() const { return parts_->topology; }
const LimitMatrix& MeshSeries::limit_matrix() const { return parts_->matrix; }
bool MeshSeries::is_kept(Index vertex) const { return !parts_->kept.empty() && parts_->kept[vertex] != 0; }

void MeshSeries::polynomial_into(ConstValuesRef values, ValuesRef result, const std::vector<double>& coefficients,
                                 int passes, const Progress& progress) const {
  require_vertex_rows(parts_->topology, values);
  require_shape(result, values.rows(), values.cols());
  if (coefficients.empty()) throw Error(ErrorCode::BadArgument, "a polynomial needs a coefficient");
  if (passes < 0) throw Error(ErrorCode::BadArgument, "passes must not be negative");
  require_finite(values, "values");
  if (parts_->tiles) return parts_->tiles->apply(coefficients, passes, values, result, progress);
  result = values;
  if (result.size() > 0) parts_->sweep(coefficients, passes, result, progress);
}

Values MeshSeries::polynomial(ConstValuesRef values, const std::vector<double>& coefficients, int passes,
                              const Progress& progress) const {
  Values result(values.rows(), values.cols());
  polynomial_into(values, result, coefficients, passes, progress);
  return result;
}

Values MeshSeries::apply(ConstValuesRef values, const Progress& progress) const {
  return polynomial(values, {1.0, -1.0}, 1, progress);
}

void MeshSeries::apply_into(ConstValuesRef values, ValuesRef result, const Progress& progress) const {
  polynomial_into(values, result, {1.0, -1.0}, 1, progress);
}

Values MeshSeries::remainder(ConstValuesRef values, int power, const Progress& progress) const {
  return polynomial(values, {0.0, 1.0}, power, progress);
}

void MeshSeries::remainder_into(ConstValuesRef values, ValuesRef result, int power, const Progress& progress) const {
  polynomial_into(values, result, {0.0, 1.0}, power, progress);
}

Values MeshSeries::term(ConstValuesRef values, int index, const Progress& progress) const {
  return polynomial(values, term_coefficients(index), 1, progress);
}

void MeshSeries::term_into(ConstValuesRef values, ValuesRef result, int index, const Progress& progress) const {
  polynomial_into(values, result, term_coefficients(index), 1, progress);
}

Values MeshSeries::partial_sum(ConstValuesRef values, int last, const Progress& progress) const {
  return polynomial(values, sum_coefficients(last), 1, progress);
}

void MeshSeries::partial_sum_into(ConstValuesRef values, ValuesRef result, int last, const Progress& progress) const {
  polynomial_into(values, result, sum_coefficients(last), 1, progress);
}

Values MeshSeries::smooth(ConstValuesRef values, int m, int passes, const Progress& progress) const {
  return polynomial(values, sum_coefficients(m), passes, progress);
}

void MeshSeries::smooth_into(ConstValuesRef values, ValuesRef result, int m, int passes,
                             const Progress& progress) const {
  polynomial_into(values, result, sum_coefficients(m), passes, progress);
}

std::vector<double> MeshSeries::energies(ConstValuesRef values, int count, const Progress& progress) const {
  std::vector<double> energies;
  Values left = values;
  for (int i = 0; i < count; ++i) {
    Values next = remainder(left, 1, progress_within(progress, static_cast<double>(i) / count, (i + 1.0) / count));
    const auto squares = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      return (left - next).middleRows(begin, end - begin).squaredNorm();
    };
    const double sum = parallel_reduce(left.rows(), 0.0, squares, [](double a, double b) { return a + b; });
    energies.push_back(left.rows() > 0 ? sum / static_cast<double>(left.rows()) : 0.0);
    left.swap(next);
  }
  return energies;
}

double MeshSeries::weight(Index vertex) const {
  return parts_->cotangents ? parts_->cotangents->scales[vertex] : parts_->matrix.row_scale(vertex);
}

ValueRow MeshSeries::weighted_centroid(ConstValuesRef values) const {
  require_vertex_rows(parts_->topology, values);
  ValueRow sum = ValueRow::Zero(values.cols());
  double weights = 0.0;
  for (Index v = 0; v < parts_->topology.vertex_count(); ++v) {
    sum += weight(v) * values.row(v);
    weights += weight(v);
  }
  return weights > 0.0 ? ValueRow(sum / weights) : sum;
}

}  // namespace batten
