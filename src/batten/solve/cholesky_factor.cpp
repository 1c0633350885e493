#include "batten/solve/cholesky_factor.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "batten/solve/front.h"

namespace batten {

namespace {

using Matrix = CholeskyFactor::Matrix;

/// Where the rows of supernodes stand in a front.
class FrontRows {
 public:
  explicit FrontRows(std::size_t count) : places_(count) {}

  void set(const int* rows, int count) {
    for (int i = 0; i < count; ++i) places_[rows[i]] = i;
  }
  int operator[](int row) const { return places_[row]; }

 private:
  Buffer<int> places_;
};

/// Adds the lower triangle of the matrix's columns of a supernode.
void add_matrix(const Matrix& matrix, const Elimination& elimination, int node, const FrontRows& rows, Front& front) {
  const int first = elimination.first_column(node);
  for (int j = 0; j < elimination.width(node); ++j) {
    double* const column = front.column(j);
    for (Matrix::InnerIterator e(matrix, elimination.places()[first + j]); e; ++e) {
      const int row = elimination.order()[e.col()];
      if (row >= first + j) column[rows[row]] += e.value();
    }
  }
}

/// Adds what a child's columns have left, `rest`, whose rows are `rest_rows`.
void add_child(const Front& rest, const int* rest_rows, const FrontRows& rows, Buffer<int>& places, Front& front) {
  places.resize(static_cast<std::size_t>(rest.size));
  for (int i = 0; i < rest.size; ++i) places[i] = rows[rest_rows[i]];
  for (int j = 0; j < rest.size; ++j) {
    const double* const from = rest.column(j);
    double* const to = front.column(places[j]);
    for (int i = j; i < rest.size; ++i) to[places[i]] += from[i];
  }
}

/// The Schur complement that a front's first `width` columns have left.
Front rest_of(const Front& front, int width) {
  Front rest;
  rest.size = front.size - width;
  rest.entries.resize(static_cast<std::size_t>(rest.size) * static_cast<std::size_t>(rest.size));
  for (int j = 0; j < rest.size; ++j) {
    const double* const from = front.column(width + j) + width;
    std::copy(from + j, from + rest.size, rest.column(j) + j);
  }
  return rest;
}

}  // namespace

CholeskyFactor::CholeskyFactor(const Matrix& matrix) : elimination_(matrix) {
  starts_.push_back(0);
  for (int s = 0; s < elimination_.count(); ++s) {
    starts_.push_back(starts_.back() + static_cast<std::size_t>(elimination_.width(s)) *
                                           static_cast<std::size_t>(elimination_.row_count(s)));
  }
  entries_.resize(starts_.back());
  factor(matrix);
}

/// Children stand before their parents, and the subtrees one after the other: the rests are a stack.
void CholeskyFactor::factor(const Matrix& matrix) {
  struct Waiting {
    int node;
    Front rest;
  };
  std::vector<Waiting> stack;
  FrontRows rows(elimination_.order().size());
  Front front;
  Buffer<int> places;
  Buffer<double> diagonal;
  least_pivot_ = 1.0;
  for (int s = 0; s < elimination_.count(); ++s) {
    const int width = elimination_.width(s);
    front.reset(elimination_.row_count(s));
    rows.set(elimination_.rows(s), front.size);
    add_matrix(matrix, elimination_, s, rows, front);
    diagonal.clear();
    for (int j = 0; j < width; ++j) diagonal.push_back(front.column(j)[j]);
    while (!stack.empty() && elimination_.parent(stack.back().node) == s) {
      const Waiting& child = stack.back();
      add_child(child.rest, elimination_.rows(child.node) + elimination_.width(child.node), rows, places, front);
      stack.pop_back();
    }
    const double pivot = factor_front(front, width, diagonal.data());
    if (pivot < 0.0) return;
    least_pivot_ = std::min(least_pivot_, pivot);
    for (int j = 0; j < width; ++j) {
      std::copy(front.column(j), front.column(j) + front.size,
                entries_.begin() + static_cast<std::ptrdiff_t>(starts_[s] + static_cast<std::size_t>(j) *
                                                                                static_cast<std::size_t>(front.size)));
    }
    if (front.size > width) stack.push_back({s, rest_of(front, width)});
  }
  positive_ = true;
}

void CholeskyFactor::solve_four(Buffer<Double4>& x) const {
  Buffer<Double4> below;
  for (int s = 0; s < elimination_.count(); ++s) {
    const int width = elimination_.width(s);
    const int size = elimination_.row_count(s);
    const int* const rows = elimination_.rows(s);
    Double4* const own = x.data() + elimination_.first_column(s);
    below.assign(static_cast<std::size_t>(size - width), Double4{});
    for (int j = 0; j < width; ++j) {
      const double* const column =
          entries_.data() + starts_[s] + static_cast<std::size_t>(j) * static_cast<std::size_t>(size);
      const Double4 value = own[j] / column[j];
      own[j] = value;
      for (int i = j + 1; i < width; ++i) own[i] -= column[i] * value;
      for (int i = width; i < size; ++i) below[i - width] += column[i] * value;
    }
    for (int i = width; i < size; ++i) x[rows[i]] -= below[i - width];
  }
  for (int s = elimination_.count() - 1; s >= 0; --s) {
    const int width = elimination_.width(s);
    const int size = elimination_.row_count(s);
    const int* const rows = elimination_.rows(s);
    Double4* const own = x.data() + elimination_.first_column(s);
    below.resize(static_cast<std::size_t>(size - width));
    for (int i = width; i < size; ++i) below[i - width] = x[rows[i]];
    for (int j = width - 1; j >= 0; --j) {
      const double* const column =
          entries_.data() + starts_[s] + static_cast<std::size_t>(j) * static_cast<std::size_t>(size);
      Double4 even = own[j];
      Double4 odd{};
      for (int i = j + 1; i < width; ++i) even -= column[i] * own[i];
      int i = width;
      for (; i + 1 < size; i += 2) {
        even -= column[i] * below[i - width];
        odd -= column[i + 1] * below[i + 1 - width];
      }
      if (i < size) even -= column[i] * below[i - width];
      own[j] = (even + odd) / column[j];
    }
  }
}

void CholeskyFactor::solve(const Values& b, Values& x) const {
  x.resize(b.rows(), b.cols());
  const Buffer<int>& order = elimination_.order();
  Buffer<Double4> four(static_cast<std::size_t>(b.rows()));
  for (Eigen::Index first = 0; first < b.cols(); first += 4) {
    const Eigen::Index columns = std::min<Eigen::Index>(4, b.cols() - first);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      Double4 row{};
      for (Eigen::Index c = 0; c < columns; ++c) row[c] = b(i, first + c);
      four[order[i]] = row;
    }
    solve_four(four);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      for (Eigen::Index c = 0; c < columns; ++c) x(i, first + c) = four[order[i]][c];
    }
  }
}

}  // namespace batten
