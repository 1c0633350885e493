#include "batten/energy/surface_energy.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "batten/energy/energy_elements.h"
#include "batten/energy/face_coefficients.h"
#include "batten/energy/matrix_rows.h"
#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refined_rows.h"

namespace batten {

namespace {

constexpr int kMostCutoffLevels = 24;
constexpr std::ptrdiff_t kVertexBlock = 512;

EnergyOptions checked(const EnergyOptions& options, const SurfacePatches& patches) {
  const Index faces = patches.topology().face_count();
  require_coefficients(options.density, faces, "density");
  require_coefficients(options.tension, faces, "tension");
  require_coefficients(options.rigidity, faces, "rigidity");
  const int levels = options.cutoff_levels.value_or(1);
  if (levels < 1 || levels > kMostCutoffLevels) {
    throw Error(ErrorCode::BadArgument, "a cut-off is after 1 to " + std::to_string(kMostCutoffLevels) +
                                            " levels, not " + std::to_string(levels));
  }
  return options;
}

/// The transposed matrix; `rows` has `columns` columns.
SparseRows transposed(const SparseRows& rows, Index columns) {
  SparseRows result;
  result.starts.assign(static_cast<std::size_t>(columns) + 1, 0);
  result.columns.resize(rows.columns.size());
  result.weights.resize(rows.weights.size());
  for (const Index column : rows.columns) ++result.starts[column + 1];
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  Buffer<Index> next(result.starts.begin(), result.starts.end() - 1);
  for (Index r = 0; r < rows.count(); ++r) {
    for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) {
      const Index place = next[rows.columns[e]]++;
      result.columns[place] = r;
      result.weights[place] = rows.weights[e];
    }
  }
  return result;
}

/// For matrix_of_rows().
struct RowScratch {
  RowSum row;
};

/// Entries below the diagonal become the same bits as those above.
void copy_upper_to_lower(EnergyMatrix& matrix) {
  const int* const starts = matrix.outerIndexPtr();
  const int* const columns = matrix.innerIndexPtr();
  double* const values = matrix.valuePtr();
  parallel_for(
      matrix.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t r = begin; r < end; ++r) {
          for (int e = starts[r]; e < starts[r + 1] && columns[e] < r; ++e) {
            const int* const first = columns + starts[columns[e]];
            const int* const last = columns + starts[columns[e] + 1];
            values[e] = values[std::lower_bound(first, last, static_cast<int>(r)) - columns];
          }
        }
      },
      kVertexBlock);
}

}  // namespace

struct SurfaceEnergy::Parts {
  SurfacePatches patches;
  EnergyOptions options;
  EnergyElements elements;
  SparseRows first_step;  ///< S, of a base that is a first refinement; else empty
  SparseRows first_step_transposed;

  Parts(const SurfacePatches& patches_in, const EnergyOptions& options_in)
      : patches(patches_in), options(checked(options_in, patches)), elements(patches, options.cutoff_levels) {
    if (!patches.has_first_step()) return;
    first_step = refined_rows(patches.topology(), patches.scheme());
    first_step_transposed = transposed(first_step, patches.topology().vertex_count());
  }

  /// A row of an element's matrix of some kind: of one matrix, or of two. The matrices are symmetric: a column is a
  /// row.
  struct ElementRow {
    const double* first;
    const double* second;
    double first_factor;
    double second_factor;

    double operator()(Index j) const {
      const double entry = first_factor * first[j];
      return second == nullptr ? entry : entry + second_factor * second[j];
    }
  };
  ElementRow element_row(EnergyKind kind, const EnergyElements::Use& use) const {
    const FaceEnergy& energy = elements.energy(use.element);
    const Index face = elements.control_face(use.element);
    const auto row_of = [&](EnergyKind part) { return energy.matrix(part).col(use.place).data(); };
    if (kind == EnergyKind::Mass) return {row_of(kind), nullptr, coefficient_of(options.density, face), 0.0};
    const double tension = coefficient_of(options.tension, face);
    if (kind == EnergyKind::Membrane) return {row_of(kind), nullptr, tension, 0.0};
    const double rigidity = coefficient_of(options.rigidity, face);
    if (kind == EnergyKind::ThinPlate) return {row_of(kind), nullptr, rigidity, 0.0};
    return {row_of(EnergyKind::Membrane), row_of(EnergyKind::ThinPlate), tension, rigidity};
  }

  void add_row(EnergyKind kind, Index vertex, RowSum& row) const {
    for (const EnergyElements::Use& use : elements.uses(vertex)) {
      row.add(elements.vertices(use.element), element_row(kind, use));
    }
  }

  /// For the row that belongs to a vertex's place in an element.
  Eigen::RowVector3d gradient(EnergyKind kind, const EnergyElements::Use& use, const Points& base_points) const {
    const ElementRow row = element_row(kind, use);
    const std::span<const Index> vertices = elements.vertices(use.element);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t j = 0; j < vertices.size(); ++j) sum += row(static_cast<Index>(j)) * base_points.row(vertices[j]);
    return sum;
  }

  Matrix base_matrix(EnergyKind kind, const Progress& progress) const;
  Matrix control_matrix(EnergyKind kind, const Progress& progress) const;
  template <int Columns>
  void apply_to_base(EnergyKind kind, ConstValuesRef values, ValuesRef result) const;
  void apply_to_base(EnergyKind kind, ConstValuesRef values, ValuesRef result) const;
};

SurfaceEnergy::Matrix SurfaceEnergy::Parts::base_matrix(EnergyKind kind, const Progress& progress) const {
  const Index count = patches.base().vertex_count();
  return matrix_of_rows<RowScratch>(
      count, count, [&] { return std::make_unique<RowScratch>(RowScratch{RowSum(count)}); },
      [&](Index vertex, RowScratch& scratch) { add_row(kind, vertex, scratch.row); }, progress);
}

/// S^T K S. Sums in another order would make (i, j) differ from (j, i) in rounding: the upper triangle counts.
SurfaceEnergy::Matrix SurfaceEnergy::Parts::control_matrix(EnergyKind kind, const Progress& progress) const {
  struct Scratch {
    RowSum row;
    RowSum base_row;
  };
  const Index base_count = patches.base().vertex_count();
  const Index count = patches.topology().vertex_count();
  const auto make = [&] { return std::make_unique<Scratch>(Scratch{RowSum(count), RowSum(base_count)}); };
  const Matrix half = matrix_of_rows<Scratch>(
      base_count, count, make,
      [&](Index vertex, Scratch& scratch) {
        add_row(kind, vertex, scratch.base_row);
        scratch.base_row.take([&](Index v, double weight) {
          const Index begin = first_step.starts[v];
          scratch.row.add({&first_step.columns[begin], static_cast<std::size_t>(first_step.starts[v + 1] - begin)},
                          [&](Index j) { return weight * first_step.weights[begin + j]; });
        });
      },
      progress_within(progress, 0.0, 0.6));
  const SparseRows& to_control = first_step_transposed;
  Matrix matrix = matrix_of_rows<RowScratch>(
      count, count, [&] { return std::make_unique<RowScratch>(RowScratch{RowSum(count)}); },
      [&](Index vertex, RowScratch& scratch) {
        for (Index e = to_control.starts[vertex]; e < to_control.starts[vertex + 1]; ++e) {
          const int begin = half.outerIndexPtr()[to_control.columns[e]];
          const int end = half.outerIndexPtr()[to_control.columns[e] + 1];
          scratch.row.add({half.innerIndexPtr() + begin, static_cast<std::size_t>(end - begin)},
                          [&](Index j) { return to_control.weights[e] * half.valuePtr()[begin + j]; });
        }
      },
      progress_within(progress, 0.6, 1.0));
  copy_upper_to_lower(matrix);
  return matrix;
}

/// Columns: how many, or Eigen::Dynamic.
template <int Columns>
void SurfaceEnergy::Parts::apply_to_base(EnergyKind kind, ConstValuesRef values, ValuesRef result) const {
  using Row = Eigen::Matrix<double, 1, Columns>;
  parallel_for(
      patches.base().vertex_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Row sum(values.cols());
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          sum.setZero();
          for (const EnergyElements::Use& use : elements.uses(v)) {
            const ElementRow row = element_row(kind, use);
            const std::span<const Index> vertices = elements.vertices(use.element);
            for (std::size_t j = 0; j < vertices.size(); ++j) {
              const Eigen::Map<const Row> from(values.data() + vertices[j] * values.outerStride(), values.cols());
              sum += row(static_cast<Index>(j)) * from;
            }
          }
          result.row(v) = sum;
        }
      },
      kVertexBlock);
}

void SurfaceEnergy::Parts::apply_to_base(EnergyKind kind, ConstValuesRef values, ValuesRef result) const {
  if (values.cols() == 1) return apply_to_base<1>(kind, values, result);
  if (values.cols() == 3) return apply_to_base<3>(kind, values, result);
  apply_to_base<Eigen::Dynamic>(kind, values, result);
}

SurfaceEnergy::SurfaceEnergy(const SurfacePatches& patches, const EnergyOptions& options)
    : parts_(std::make_unique<const Parts>(patches, options)) {}

SurfaceEnergy::SurfaceEnergy(const Topology& topology, const Scheme& scheme, const EnergyOptions& options,
                             const Progress& progress)
    : SurfaceEnergy(SurfacePatches(topology, scheme, progress_within(progress, 0.0, 0.5)), options) {
  report_progress(progress, 1.0);
}

SurfaceEnergy::~SurfaceEnergy() = default;
SurfaceEnergy::SurfaceEnergy(SurfaceEnergy&&) noexcept = default;

const SurfacePatches& SurfaceEnergy::patches() const { return parts_->patches; }

SurfaceEnergy::Matrix SurfaceEnergy::matrix(EnergyKind kind, const Progress& progress) const {
  return patches().has_first_step() ? parts_->control_matrix(kind, progress) : parts_->base_matrix(kind, progress);
}

void SurfaceEnergy::apply(EnergyKind kind, ConstValuesRef values, ValuesRef result) const {
  require_vertex_rows(patches().topology(), values);
  require_finite(values, "values");
  require_shape(result, values.rows(), values.cols());
  if (!patches().has_first_step()) return parts_->apply_to_base(kind, values, result);
  const Values base = patches().base_values(values);
  Values of_base(base.rows(), base.cols());
  parts_->apply_to_base(kind, base, of_base);
  const SparseRows& rows = parts_->first_step_transposed;
  parallel_for(
      values.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t v = begin; v < end; ++v) {
          result.row(v).setZero();
          for (Index e = rows.starts[v]; e < rows.starts[v + 1]; ++e) {
            result.row(v) += rows.weights[e] * of_base.row(rows.columns[e]);
          }
        }
      },
      kVertexBlock);
}

double SurfaceEnergy::energy(EnergyKind kind, ConstValuesRef control) const {
  Values gradient(control.rows(), control.cols());
  apply(kind, control, gradient);
  return 0.5 * parallel_reduce(
                   control.rows(), 0.0,
                   [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                     const auto count = end - begin;
                     return control.middleRows(begin, count).cwiseProduct(gradient.middleRows(begin, count)).sum();
                   },
                   [](double a, double b) { return a + b; });
}

const FaceElements& SurfaceEnergy::elements() const { return parts_->elements; }

Buffer<double> SurfaceEnergy::element_gradients(EnergyKind kind, const Points& base_points) const {
  require_vertex_rows(patches().base(), base_points);
  require_finite(base_points, "base points");
  const EnergyElements& elements = parts_->elements;
  Buffer<double> gradients(3 * elements.vertices().size());
  parallel_for(
      elements.count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto e = static_cast<Index>(begin); e < static_cast<Index>(end); ++e) {
          const auto size = static_cast<Index>(elements.vertices(e).size());
          Eigen::Map<Points> to(gradients.data() + 3 * elements.start(e), size, 3);
          for (Index place = 0; place < size; ++place) to.row(place) = parts_->gradient(kind, {e, place}, base_points);
        }
      },
      kVertexBlock);
  return gradients;
}

}  // namespace batten
