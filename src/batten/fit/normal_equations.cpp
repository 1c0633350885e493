#include "batten/fit/normal_equations.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"
#include "batten/solve/krylov.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kRowBlock = 64;
/// Each block of rows has a table of all columns.
constexpr std::ptrdiff_t kMostBlocks = 64;

/// Which places each control point has a weight in.
struct PlacesOfPoints {
  struct Use {
    Index place;
    double weight;
  };
  Buffer<Index> starts;
  Buffer<Use> uses;

  explicit PlacesOfPoints(const NormalEquations::Matrix& rows)
      : starts(static_cast<std::size_t>(rows.cols()) + 1, 0), uses(static_cast<std::size_t>(rows.nonZeros())) {
    const int* columns = rows.innerIndexPtr();
    for (Eigen::Index i = 0; i < rows.nonZeros(); ++i) ++starts[columns[i] + 1];
    for (std::size_t v = 1; v < starts.size(); ++v) starts[v] += starts[v - 1];
    Buffer<Index> next(starts.begin(), starts.end() - 1);
    for (Index place = 0; place < static_cast<Index>(rows.rows()); ++place) {
      for (NormalEquations::Matrix::InnerIterator entry(rows, place); entry; ++entry)
        uses[next[entry.col()]++] = {place, entry.value()};
    }
  }
};

void add_scaled(double factor, const Form& from, Form& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

/// Takes from each row its part along the normal.
void project(const Values& normals, Values& moves) {
  for (Eigen::Index v = 0; v < moves.rows(); ++v) moves.row(v) -= moves.row(v).dot(normals.row(v)) * normals.row(v);
}

Eigen::Matrix3d matrix_of(const Form& form) {
  Eigen::Matrix3d matrix;
  matrix << form[0], form[1], form[2], form[1], form[3], form[4], form[2], form[4], form[5];
  return matrix;
}

}  // namespace

NormalEquations::NormalEquations(const Matrix& energy)
    : energy_(energy), blocks_(static_cast<std::size_t>(energy_.nonZeros())), right_(Values::Zero(energy_.rows(), 3)) {}

void NormalEquations::assemble(const Matrix& rows, std::span<const Form> forms, const Points& offsets) {
  const PlacesOfPoints places(rows);
  parallel_for(
      energy_.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Buffer<Index> entry_of(static_cast<std::size_t>(energy_.cols()), -1);
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          const int first = energy_.outerIndexPtr()[v];
          const int last = energy_.outerIndexPtr()[v + 1];
          for (int i = first; i < last; ++i) {
            entry_of[energy_.innerIndexPtr()[i]] = i;
            blocks_[i] = {};
          }
          Eigen::Vector3d right = Eigen::Vector3d::Zero();
          for (Index use = places.starts[v]; use < places.starts[v + 1]; ++use) {
            const auto [place, weight] = places.uses[use];
            const Form& form = forms[place];
            right += weight * multiply(form, offsets.row(place).transpose());
            for (Matrix::InnerIterator entry(rows, place); entry; ++entry)
              add_scaled(weight * entry.value(), form, blocks_[entry_of[entry.col()]]);
          }
          right_.row(v) = right.transpose();
        }
      },
      std::max(kRowBlock, energy_.rows() / kMostBlocks));
  double trace = 0.0;
  for (Index v = 0; v < static_cast<Index>(energy_.rows()); ++v) {
    for (int i = energy_.outerIndexPtr()[v]; i < energy_.outerIndexPtr()[v + 1]; ++i) {
      if (energy_.innerIndexPtr()[i] == v) trace += blocks_[i][0] + blocks_[i][3] + blocks_[i][5];
    }
  }
  mean_diagonal_ = trace / std::max(3.0 * static_cast<double>(energy_.rows()), 1.0);
}

void NormalEquations::multiply_blocks(const Values& x, double fairness, double own, Values& y) const {
  y.resize(x.rows(), 3);
  parallel_for(
      x.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t v = begin; v < end; ++v) {
          double sum[3] = {own * x(v, 0), own * x(v, 1), own * x(v, 2)};
          for (int i = energy_.outerIndexPtr()[v]; i < energy_.outerIndexPtr()[v + 1]; ++i) {
            const double* from = x.data() + 3 * static_cast<std::ptrdiff_t>(energy_.innerIndexPtr()[i]);
            const Form& form = blocks_[i];
            const double fair = fairness * energy_.valuePtr()[i];
            sum[0] += (form[0] + fair) * from[0] + form[1] * from[1] + form[2] * from[2];
            sum[1] += form[1] * from[0] + (form[3] + fair) * from[1] + form[4] * from[2];
            sum[2] += form[2] * from[0] + form[4] * from[1] + (form[5] + fair) * from[2];
          }
          for (int c = 0; c < 3; ++c) y(v, c) = sum[c];
        }
      },
      256);
}

Values NormalEquations::solve(const Values& control, const Values& normals, const Fairness& fairness,
                              const StopRule& stop, SolveReport& report, const GivenMoves& given) const {
  const double own = fairness.damping * mean_diagonal_;
  Values work;
  Values right;
  multiply(energy_, control, right);
  work = right;
  project(normals, work);
  work = fairness.stiffness.asDiagonal() * work;
  right = right_ - fairness.all * right - fairness.tangent * work;
  const std::vector<Eigen::Matrix3d> inverses = invert_diagonal(normals, fairness, own);
  const auto keep_free = [&](Values& values) {
    for (std::size_t v = 0; v < given.flags.size(); ++v) {
      if (given.flags[v] != 0) values.row(static_cast<Eigen::Index>(v)).setZero();
    }
  };
  const LinearMap precondition = [&](const Values& from, Values& to) {
    to.resize(from.rows(), 3);
    for (Eigen::Index v = 0; v < from.rows(); ++v)
      to.row(v) = (inverses[static_cast<std::size_t>(v)] * from.row(v).transpose()).transpose();
  };
  Values in_planes;
  const Scalars roots = fairness.stiffness.cwiseSqrt();
  const LinearMap product = [&](const Values& from, Values& to) {
    multiply_blocks(from, fairness.all, own, to);
    work = roots.asDiagonal() * from;
    project(normals, work);
    multiply(energy_, work, in_planes);
    project(normals, in_planes);
    to += fairness.tangent * (roots.asDiagonal() * in_planes);
  };
  Values x;
  precondition(right, x);
  StopRule within = stop;
  within.tolerance *= std::sqrt(std::max(0.0, right.cwiseProduct(x).sum()));
  Values start = Values::Zero(control.rows(), 3);
  for (std::size_t v = 0; v < given.flags.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    if (given.flags[v] != 0) start.row(row) = given.moves.row(row);
  }
  if (!given.flags.empty()) {
    product(start, x);
    right -= x;
    keep_free(right);
  }
  const LinearMap free_product = [&](const Values& from, Values& to) {
    product(from, to);
    keep_free(to);
  };
  x.setZero();
  report = conjugate_gradients(free_product, precondition, Coefficients::Joint, right, x, within);
  return start + x;
}

std::vector<Eigen::Matrix3d> NormalEquations::invert_diagonal(const Values& normals, const Fairness& fairness,
                                                              double own) const {
  std::vector<Eigen::Matrix3d> inverses(static_cast<std::size_t>(energy_.rows()), Eigen::Matrix3d::Identity());
  for (Index v = 0; v < static_cast<Index>(energy_.rows()); ++v) {
    const Eigen::Vector3d normal = normals.row(v).transpose();
    for (int i = energy_.outerIndexPtr()[v]; i < energy_.outerIndexPtr()[v + 1]; ++i) {
      if (energy_.innerIndexPtr()[i] != v) continue;
      const double energy = energy_.valuePtr()[i];
      const double tangent = fairness.tangent * fairness.stiffness[v] * energy;
      Eigen::Matrix3d block = matrix_of(blocks_[i]) - tangent * normal * normal.transpose();
      block.diagonal().array() += fairness.all * energy + tangent + own;
      if (block.determinant() > 0.0) inverses[static_cast<std::size_t>(v)] = block.inverse();
    }
  }
  return inverses;
}

}  // namespace batten
