#include "batten/energy/shape_elements.h"

#include <algorithm>
#include <cmath>

namespace batten {

namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void gather(std::span<const Index> vertices, ConstValuesRef from, ShapeScratch& scratch) {
  scratch.points.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    scratch.points.row(static_cast<Eigen::Index>(i)) = from.row(vertices[i]);
  }
}

/// Calls visit(weight, jets of the place, rows) for each place with a tangent plane: the weight is the area's. N: the
/// points, or Eigen::Dynamic. J: the rows of a jet.
template <int N, int J, typename Visit>
void visit_places(ShapeEnergyKind kind, const JetTable& table, ShapeScratch& scratch, const Visit& visit) {
  using Jets = Eigen::Map<const Eigen::Matrix<double, J, N, Eigen::RowMajor>>;
  const Eigen::Index count = table.jets.cols();
  const Eigen::Map<const Eigen::Matrix<double, N, 3, Eigen::RowMajor>> points(scratch.points.data(), count, 3);
  scratch.jet.resize(J, 3);
  for (std::size_t p = 0; p < table.weights.size(); ++p) {
    const Jets jets(table.jets.data() + static_cast<Eigen::Index>(p) * J * count, J, count);
    scratch.jet.template topRows<J>().noalias() = jets.lazyProduct(points);
    const double area = shape_rows(kind, scratch.jet, scratch.rows);
    if (area > 0.0) visit(table.weights[p] * area, jets, scratch.rows.template leftCols<J>());
  }
}

/// Calls body.operator()<N, J>() for the sizes of a table's elements.
template <int J, typename Body>
void with_points(const JetTable& table, const Body& body) {
  if (table.jets.cols() == kQuadPatchSize) return body.template operator()<kQuadPatchSize, J>();
  if (table.jets.cols() == kTrianglePatchSize) return body.template operator()<kTrianglePatchSize, J>();
  body.template operator()<Eigen::Dynamic, J>();
}
template <typename Body>
void with_sizes(ShapeEnergyKind kind, const JetTable& table, const Body& body) {
  switch (kind) {
    case ShapeEnergyKind::Stretch:
      return with_points<2>(table, body);
    case ShapeEnergyKind::Bending:
      return with_points<5>(table, body);
    case ShapeEnergyKind::Variation:
      return with_points<9>(table, body);
  }
}

/// Adds the squares of a place's linear forms, four rows of `count` numbers: F^T F.
template <int N>
inline void add_squares(const double* f, Eigen::Index size, double* matrix) {
  const Eigen::Index count = N > 0 ? N : size;
  const double* const f1 = f + count;
  const double* const f2 = f1 + count;
  const double* const f3 = f2 + count;
  for (Eigen::Index i = 0; i < count; ++i) {
    double* const row = matrix + i * count;
    for (Eigen::Index j = 0; j < count; ++j) {
      row[j] += (f[i] * f[j] + f1[i] * f1[j]) + (f2[i] * f2[j] + f3[i] * f3[j]);
    }
  }
}

}  // namespace

void shape_matrix(ShapeEnergyKind kind, const JetTable& table, std::span<const Index> vertices,
                  ConstValuesRef reference, ShapeScratch& scratch, double* matrix) {
  gather(vertices, reference, scratch);
  const Eigen::Index count = table.jets.cols();
  const int rows = shape_row_count(kind);
  std::fill(matrix, matrix + count * count, 0.0);
  scratch.forms.setZero(kMostShapeRows, count);
  with_sizes(kind, table, [&]<int N, int J>() {
    using Forms = Eigen::Map<Eigen::Matrix<double, kMostShapeRows, N, Eigen::RowMajor>>;
    Forms forms(scratch.forms.data(), kMostShapeRows, count);
    visit_places<N, J>(kind, table, scratch, [&](double weight, const auto& jets, auto by_jet) {
      by_jet *= std::sqrt(weight);
      forms.topRows(rows).noalias() = by_jet.lazyProduct(jets);
      add_squares<N>(forms.data(), count, matrix);
    });
  });
}

double shape_energy_of(ShapeEnergyKind kind, const JetTable& table, std::span<const Index> vertices,
                       ConstValuesRef control, ShapeScratch& scratch) {
  gather(vertices, control, scratch);
  double sum = 0.0;
  with_sizes(kind, table, [&]<int N, int J>() {
    visit_places<N, J>(kind, table, scratch, [&](double weight, const auto& /*jets*/, const auto& by_jet) {
      sum += weight * by_jet.lazyProduct(scratch.jet.template topRows<J>()).squaredNorm();
    });
  });
  return sum;
}

void shape_gradient(ShapeEnergyKind kind, const JetTable& table, std::span<const Index> vertices,
                    ConstValuesRef reference, ShapeScratch& scratch, double* gradient) {
  gather(vertices, reference, scratch);
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> sum(
      gradient, static_cast<Eigen::Index>(vertices.size()), 3);
  with_sizes(kind, table, [&]<int N, int J>() {
    visit_places<N, J>(kind, table, scratch, [&](double weight, const auto& jets, const auto& by_jet) {
      const auto values = by_jet.lazyProduct(scratch.jet.template topRows<J>()).eval();
      const auto by_derivatives = (weight * by_jet.transpose().lazyProduct(values)).eval();
      sum += jets.transpose().lazyProduct(by_derivatives);
    });
  });
}

}  // namespace batten
