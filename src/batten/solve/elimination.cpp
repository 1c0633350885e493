#include "batten/solve/elimination.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <numeric>
#include <utility>

namespace batten {

namespace {

/// Supernodes that may be merged with their parent although that stores zeros: narrow ones always, wider ones where
/// few of the entries are.
constexpr int kNarrow = 8;
constexpr double kMostZeros = 0.05;

/// The parent of column j is the first row below the diagonal of L's column j (Liu's algorithm with shortened paths).
Buffer<int> elimination_tree(const Elimination::Matrix& matrix, const Buffer<int>& order, const Buffer<int>& places) {
  const auto count = static_cast<int>(order.size());
  Buffer<int> parents(order.size(), -1);
  Buffer<int> ancestors(order.size(), -1);
  for (int j = 0; j < count; ++j) {
    for (Elimination::Matrix::InnerIterator e(matrix, places[j]); e; ++e) {
      int k = order[e.col()];
      while (k >= 0 && k < j) {
        const int next = ancestors[k];
        ancestors[k] = j;
        if (next < 0) parents[k] = j;
        k = next;
      }
    }
  }
  return parents;
}

/// The columns in an order in which those of a subtree stand together: result[new] = old.
Buffer<int> postorder(const Buffer<int>& parents) {
  const auto count = static_cast<int>(parents.size());
  Buffer<int> first_child(parents.size(), -1);
  Buffer<int> next_sibling(parents.size(), -1);
  for (int j = count - 1; j >= 0; --j) {
    if (parents[j] < 0) continue;
    next_sibling[j] = first_child[parents[j]];
    first_child[parents[j]] = j;
  }
  Buffer<int> result;
  result.reserve(parents.size());
  Buffer<int> stack;
  for (int root = 0; root < count; ++root) {
    if (parents[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int j = stack.back();
      if (first_child[j] >= 0) {
        stack.push_back(first_child[j]);
        first_child[j] = next_sibling[first_child[j]];
      } else {
        result.push_back(j);
        stack.pop_back();
      }
    }
  }
  return result;
}

/// The entries of each column of L, the diagonal included: row i of L has the columns on the paths of the tree from
/// the entries of the matrix's row to i.
Buffer<int> column_counts(const Elimination::Matrix& matrix, const Buffer<int>& order, const Buffer<int>& places,
                          const Buffer<int>& parents) {
  const auto count = static_cast<int>(order.size());
  Buffer<int> counts(order.size(), 1);
  Buffer<int> marks(order.size(), -1);
  for (int i = 0; i < count; ++i) {
    marks[i] = i;
    for (Elimination::Matrix::InnerIterator e(matrix, places[i]); e; ++e) {
      for (int k = order[e.col()]; k < i && marks[k] != i; k = parents[k]) {
        marks[k] = i;
        ++counts[k];
      }
    }
  }
  return counts;
}

}  // namespace

Elimination::Elimination(const Matrix& matrix) {
  order_columns(matrix);
  merge_columns(matrix);
  list_rows(matrix);
}

void Elimination::order_columns(const Matrix& matrix) {
  const Eigen::Map<const Eigen::SparseMatrix<double>> columns(matrix.rows(), matrix.cols(), matrix.nonZeros(),
                                                              matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                                                              matrix.valuePtr());  // equal to its rows
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> degrees;
  Eigen::AMDOrdering<int>()(Eigen::SparseMatrix<double>(columns).selfadjointView<Eigen::Lower>(), degrees);
  places_.assign(degrees.indices().data(), degrees.indices().data() + degrees.indices().size());
  order_.resize(places_.size());
  for (std::size_t j = 0; j < places_.size(); ++j) order_[places_[j]] = static_cast<int>(j);
  const Buffer<int> parents = elimination_tree(matrix, order_, places_);
  const Buffer<int> before = postorder(parents);
  Buffer<int> after(before.size());
  for (std::size_t j = 0; j < before.size(); ++j) after[before[j]] = static_cast<int>(j);
  Buffer<int> places(places_.size());
  column_parents_.resize(places_.size());
  for (std::size_t j = 0; j < places.size(); ++j) {
    places[j] = places_[before[j]];
    const int parent = parents[before[j]];
    column_parents_[j] = parent < 0 ? -1 : after[parent];
  }
  places_ = std::move(places);
  for (std::size_t j = 0; j < places_.size(); ++j) order_[places_[j]] = static_cast<int>(j);
}

/// A column joins the supernode before it where it is the parent and has the same rows; then supernodes join their
/// parents where that costs little.
void Elimination::merge_columns(const Matrix& matrix) {
  const auto count = static_cast<int>(order_.size());
  const Buffer<int> counts = column_counts(matrix, order_, places_, column_parents_);
  struct Node {
    int first;
    int width;
    int rows;           ///< the first column's, zeros that are stored included
    std::size_t zeros;  ///< stored so far
  };
  Buffer<Node> nodes;
  for (int j = 0; j < count; ++j) {
    if (!nodes.empty()) {
      const Node& last = nodes.back();
      if (column_parents_[j - 1] == j && last.rows - last.width == counts[j]) {
        ++nodes.back().width;
        continue;
      }
    }
    nodes.push_back({j, 1, counts[j], 0});
  }
  Buffer<Node> merged;
  for (const Node& next : nodes) {
    Node node = next;
    while (!merged.empty()) {
      const Node& child = merged.back();
      if (column_parents_[child.first + child.width - 1] != node.first) break;
      // The child's columns get the rows of the parent that they lack.
      const int rows = child.width + node.rows;
      const std::size_t lacking = static_cast<std::size_t>(rows - child.rows) * static_cast<std::size_t>(child.width);
      const std::size_t zeros = child.zeros + node.zeros + lacking;
      const int width = child.width + node.width;
      const double entries = static_cast<double>(width) * rows;
      if (width > kNarrow && static_cast<double>(zeros) > kMostZeros * entries) break;
      node = {child.first, width, rows, zeros};
      merged.pop_back();
    }
    merged.push_back(node);
  }
  starts_.reserve(merged.size() + 1);
  for (const Node& node : merged) starts_.push_back(node.first);
  starts_.push_back(count);
}

void Elimination::list_rows(const Matrix& matrix) {
  const int nodes = count();
  Buffer<int> node_of(order_.size());
  for (int s = 0; s < nodes; ++s) std::fill(node_of.begin() + starts_[s], node_of.begin() + starts_[s + 1], s);
  parents_.assign(static_cast<std::size_t>(nodes), -1);
  row_starts_.assign(1, 0);
  Buffer<int> first_child(static_cast<std::size_t>(nodes), -1);
  Buffer<int> next_sibling(static_cast<std::size_t>(nodes), -1);
  Buffer<int> marks(order_.size(), -1);
  for (int s = 0; s < nodes; ++s) {
    const int end = starts_[s + 1];
    for (int j = starts_[s]; j < end; ++j) rows_.push_back(j);
    const std::size_t below = rows_.size();
    const auto add = [&](int row) {
      if (row < end || marks[row] == s) return;
      marks[row] = s;
      rows_.push_back(row);
    };
    for (int j = starts_[s]; j < end; ++j) {
      for (Matrix::InnerIterator e(matrix, places_[j]); e; ++e) add(order_[e.col()]);
    }
    for (int c = first_child[s]; c >= 0; c = next_sibling[c]) {
      for (std::size_t i = row_starts_[c]; i < row_starts_[c + 1]; ++i) add(rows_[i]);
    }
    std::sort(rows_.begin() + static_cast<std::ptrdiff_t>(below), rows_.end());
    row_starts_.push_back(rows_.size());
    if (below == rows_.size()) continue;
    parents_[s] = node_of[rows_[below]];
    next_sibling[s] = first_child[parents_[s]];
    first_child[parents_[s]] = s;
  }
}

}  // namespace batten
