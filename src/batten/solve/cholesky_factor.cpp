#include "batten/solve/cholesky_factor.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "batten/parallel/parallel.h"
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
  split_tree();
  list_places();
  factor(matrix);
}

/// Cuts the tree from its roots down until no part is large. The cut depends on the matrix alone.
void CholeskyFactor::split_tree() {
  constexpr double kShare = 1.0 / 16.0;
  constexpr double kSmall = 2e5;  // entries that one thread goes through as fast as two
  const int count = elimination_.count();
  std::vector<Subtree> trees(static_cast<std::size_t>(count));
  Buffer<double> work(static_cast<std::size_t>(count), 0.0);
  Buffer<int> roots;
  double total = 0.0;
  for (int s = 0; s < count; ++s) {
    trees[static_cast<std::size_t>(s)] = {s, s};
    const double own = static_cast<double>(starts_[s + 1] - starts_[s]);
    work[s] += own;
    total += own;
  }
  for (int s = 0; s < count; ++s) {
    const int parent = elimination_.parent(s);
    if (parent < 0) {
      roots.push_back(s);
      continue;
    }
    work[parent] += work[s];
    Subtree& tree = trees[static_cast<std::size_t>(parent)];
    tree.first = std::min(tree.first, trees[static_cast<std::size_t>(s)].first);
  }
  const double most = std::max(kSmall, kShare * total);
  while (!roots.empty()) {
    const int root = roots.back();
    roots.pop_back();
    if (work[root] <= most) {
      subtrees_.push_back(trees[static_cast<std::size_t>(root)]);
      continue;
    }
    top_.push_back(root);
    for (int s = root - 1; s >= trees[static_cast<std::size_t>(root)].first;
         s = trees[static_cast<std::size_t>(s)].first - 1) {
      roots.push_back(s);  // children end where the next one's subtree begins
    }
  }
  std::sort(top_.begin(), top_.end());
  std::sort(subtrees_.begin(), subtrees_.end(), [](const Subtree& a, const Subtree& b) { return a.root < b.root; });
}

void CholeskyFactor::list_places() {
  const int count = elimination_.count();
  inside_.resize(static_cast<std::size_t>(count));
  for (int s = 0; s < count; ++s) inside_[s] = elimination_.row_count(s);
  place_starts_.assign(static_cast<std::size_t>(count), 0);
  Buffer<int> place_of(elimination_.order().size());
  for (const Subtree& tree : subtrees_) {
    const int end = elimination_.first_column(tree.root) + elimination_.width(tree.root);
    const int* const below = elimination_.rows(tree.root) + elimination_.width(tree.root);
    for (int i = 0; i < elimination_.row_count(tree.root) - elimination_.width(tree.root); ++i) place_of[below[i]] = i;
    for (int s = tree.first; s <= tree.root; ++s) {
      const int* const rows = elimination_.rows(s);
      const int* const last = rows + elimination_.row_count(s);
      inside_[s] = static_cast<int>(std::lower_bound(rows, last, end) - rows);
      place_starts_[s] = places_.size();
      for (const int* row = rows + inside_[s]; row < last; ++row) places_.push_back(place_of[*row]);
    }
  }
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

/// Solves for the supernode's own columns; `below` becomes what they take from the rows below.
void CholeskyFactor::eliminate(int node, Buffer<Double4>& x, Buffer<Double4>& below) const {
  const int width = elimination_.width(node);
  const int size = elimination_.row_count(node);
  Double4* const own = x.data() + elimination_.first_column(node);
  below.assign(static_cast<std::size_t>(size - width), Double4{});
  for (int j = 0; j < width; ++j) {
    const double* const weights = column(node, j);
    const Double4 value = own[j] / weights[j];
    own[j] = value;
    for (int i = j + 1; i < width; ++i) own[i] -= weights[i] * value;
    for (int i = width; i < size; ++i) below[i - width] += weights[i] * value;
  }
}

/// Back substitution for the supernode's own columns.
void CholeskyFactor::substitute(int node, Buffer<Double4>& x, Buffer<Double4>& below) const {
  const int width = elimination_.width(node);
  const int size = elimination_.row_count(node);
  const int* const rows = elimination_.rows(node);
  Double4* const own = x.data() + elimination_.first_column(node);
  below.resize(static_cast<std::size_t>(size - width));
  for (int i = width; i < size; ++i) below[i - width] = x[rows[i]];
  for (int j = width - 1; j >= 0; --j) {
    const double* const weights = column(node, j);
    Double4 even = own[j];
    Double4 odd{};
    for (int i = j + 1; i < width; ++i) even -= weights[i] * own[i];
    int i = width;
    for (; i + 1 < size; i += 2) {
      even -= weights[i] * below[i - width];
      odd -= weights[i + 1] * below[i + 1 - width];
    }
    if (i < size) even -= weights[i] * below[i - width];
    own[j] = (even + odd) / weights[j];
  }
}

void CholeskyFactor::solve_four(Buffer<Double4>& x) const {
  std::vector<Buffer<Double4>> outside(subtrees_.size());
  parallel_for_each(static_cast<std::ptrdiff_t>(subtrees_.size()), [&](std::ptrdiff_t t) {
    const Subtree& tree = subtrees_[static_cast<std::size_t>(t)];
    Buffer<Double4>& sums = outside[static_cast<std::size_t>(t)];
    sums.assign(static_cast<std::size_t>(elimination_.row_count(tree.root) - elimination_.width(tree.root)), Double4{});
    Buffer<Double4> below;
    for (int s = tree.first; s <= tree.root; ++s) {
      eliminate(s, x, below);
      const int width = elimination_.width(s);
      const int* const rows = elimination_.rows(s);
      for (int i = width; i < inside_[s]; ++i) x[rows[i]] -= below[i - width];
      const int* const places = places_.data() + place_starts_[s];
      for (int i = inside_[s]; i < elimination_.row_count(s); ++i) sums[places[i - inside_[s]]] += below[i - width];
    }
  });
  for (std::size_t t = 0; t < subtrees_.size(); ++t) {
    const int root = subtrees_[t].root;
    const int* const rows = elimination_.rows(root) + elimination_.width(root);
    for (std::size_t i = 0; i < outside[t].size(); ++i) x[rows[i]] -= outside[t][i];
  }
  Buffer<Double4> below;
  for (const int s : top_) {
    eliminate(s, x, below);
    const int* const rows = elimination_.rows(s) + elimination_.width(s);
    for (std::size_t i = 0; i < below.size(); ++i) x[rows[i]] -= below[i];
  }
  for (std::size_t i = top_.size(); i-- > 0;) substitute(top_[i], x, below);
  parallel_for_each(static_cast<std::ptrdiff_t>(subtrees_.size()), [&](std::ptrdiff_t t) {
    const Subtree& tree = subtrees_[static_cast<std::size_t>(t)];
    Buffer<Double4> scratch;
    for (int s = tree.root; s >= tree.first; --s) substitute(s, x, scratch);
  });
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
