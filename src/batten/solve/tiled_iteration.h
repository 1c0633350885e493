/// \file Polynomial iterations (Chebyshev, damped Jacobi, Richardson) for a sparse system, in tiles that stay in the
/// cache.
///
/// Each iteration of a sweep over a large mesh would read every index and every vector from memory again. Here the
/// unknowns are cut into tiles of a few thousand; a tile takes along the rings of unknowns around it that several steps
/// reach, runs these steps in the core's own cache in float, and writes back its own unknowns. The result is that of
/// the global iteration, step by step, to rounding (a "matrix powers kernel", Demmel and others 2008, key DHMY08), for
/// one pass through memory every `kStepsPerRound` steps. Residuals are measured in double between the rounds the next
/// round goes on from there with corrections in float, so that the result is as exact as double allows.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "batten/buffer.h"
#include "batten/solve/solver.h"

namespace batten {

/// The entries of one row; a column may come several times.
struct RowEntries {
  Buffer<Index> columns;
  Buffer<double> weights;
  void clear() {
    columns.clear();
    weights.clear();
  }
  void add(Index column, double weight) {
    columns.push_back(column);
    weights.push_back(weight);
  }
};

/// A square system of which some unknowns are free and the others hold their values.
class RowSource {
 public:
  virtual ~RowSource() = default;
  Index size() const { return size_; }
  bool is_free(Index row) const { return free_.empty() || free_[row] != 0; }
  bool all_free() const { return free_.empty(); }
  /// Appends the entries of a free row; the diagonal must be positive. Called from several threads.
  virtual void row(Index row, RowEntries& entries) const = 0;

  /// A number from 1 on that tells the weights of a row: rows of the same number have the same weights in the same
  /// order, row() gives their diagonal entry last, and only there. 0 for a row of which this is not known.
  virtual Index weights_key(Index /*row*/) const { return 0; }
  /// Writes the columns that row() gives for a row with a weights_key(), but for the diagonal's.
  virtual void columns_of(Index /*row*/, Index* /*columns*/) const {}

 protected:
  /// All rows are free.
  explicit RowSource(Index size) : size_(size) {}
  /// free: one flag a row, or empty where all rows are free.
  RowSource(Index size, Buffer<std::uint8_t> free) : size_(size) {
    if (std::find(free.begin(), free.end(), 0) != free.end()) free_ = std::move(free);
  }

 private:
  Index size_;
  Buffer<std::uint8_t> free_;
};

struct IterationOptions {
  SolveMethod method = SolveMethod::Chebyshev;  ///< or Jacobi, Richardson
  double omega = 0.5;                           ///< Jacobi's damping
  /// Chebyshev: a lower bound of the spectrum of D^-1 A to start with. It is lowered where the iteration converges more
  /// slowly than such a spectrum allows.
  double lower_bound = 0.2;
  /// Chebyshev: stop where the bound would have to fall below this, since the caller has a better method. It never
  /// falls below 1e-5 of the upper bound, where a system is as good as singular.
  double give_up_below = 0.0;
};

/// Build: O(nonzeros). Memory, on regular quads: 77 bytes an unknown while it is built, of which 31 stay. Safe to share
/// between threads.
class TiledIteration {
 public:
  static constexpr int kStepsPerRound = 8;
  /// Tiles cost more than they save beyond these: rows of huge faces, and rings that grow too fast.
  static constexpr double kMostEntriesPerRow = 40.0;
  static constexpr double kMostOverlap = 6.0;

  /// Throws Error(Cancelled).
  explicit TiledIteration(const RowSource& rows, const Progress& progress = {});
  ~TiledIteration();
  TiledIteration(TiledIteration&&) noexcept;

  /// Solves A x = b for the free rows; x holds the start, and the values of the others. b and x: n-by-k.
  /// Keeps the memory of one solve for the next, 112 bytes an unknown.
  SolveReport solve(ConstValuesRef b, ValuesRef x, const IterationOptions& options, const StopRule& stop) const;

  /// A rigorous upper bound of the spectrum of D^-1 A: max_i (|D^-1 A| u)_i / u_i for a positive u near the dominant
  /// eigenvector (Collatz 1942, Wielandt 1950; key C42).
  double upper_bound() const;

  /// Unknowns held by all tiles, rings included, over unknowns: what the tiling costs.
  double overlap() const;

 private:
  struct Tiles;
  std::unique_ptr<Tiles> tiles_;
};

}  // namespace batten
