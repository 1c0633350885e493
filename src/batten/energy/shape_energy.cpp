#include "batten/energy/shape_energy.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "batten/energy/face_coefficients.h"
#include "batten/energy/jet_tables.h"
#include "batten/energy/matrix_rows.h"
#include "batten/energy/shape_elements.h"
#include "batten/energy/shape_rows.h"
#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Elements whose matrices are worked out before they are added up: 4 MB of regular ones.
constexpr Index kElementsAtOnce = 2048;
constexpr std::ptrdiff_t kElementBlock = 64;
constexpr std::ptrdiff_t kRowBlock = 256;

struct PatternScratch {
  RowSum row;
};

/// Elements begin to end and their matrices: that of element e starts at numbers[starts[e - begin]].
struct ElementMatrices {
  Index begin;
  Index end;
  Buffer<std::size_t> starts;
  Buffer<double> numbers;
};

/// Adds to a row what the elements have for it. sums: a zero for each column, before and after.
void add_row(const FaceElements& elements, const ElementMatrices& matrices, Index row, Buffer<double>& sums,
             ShapeEnergy::Matrix& matrix) {
  const std::span<const FaceElements::Use> uses = elements.uses(row);
  auto use = std::lower_bound(uses.begin(), uses.end(), matrices.begin,
                              [](const FaceElements::Use& one, Index element) { return one.element < element; });
  for (; use != uses.end() && use->element < matrices.end; ++use) {
    const std::span<const Index> vertices = elements.vertices(use->element);
    const double* const numbers =
        matrices.numbers.data() + matrices.starts[use->element - matrices.begin] + use->place * vertices.size();
    for (std::size_t j = 0; j < vertices.size(); ++j) sums[vertices[j]] += numbers[j];
  }
  for (int e = matrix.outerIndexPtr()[row]; e < matrix.outerIndexPtr()[row + 1]; ++e) {
    double& sum = sums[matrix.innerIndexPtr()[e]];
    matrix.valuePtr()[e] += sum;
    sum = 0.0;
  }
}

}  // namespace

struct ShapeEnergy::Parts {
  SurfacePatches patches;
  ShapeEnergyKind kind;
  FaceElements elements;
  std::vector<JetTable> tables;
  Buffer<int> starts;   ///< of K's rows
  Buffer<int> columns;  ///< of its entries

  Parts(const SurfacePatches& patches_in, ShapeEnergyKind kind_in, const QuadratureOptions& options,
        const Progress& progress)
      : patches(patches_in),
        kind(kind_in),
        elements(patches),
        tables(jet_tables(patches, elements, shape_jet_rows(kind), options)) {
    std::vector<Buffer<Index>> points;
    for (const JetTable& table : tables) points.push_back(table.points);
    elements.list_vertices(patches, points);
    const Index count = patches.base().vertex_count();
    const Matrix pattern = matrix_of_rows<PatternScratch>(
        count, count, [&] { return std::make_unique<PatternScratch>(PatternScratch{RowSum(count)}); },
        [&](Index vertex, PatternScratch& scratch) {
          for (const FaceElements::Use& use : elements.uses(vertex)) {
            scratch.row.add(elements.vertices(use.element), [](Index) { return 0.0; });
          }
        },
        progress);
    starts.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + count + 1);
    columns.assign(pattern.innerIndexPtr(), pattern.innerIndexPtr() + pattern.nonZeros());
  }

  Matrix zeros() const;

  void require_base_points(ConstValuesRef points) const {
    require_vertex_rows(patches.base(), points);
    if (points.cols() != 3)
      throw Error(ErrorCode::BadShape, "a reference surface needs control points of three columns");
    require_finite(points, "control points");
  }
  void find_matrices(Index begin, Index end, ConstValuesRef reference, std::span<const double> face_factors,
                     ElementMatrices& matrices) const;
  Buffer<Index> rows_of(Index begin, Index end, Buffer<std::uint8_t>& marks) const;
  /// Of the control face that an element lies in.
  double factor(Index element, std::span<const double> face_factors) const {
    return coefficient_of(face_factors, elements.control_face(element));
  }
  void require_factors(std::span<const double> face_factors) const {
    require_coefficients(face_factors, patches.topology().face_count(), "factor");
  }
};

/// K with zeros for entries.
ShapeEnergy::Matrix ShapeEnergy::Parts::zeros() const {
  const Index count = patches.base().vertex_count();
  Matrix matrix(count, count);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(columns.size()));
  std::copy(starts.begin(), starts.end(), matrix.outerIndexPtr());
  std::copy(columns.begin(), columns.end(), matrix.innerIndexPtr());
  matrix.coeffs().setZero();
  return matrix;
}

void ShapeEnergy::Parts::find_matrices(Index begin, Index end, ConstValuesRef reference,
                                       std::span<const double> face_factors, ElementMatrices& matrices) const {
  matrices.begin = begin;
  matrices.end = end;
  matrices.starts.assign(static_cast<std::size_t>(end - begin) + 1, 0);
  for (Index e = begin; e < end; ++e) {
    const std::size_t size = elements.vertices(e).size();
    matrices.starts[e - begin + 1] = matrices.starts[e - begin] + size * size;
  }
  matrices.numbers.resize(std::max(matrices.numbers.size(), matrices.starts.back()));
  const ShapeElements shapes(kind, elements, tables, reference);
  parallel_for(
      end - begin,
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        ShapeScratch scratch;
        const auto numbers_of = [&](Index element) {
          return matrices.numbers.data() + matrices.starts[element - begin];
        };
        for_shape_batches(elements, begin + static_cast<Index>(first), begin + static_cast<Index>(last),
                          [&](const ShapeBatch& batch) {
                            ShapeTargets targets{};
                            for (int i = 0; i < batch.count; ++i) targets[i] = numbers_of(batch.first + i);
                            shapes.matrices(batch, scratch, targets);
                            for (int i = 0; i < batch.count; ++i) {
                              const double by = factor(batch.first + i, face_factors);
                              double* const end_number = numbers_of(batch.first + i + 1);
                              for (double* n = targets[i]; by != 1.0 && n < end_number; ++n) *n *= by;
                            }
                          });
      },
      kElementBlock);
}

/// The vertices of elements begin to end, each once. marks: a zero for each vertex, before and after.
Buffer<Index> ShapeEnergy::Parts::rows_of(Index begin, Index end, Buffer<std::uint8_t>& marks) const {
  Buffer<Index> rows;
  for (Index e = begin; e < end; ++e) {
    for (const Index v : elements.vertices(e)) {
      if (marks[v] != 0) continue;
      marks[v] = 1;
      rows.push_back(v);
    }
  }
  for (const Index v : rows) marks[v] = 0;
  return rows;
}

ShapeEnergy::ShapeEnergy(const SurfacePatches& patches, ShapeEnergyKind kind, const QuadratureOptions& options,
                         const Progress& progress)
    : parts_(std::make_unique<const Parts>(patches, kind, options, progress)) {}

ShapeEnergy::~ShapeEnergy() = default;
ShapeEnergy::ShapeEnergy(ShapeEnergy&&) noexcept = default;

const SurfacePatches& ShapeEnergy::patches() const { return parts_->patches; }
ShapeEnergyKind ShapeEnergy::kind() const { return parts_->kind; }

ShapeEnergy::Matrix ShapeEnergy::matrix(ConstValuesRef reference, const Progress& progress) const {
  constexpr double kOne = 1.0;
  return matrix(reference, {&kOne, 1}, progress);
}

ShapeEnergy::Matrix ShapeEnergy::matrix(ConstValuesRef reference, std::span<const double> face_factors,
                                        const Progress& progress) const {
  parts_->require_base_points(reference);
  parts_->require_factors(face_factors);
  Matrix matrix = parts_->zeros();
  const auto columns = static_cast<std::size_t>(matrix.cols());
  ElementMatrices matrices;
  Buffer<std::uint8_t> marks(columns, 0);
  ScratchPool<Buffer<double>> pool;
  const Index count = parts_->elements.count();
  for (Index begin = 0; begin < count; begin += kElementsAtOnce) {
    report_progress(progress, static_cast<double>(begin) / count);
    const Index end = std::min(count, begin + kElementsAtOnce);
    parts_->find_matrices(begin, end, reference, face_factors, matrices);
    const Buffer<Index> rows = parts_->rows_of(begin, end, marks);
    parallel_for(
        static_cast<std::ptrdiff_t>(rows.size()),
        [&](std::ptrdiff_t first, std::ptrdiff_t last) {
          auto sums = pool.take([&] { return std::make_unique<Buffer<double>>(columns, 0.0); });
          for (std::ptrdiff_t i = first; i < last; ++i) add_row(parts_->elements, matrices, rows[i], *sums, matrix);
          pool.give_back(std::move(sums));
        },
        kRowBlock);
  }
  report_progress(progress, 1.0);
  return matrix;
}

double ShapeEnergy::energy(ConstValuesRef control) const {
  parts_->require_base_points(control);
  const ShapeElements shapes(parts_->kind, parts_->elements, parts_->tables, control);
  return parallel_reduce(
      parts_->elements.count(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        ShapeScratch scratch;
        double sum = 0.0;
        for_shape_batches(parts_->elements, static_cast<Index>(begin), static_cast<Index>(end),
                          [&](const ShapeBatch& batch) {
                            const Double4 energies = shapes.energies(batch, scratch);
                            for (int i = 0; i < batch.count; ++i) sum += energies[i];
                          });
        return sum;
      },
      [](double a, double b) { return a + b; });
}

const FaceElements& ShapeEnergy::elements() const { return parts_->elements; }

Buffer<double> ShapeEnergy::element_gradients(const Points& reference, std::span<const double> face_factors) const {
  parts_->require_base_points(reference);
  parts_->require_factors(face_factors);
  const FaceElements& elements = parts_->elements;
  ConstValuesRef points = reference;  // which outlives what refers to it
  const ShapeElements shapes(parts_->kind, elements, parts_->tables, points);
  Buffer<double> gradients(3 * elements.vertices().size(), 0.0);
  parallel_for(
      elements.count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        ShapeScratch scratch;
        const auto gradients_of = [&](Index element) { return gradients.data() + 3 * elements.start(element); };
        for_shape_batches(elements, static_cast<Index>(begin), static_cast<Index>(end), [&](const ShapeBatch& batch) {
          ShapeTargets targets{};
          for (int i = 0; i < batch.count; ++i) targets[i] = gradients_of(batch.first + i);
          shapes.gradients(batch, scratch, targets);
          for (int i = 0; i < batch.count; ++i) {
            const double by = parts_->factor(batch.first + i, face_factors);
            for (double* n = targets[i]; n < gradients_of(batch.first + i + 1); ++n) *n *= by;
          }
        });
      },
      kElementBlock);
  return gradients;
}

}  // namespace batten
