#include "batten/solve/cholesky_factor.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "batten/parallel/parallel.h"
#include "batten/released_memory.h"
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

/// Adds the lower triangle of the matrix's columns of a supernode. scale: as scale_, or null.
template <typename Number>
void add_matrix(const Matrix& pattern, const CholeskyFactor::EntryValue& value, const double* scale,
                const Elimination& elimination, int node, const FrontRows& rows, Front<Number>& front) {
  const int first = elimination.first_column(node);
  for (int j = 0; j < elimination.width(node); ++j) {
    Number* const column = front.column(j);
    const int from = elimination.places()[first + j];
    for (int e = pattern.outerIndexPtr()[from]; e < pattern.outerIndexPtr()[from + 1]; ++e) {
      const int to = pattern.innerIndexPtr()[e];
      const int row = elimination.order()[to];
      if (row < first + j) continue;
      const double number = scale == nullptr ? value(e) : scale[from] * value(e) * scale[to];
      column[rows[row]] += static_cast<Number>(number);
    }
  }
}

/// Adds what a child's columns have left, `rest`, whose rows are `rest_rows`.
template <typename Number>
void add_child(const Front<Number>& rest, const int* rest_rows, const FrontRows& rows, Buffer<int>& places,
               Front<Number>& front) {
  places.resize(static_cast<std::size_t>(rest.size));
  for (int i = 0; i < rest.size; ++i) places[i] = rows[rest_rows[i]];
  for (int j = 0; j < rest.size; ++j) {
    const Number* const from = rest.column(j);
    Number* const to = front.column(places[j]);
    for (int i = j; i < rest.size; ++i) to[places[i]] += from[i];
  }
}

/// The Schur complement that a front's first `width` columns have left: the end of its entries.
template <typename Number>
Front<Number> rest_of(const Front<Number>& front, int width) {
  Front<Number> rest;
  rest.size = front.size - width;
  const auto begin = static_cast<std::ptrdiff_t>(Front<Number>::entry_count(front.size, width));
  rest.entries.assign(front.entries.begin() + begin, front.entries.end());
  return rest;
}

/// One of the columns of a supernode with `size` rows: row i stands at [i], for i >= j.
template <typename Number>
const Number* column_of(const Number* entries, int size, int j) {
  return entries + Front<Number>::entry_count(size, j) - j;
}

/// Columns that are taken together: each row is loaded once for all of them.
constexpr int kTogether = 4;
/// Columns of a large block after which threads take the rows below, or these columns' sums, and the entries that are
/// worth it.
constexpr int kPanelColumns = 256;
constexpr std::ptrdiff_t kWorthThreads = 100'000;
constexpr std::ptrdiff_t kRowsOfTask = 256;

/// local[begin .. end) loses what columns j to j + Count take from it.
template <int Count, typename Number, typename Row>
void take_columns(const Number* entries, int size, int j, int begin, int end, Row* local) {
  const Number* columns[Count];
  Row values[Count];
  for (int c = 0; c < Count; ++c) {
    columns[c] = column_of(entries, size, j + c);
    values[c] = local[j + c];
  }
  for (int i = begin; i < end; ++i) {
    Row row = local[i];
    for (int c = 0; c < Count; ++c) row -= columns[c][i] * values[c];
    local[i] = row;
  }
}

/// Solves for the rows of columns j to j + Count, which have lost what those before take.
template <int Count, typename Number, typename Row>
void solve_columns(const Number* entries, int size, int j, Row* local) {
  for (int c = 0; c < Count; ++c) {
    const Number* const column = column_of(entries, size, j + c);
    local[j + c] /= column[j + c];
    for (int i = c + 1; i < Count; ++i) local[j + i] -= column[j + i] * local[j + c];
  }
}

/// local[j .. j + Count) loses what the rows begin to end take from it. Two sums for each, so that an addition starts
/// before the last one has ended.
template <int Count, typename Number, typename Row>
void take_rows(const Number* entries, int size, int j, int begin, int end, Row* local) {
  const Number* columns[Count];
  Row sums[2][Count] = {};
  for (int c = 0; c < Count; ++c) columns[c] = column_of(entries, size, j + c);
  int i = begin;
  for (; i + 1 < end; i += 2) {
    const Row even = local[i];
    const Row odd = local[i + 1];
    for (int c = 0; c < Count; ++c) {
      sums[0][c] += columns[c][i] * even;
      sums[1][c] += columns[c][i + 1] * odd;
    }
  }
  for (int c = 0; c < Count; ++c) {
    if (i < end) sums[0][c] += columns[c][i] * local[i];
    local[j + c] -= sums[0][c] + sums[1][c];
  }
}

/// Solves backwards for the rows of columns j to j + Count, which have lost what the rows below take.
template <int Count, typename Number, typename Row>
void solve_rows(const Number* entries, int size, int j, Row* local) {
  for (int c = Count - 1; c >= 0; --c) {
    const Number* const column = column_of(entries, size, j + c);
    for (int i = c + 1; i < Count; ++i) local[j + c] -= column[j + i] * local[j + i];
    local[j + c] /= column[j + c];
  }
}

/// Calls work(std::integral_constant<int, count>, j) for groups of columns of begin to end, ascending.
template <typename Work>
void for_column_groups(int begin, int end, const Work& work) {
  int j = begin;
  for (; j + kTogether <= end; j += kTogether) work(std::integral_constant<int, kTogether>(), j);
  for (; j < end; ++j) work(std::integral_constant<int, 1>(), j);
}

/// The same groups, descending.
template <typename Work>
void for_column_groups_back(int begin, int end, const Work& work) {
  const int whole = begin + (end - begin) / kTogether * kTogether;
  for (int j = end - 1; j >= whole; --j) work(std::integral_constant<int, 1>(), j);
  for (int j = whole - kTogether; j >= begin; j -= kTogether) work(std::integral_constant<int, kTogether>(), j);
}

}  // namespace

CholeskyFactor::CholeskyFactor(const Matrix& matrix, FactorPrecision precision)
    : CholeskyFactor(matrix, precision, [&](std::ptrdiff_t entry) { return matrix.valuePtr()[entry]; }) {}

CholeskyFactor::CholeskyFactor(const Matrix& pattern, FactorPrecision precision, const EntryValue& value)
    : elimination_(pattern), precision_(precision) {
  starts_.push_back(0);
  for (int s = 0; s < elimination_.count(); ++s) {
    starts_.push_back(starts_.back() + Front<double>::entry_count(elimination_.row_count(s), elimination_.width(s)));
  }
  split_tree();
  list_places();
  release_freed_memory(sizeof(double) * starts_.back());  // of finding the order
  if (precision == FactorPrecision::Double) {
    std::get<Buffer<double>>(entries_).resize(starts_.back());
    factor<double>(pattern, value);
  } else {
    find_scale(pattern, value);
    std::get<Buffer<float>>(entries_).resize(starts_.back());
    factor<float>(pattern, value);
  }
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

/// One over the root of the diagonal; 0 where that is not positive, so that the pivot is neither.
void CholeskyFactor::find_scale(const Matrix& pattern, const EntryValue& value) {
  scale_.assign(static_cast<std::size_t>(pattern.rows()), 0.0);
  for (Eigen::Index row = 0; row < pattern.rows(); ++row) {
    for (int e = pattern.outerIndexPtr()[row]; e < pattern.outerIndexPtr()[row + 1]; ++e) {
      if (pattern.innerIndexPtr()[e] != row) continue;
      const double number = value(e);
      scale_[row] = number > 0.0 ? 1.0 / std::sqrt(number) : 0.0;
    }
  }
}

/// Children stand before their parents, and the subtrees one after the other: the rests are a stack.
template <typename Number>
void CholeskyFactor::factor(const Matrix& pattern, const EntryValue& value) {
  struct Waiting {
    int node;
    Front<Number> rest;
  };
  std::vector<Waiting> stack;
  FrontRows rows(elimination_.order().size());
  Front<Number> front;
  Buffer<int> places;
  Buffer<Number> diagonal;
  least_pivot_ = 1.0;
  for (int s = 0; s < elimination_.count(); ++s) {
    const int width = elimination_.width(s);
    front.reset(elimination_.row_count(s));
    rows.set(elimination_.rows(s), front.size);
    add_matrix(pattern, value, scale_.empty() ? nullptr : scale_.data(), elimination_, s, rows, front);
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
    std::copy_n(front.entries.begin(), starts_[s + 1] - starts_[s],
                std::get<Buffer<Number>>(entries_).begin() + static_cast<std::ptrdiff_t>(starts_[s]));
    if (front.size > width) stack.push_back({s, rest_of(front, width)});
  }
  positive_ = true;
}

/// Solves for the supernode's own columns; `local` becomes what they add to its rows.
template <typename Number>
void CholeskyFactor::eliminate(int node, Buffer<Row<Number>>& x, Buffer<Row<Number>>& local) const {
  const int width = elimination_.width(node);
  const int size = elimination_.row_count(node);
  const Number* const entries = node_entries<Number>(node);
  Row<Number>* const own = x.data() + elimination_.first_column(node);
  local.assign(static_cast<std::size_t>(size), Row<Number>{});
  std::copy_n(own, width, local.data());
  for (int begin = 0; begin < width; begin += kPanelColumns) {
    const int end = std::min(width, begin + kPanelColumns);
    const std::ptrdiff_t below = size - end;
    const bool shared = below * (end - begin) >= kWorthThreads;
    for_column_groups(begin, end, [&](auto count, int j) {
      solve_columns<count()>(entries, size, j, local.data());
      take_columns<count()>(entries, size, j, j + count(), shared ? end : size, local.data());
    });
    if (!shared) continue;
    parallel_for(
        below,
        [&](std::ptrdiff_t first, std::ptrdiff_t last) {
          for_column_groups(begin, end, [&](auto count, int j) {
            take_columns<count()>(entries, size, j, end + static_cast<int>(first), end + static_cast<int>(last),
                                  local.data());
          });
        },
        kRowsOfTask);
  }
  std::copy_n(local.data(), width, own);
}

/// Back substitution for the supernode's own columns.
template <typename Number>
void CholeskyFactor::substitute(int node, Buffer<Row<Number>>& x, Buffer<Row<Number>>& local) const {
  const int width = elimination_.width(node);
  const int size = elimination_.row_count(node);
  const int* const rows = elimination_.rows(node);
  const Number* const entries = node_entries<Number>(node);
  local.resize(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) local[i] = x[rows[i]];
  for (int end = width; end > 0;) {
    const int begin = (end - 1) / kPanelColumns * kPanelColumns;
    const std::ptrdiff_t groups = (end - begin + kTogether - 1) / kTogether;
    const bool shared = std::ptrdiff_t{size - end} * (end - begin) >= kWorthThreads;
    if (shared) {
      parallel_for_each(groups, [&](std::ptrdiff_t g) {
        const int first = begin + static_cast<int>(g) * kTogether;
        for_column_groups(first, std::min(end, first + kTogether),
                          [&](auto count, int j) { take_rows<count()>(entries, size, j, end, size, local.data()); });
      });
    }
    for_column_groups_back(begin, end, [&](auto count, int j) {
      take_rows<count()>(entries, size, j, j + count(), shared ? end : size, local.data());
      solve_rows<count()>(entries, size, j, local.data());
    });
    end = begin;
  }
  std::copy_n(local.data(), width, x.data() + elimination_.first_column(node));
}

template <typename Number>
void CholeskyFactor::solve_four(Buffer<Row<Number>>& x) const {
  std::vector<Buffer<Row<Number>>> outside(subtrees_.size());
  parallel_for_each(static_cast<std::ptrdiff_t>(subtrees_.size()), [&](std::ptrdiff_t t) {
    const Subtree& tree = subtrees_[static_cast<std::size_t>(t)];
    Buffer<Row<Number>>& sums = outside[static_cast<std::size_t>(t)];
    sums.assign(static_cast<std::size_t>(elimination_.row_count(tree.root) - elimination_.width(tree.root)),
                Row<Number>{});
    Buffer<Row<Number>> local;
    for (int s = tree.first; s <= tree.root; ++s) {
      eliminate<Number>(s, x, local);
      const int* const rows = elimination_.rows(s);
      for (int i = elimination_.width(s); i < inside_[s]; ++i) x[rows[i]] += local[i];
      const int* const places = places_.data() + place_starts_[s];
      for (int i = inside_[s]; i < elimination_.row_count(s); ++i) sums[places[i - inside_[s]]] += local[i];
    }
  });
  for (std::size_t t = 0; t < subtrees_.size(); ++t) {
    const int root = subtrees_[t].root;
    const int* const rows = elimination_.rows(root) + elimination_.width(root);
    for (std::size_t i = 0; i < outside[t].size(); ++i) x[rows[i]] += outside[t][i];
  }
  Buffer<Row<Number>> local;
  for (const int s : top_) {
    eliminate<Number>(s, x, local);
    const int* const rows = elimination_.rows(s);
    for (int i = elimination_.width(s); i < elimination_.row_count(s); ++i) x[rows[i]] += local[i];
  }
  for (std::size_t i = top_.size(); i-- > 0;) substitute<Number>(top_[i], x, local);
  parallel_for_each(static_cast<std::ptrdiff_t>(subtrees_.size()), [&](std::ptrdiff_t t) {
    const Subtree& tree = subtrees_[static_cast<std::size_t>(t)];
    Buffer<Row<Number>> scratch;
    for (int s = tree.root; s >= tree.first; --s) substitute<Number>(s, x, scratch);
  });
}

/// In floats the greatest number of the scaled right-hand side becomes 1, so that none is out of their range.
template <typename Number>
void CholeskyFactor::solve_scaled(const Values& b, Values& x) const {
  x.resize(b.rows(), b.cols());
  const Buffer<int>& order = elimination_.order();
  const auto scale = [&](Eigen::Index i) { return scale_.empty() ? 1.0 : scale_[i]; };
  double size = 1.0;
  if (precision_ == FactorPrecision::Single) {
    size = 0.0;
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      for (Eigen::Index c = 0; c < b.cols(); ++c) size = std::max(size, scale(i) * std::abs(b(i, c)));
    }
    if (!(size > 0.0)) size = 1.0;
  }
  Buffer<Row<Number>> four(static_cast<std::size_t>(b.rows()));
  for (Eigen::Index first = 0; first < b.cols(); first += 4) {
    const Eigen::Index columns = std::min<Eigen::Index>(4, b.cols() - first);
    const auto for_rows = [&](const auto& work) {
      parallel_for(b.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) work(i);
      });
    };
    for_rows([&](std::ptrdiff_t i) {
      Row<Number> row{};
      for (Eigen::Index c = 0; c < columns; ++c) row[c] = static_cast<Number>(b(i, first + c) * (scale(i) / size));
      four[order[i]] = row;
    });
    solve_four<Number>(four);
    for_rows([&](std::ptrdiff_t i) {
      for (Eigen::Index c = 0; c < columns; ++c) x(i, first + c) = four[order[i]][c] * (scale(i) * size);
    });
  }
}

void CholeskyFactor::solve(const Values& b, Values& x) const {
  if (precision_ == FactorPrecision::Double) {
    solve_scaled<double>(b, x);
  } else {
    solve_scaled<float>(b, x);
  }
}

}  // namespace batten
