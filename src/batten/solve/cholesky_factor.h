/// \file A sparse Cholesky factor for several columns at once.
#pragma once
#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>
#include <tuple>
#include <type_traits>
#include <vector>

#include "batten/buffer.h"
#include "batten/double4.h"
#include "batten/solve/elimination.h"
#include "batten/types.h"

namespace batten {

/// Four floats in one register.
using Float4 = float __attribute__((vector_size(16)));

/// The numbers that a factor is kept in.
enum class FactorPrecision {
  Double,
  /// Half the memory, and half the time where memory is slow. The matrix is scaled to a diagonal of ones first, so that
  /// its numbers may be of any size. Solutions are off by some 1e-7 times the condition of the scaled matrix: a
  /// preconditioner. A matrix whose scaled condition is above about 1e6 may be found not positive.
  Single
};

/// L L^T = P A P^T of a sparse symmetric positive definite matrix, with an order P that keeps L sparse (approximate
/// minimum degree, Amestoy, Davis and Duff 1996, key ADD96, as Eigen has it). Built front by front (multifrontal, Duff
/// and Reid 1983, key DR83), with dense blocks. Const calls are safe from several threads; the same bits for any
/// number of threads, which share independent parts of the factor and rows of large blocks. For the stiffness of n
/// control points on quads L has some 23 log2(n) entries a row; while it is built, up to half as much again.
class CholeskyFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  /// The value of the matrix's entry with this number.
  using EntryValue = std::function<double(std::ptrdiff_t entry)>;

  /// Both triangles of the matrix are there, and its whole diagonal.
  explicit CholeskyFactor(const Matrix& matrix, FactorPrecision precision = FactorPrecision::Double);
  /// The same of a matrix with the pattern's entries in their order, and other values.
  CholeskyFactor(const Matrix& pattern, FactorPrecision precision, const EntryValue& value);

  /// False where a pivot was not positive: the matrix is not positive definite, and solve() must not be called.
  bool positive() const { return positive_; }
  /// The least pivot, relative to the matrix's own diagonal there: about the precision where the matrix is singular.
  double least_pivot() const { return least_pivot_; }
  std::size_t entry_count() const { return starts_.back(); }
  FactorPrecision precision() const { return precision_; }

  /// x = A^-1 b, N-by-k each.
  void solve(const Values& b, Values& x) const;

 private:
  /// Supernodes [first, root] that are a whole subtree, and their updates of rows beyond it: those below the root.
  struct Subtree {
    int first;
    int root;
  };
  /// Four columns of numbers.
  template <typename Number>
  using Row = std::conditional_t<std::is_same_v<Number, double>, Double4, Float4>;

  void split_tree();
  void list_places();
  void find_scale(const Matrix& pattern, const EntryValue& value);
  template <typename Number>
  void factor(const Matrix& pattern, const EntryValue& value);
  template <typename Number>
  void solve_scaled(const Values& b, Values& x) const;
  template <typename Number>
  void solve_four(Buffer<Row<Number>>& x) const;
  template <typename Number>
  void eliminate(int node, Buffer<Row<Number>>& x, Buffer<Row<Number>>& local) const;
  template <typename Number>
  void substitute(int node, Buffer<Row<Number>>& x, Buffer<Row<Number>>& local) const;
  template <typename Number>
  const Number* node_entries(int node) const {
    return std::get<Buffer<Number>>(entries_).data() + starts_[node];
  }

  Elimination elimination_;
  FactorPrecision precision_;
  std::vector<Subtree> subtrees_;  ///< independent of each other
  Buffer<int> top_;                ///< the supernodes above them, ascending
  Buffer<int> inside_;             ///< how many of each supernode's rows lie in its subtree
  Buffer<std::size_t> place_starts_;
  Buffer<int> places_;          ///< of the other rows among those below the subtree's root
  Buffer<std::size_t> starts_;  ///< of each supernode's columns of L, each from its diagonal down
  std::tuple<Buffer<double>, Buffer<float>> entries_;  ///< one of them, by precision
  Buffer<double> scale_;                               ///< of Single: L L^T = P D A D P^T with these on D's diagonal
  bool positive_ = false;
  double least_pivot_ = 0.0;
};

}  // namespace batten
