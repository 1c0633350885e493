#include "batten/energy/shape_elements.h"

#include <algorithm>
#include <cmath>

namespace batten {

namespace {

/// Calls visit(weights of the places' areas, weights of the jets by points, jet, rows) for each place of a batch. N:
/// the points, or 0 where `count` tells; J: the rows of a jet. The weight is 0 where there is no tangent plane.
template <int N, int J, typename Visit>
void visit_places(ShapeEnergyKind kind, const JetTable& table, const Double4* points, const Visit& visit) {
  const std::ptrdiff_t count = N > 0 ? N : table.jets.cols();
  ShapeJet jet;
  ShapeRows rows;
  for (std::size_t p = 0; p < table.weights.size(); ++p) {
    const double* const weights = table.jets.data() + static_cast<std::ptrdiff_t>(p) * J * count;
    for (int r = 0; r < J; ++r) {
      FourVectors sum{};
      for (std::ptrdiff_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) sum[c] += weights[r * count + i] * points[3 * i + c];
      jet[r] = sum;
    }
    const Double4 area = shape_rows(kind, jet, rows);
    visit(table.weights[p] * area, weights, jet, rows);
  }
}

/// Calls body.operator()<N, J, R>() for the sizes of a table's elements; R: the squares of an integrand.
template <int J, int R, typename Body>
void with_points(const JetTable& table, const Body& body) {
  if (table.jets.cols() == kQuadPatchSize) return body.template operator()<kQuadPatchSize, J, R>();
  if (table.jets.cols() == kTrianglePatchSize) return body.template operator()<kTrianglePatchSize, J, R>();
  body.template operator()<0, J, R>();
}
template <typename Body>
void with_sizes(ShapeEnergyKind kind, const JetTable& table, const Body& body) {
  switch (kind) {
    case ShapeEnergyKind::Stretch:
      return with_points<2, 2>(table, body);
    case ShapeEnergyKind::Bending:
      return with_points<5, 3>(table, body);
    case ShapeEnergyKind::Variation:
      return with_points<9, 4>(table, body);
  }
}

/// forms: R linear forms of the points, one after the other. Adds their squares to the lower half of a matrix.
template <int N, int R>
void add_squares(const Double4* forms, std::ptrdiff_t size, Double4* half) {
  const std::ptrdiff_t count = N > 0 ? N : size;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    for (std::ptrdiff_t j = 0; j <= i; ++j, ++half) {
      Double4 sum = *half;
      for (int r = 0; r < R; ++r) sum += forms[r * count + i] * forms[r * count + j];
      *half = sum;
    }
  }
}

/// A place's forms of its derivatives: rows * jet.
template <int J, int R>
std::array<FourVectors, R> form_values(const ShapeRows& rows, const ShapeJet& jet) {
  std::array<FourVectors, R> values{};
  for (int r = 0; r < R; ++r)
    for (int j = 0; j < J; ++j)
      for (int c = 0; c < 3; ++c) values[r][c] += rows[r][j] * jet[j][c];
  return values;
}

}  // namespace

const JetTable& ShapeElements::gather(const ShapeBatch& batch, ShapeScratch& scratch) const {
  const std::size_t count = elements_.vertices(batch.first).size();
  scratch.points.resize(std::max(scratch.points.size(), 3 * count));
  for (int lane = 0; lane < 4; ++lane) {
    const std::span<const Index> vertices = elements_.vertices(batch.first + std::min(lane, batch.count - 1));
    for (std::size_t i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) scratch.points[3 * i + c][lane] = reference_(vertices[i], c);
  }
  return tables_[elements_.kind(batch.first)];
}

void ShapeElements::matrices(const ShapeBatch& batch, ShapeScratch& scratch, const ShapeTargets& matrix) const {
  const JetTable& table = gather(batch, scratch);
  const std::ptrdiff_t count = table.jets.cols();
  const auto half = static_cast<std::size_t>(count * (count + 1) / 2);
  scratch.sums.assign(half, Double4{});
  scratch.forms.resize(static_cast<std::size_t>(kMostShapeRows * count));
  with_sizes(kind_, table, [&]<int N, int J, int R>() {
    const std::ptrdiff_t size = N > 0 ? N : count;
    Double4* const forms = scratch.forms.data();
    visit_places<N, J>(kind_, table, scratch.points.data(),
                       [&](Double4 weight, const double* weights, const ShapeJet& /*jet*/, ShapeRows& rows) {
                         const Double4 scale = square_roots(weight);
                         for (int r = 0; r < R; ++r) {
                           for (int j = 0; j < J; ++j) rows[r][j] *= scale;
                           for (std::ptrdiff_t i = 0; i < size; ++i) {
                             Double4 sum{};
                             for (int j = 0; j < J; ++j) sum += rows[r][j] * weights[j * size + i];
                             forms[r * size + i] = sum;
                           }
                         }
                         add_squares<N, R>(forms, size, scratch.sums.data());
                       });
  });
  for (int lane = 0; lane < batch.count; ++lane) {
    const Double4* sum = scratch.sums.data();
    for (std::ptrdiff_t i = 0; i < count; ++i)
      for (std::ptrdiff_t j = 0; j <= i; ++j, ++sum)
        matrix[lane][i * count + j] = matrix[lane][j * count + i] = (*sum)[lane];
  }
}

Double4 ShapeElements::energies(const ShapeBatch& batch, ShapeScratch& scratch) const {
  const JetTable& table = gather(batch, scratch);
  Double4 sum{};
  with_sizes(kind_, table, [&]<int N, int J, int R>() {
    visit_places<N, J>(kind_, table, scratch.points.data(),
                       [&](Double4 weight, const double* /*weights*/, const ShapeJet& jet, const ShapeRows& rows) {
                         Double4 squares{};
                         for (const FourVectors& value : form_values<J, R>(rows, jet))
                           for (int c = 0; c < 3; ++c) squares += value[c] * value[c];
                         sum += weight * squares;
                       });
  });
  return sum;
}

void ShapeElements::gradients(const ShapeBatch& batch, ShapeScratch& scratch, const ShapeTargets& gradient) const {
  const JetTable& table = gather(batch, scratch);
  const std::ptrdiff_t count = table.jets.cols();
  scratch.sums.assign(static_cast<std::size_t>(3 * count), Double4{});
  with_sizes(kind_, table, [&]<int N, int J, int R>() {
    const std::ptrdiff_t size = N > 0 ? N : count;
    visit_places<N, J>(kind_, table, scratch.points.data(),
                       [&](Double4 weight, const double* weights, const ShapeJet& jet, const ShapeRows& rows) {
                         const std::array<FourVectors, R> values = form_values<J, R>(rows, jet);
                         for (int j = 0; j < J; ++j) {
                           FourVectors pull{};
                           for (int r = 0; r < R; ++r)
                             for (int c = 0; c < 3; ++c) pull[c] += weight * rows[r][j] * values[r][c];
                           for (std::ptrdiff_t i = 0; i < size; ++i)
                             for (int c = 0; c < 3; ++c) scratch.sums[3 * i + c] += weights[j * size + i] * pull[c];
                         }
                       });
  });
  for (int lane = 0; lane < batch.count; ++lane)
    for (std::ptrdiff_t i = 0; i < 3 * count; ++i) gradient[lane][i] += scratch.sums[i][lane];
}

}  // namespace batten
