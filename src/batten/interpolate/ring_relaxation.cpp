#include "batten/interpolate/ring_relaxation.h"

#include <algorithm>

#include "batten/parallel/parallel.h"
#include "batten/solve/krylov.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

constexpr double kRelativeResidual = 1e-4;  // limits hold exactly whatever it is; more would change no picture
constexpr int kMostIterations = 1000;
constexpr std::ptrdiff_t kRowBlock = 512;

/// The weights of a mask on a ring's vertices. Loop's rings have no vertices across faces.
void write_mask(const RingMask& mask, Eigen::Ref<Eigen::VectorXd> column) {
  const auto edges = static_cast<Eigen::Index>(mask.edges.size());
  column[0] = mask.vertex;
  for (Eigen::Index j = 0; j < edges; ++j) column[1 + j] = mask.edges[j];
  for (Eigen::Index j = 0; j < column.size() - 1 - edges; ++j) column[1 + edges + j] = mask.faces[j];
}

Points orthonormal_masks(const FrameMasks& masks, Eigen::Index count) {
  Eigen::MatrixX3d columns(count, 3);
  write_mask(masks.position, columns.col(0));
  write_mask(masks.tangents.first, columns.col(1));
  write_mask(masks.tangents.second, columns.col(2));
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (int round = 0; round < 2; ++round) {
      for (Eigen::Index j = 0; j < i; ++j) columns.col(i) -= columns.col(j).dot(columns.col(i)) * columns.col(j);
    }
    columns.col(i).normalize();
  }
  return columns;
}

}  // namespace

HeldLimits::HeldLimits(const VertexFrames& frames, Index count) : rings_(static_cast<std::size_t>(count)) {
  const auto hold = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    FrameRing ring;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      frames.find(static_cast<Index>(v), ring);
      rings_[v].vertices = ring.vertices;
      const bool plane =
          ring.masks != nullptr && (ring.masks->kind == FrameKind::Interior || ring.masks->kind == FrameKind::Boundary);
      if (plane) rings_[v].masks = orthonormal_masks(*ring.masks, static_cast<Eigen::Index>(ring.vertices.size()));
    }
  };
  parallel_for(count, hold, kRowBlock);
}

void HeldLimits::project(Values& displacement) const {
  const auto project_ring = [&](const Ring& ring) {
    const auto count = static_cast<Eigen::Index>(ring.vertices.size());
    if (ring.masks.rows() == 0) {
      for (const Index v : ring.vertices) displacement.row(v).setZero();
      return;
    }
    Eigen::Matrix3d parts = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < count; ++i)
      parts += ring.masks.row(i).transpose() * displacement.row(ring.vertices[i]);
    for (Eigen::Index i = 0; i < count; ++i) displacement.row(ring.vertices[i]) -= ring.masks.row(i) * parts;
  };
  parallel_for(
      static_cast<std::ptrdiff_t>(rings_.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) project_ring(rings_[i]);
      },
      kRowBlock);
}

int relax_displacement(const SurfaceEnergy::Matrix& thin_plate, const HeldLimits& held, Values& displacement,
                       const Progress& progress) {
  Values pull;
  multiply(thin_plate, displacement, pull);
  pull = -pull;
  held.project(pull);
  const double largest = max_row_norm(pull);
  if (!(largest > 0.0)) return 0;
  Values free(pull.rows(), 3);
  const LinearMap map = [&](const Values& x, Values& y) {
    free = x;
    held.project(free);
    multiply(thin_plate, free, y);
    held.project(y);
  };
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(pull.rows());
  Values moved = Values::Zero(pull.rows(), 3);
  const SolveReport report =
      conjugate_gradients(map, ones, ones, pull, moved, {kRelativeResidual * largest, kMostIterations, progress});
  held.project(moved);
  displacement += moved;
  return report.iterations;
}

double quadratic_form(const SurfaceEnergy::Matrix& matrix, const Values& values) {
  Values product;
  multiply(matrix, values, product);
  const auto sum_rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    return values.middleRows(begin, end - begin).cwiseProduct(product.middleRows(begin, end - begin)).sum();
  };
  return 0.5 * parallel_reduce(
                   values.rows(), 0.0, sum_rows, [](double a, double b) { return a + b; }, kRowBlock);
}

}  // namespace batten
