#include "batten/solve/tiled_polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/parallel/spare.h"
#include "batten/solve/tiles.h"

namespace batten {

namespace {

/// The last ring has no rows, so that a round applies A so often.
constexpr int kMostProducts = Tile::kRings - 1;

/// One application of G, and what is done with it.
struct Step {
  bool first = false;        ///< of its pass: y = G x; else y = G y
  bool last = false;         ///< of its pass: the sum is the new x
  double keep = 1.0;         ///< sum <- keep sum + coefficient y
  double coefficient = 0.0;  ///< of this power
};

/// Steps that a tile runs without looking at its neighbours.
using Round = std::vector<Step>;

std::vector<Round> plan(const std::vector<double>& coefficients, int passes) {
  const auto degree = static_cast<int>(coefficients.size()) - 1;
  Round pass;
  for (int i = 1; i <= degree; ++i)
    pass.push_back({i == 1, i == degree, i == 1 ? coefficients[0] : 1.0, coefficients[i]});
  std::vector<Round> rounds;
  const std::size_t whole = degree <= kMostProducts ? static_cast<std::size_t>(kMostProducts / degree * degree) : 0;
  for (int k = 0; k < passes; ++k) {
    if (whole > 0 && !rounds.empty() && rounds.back().size() < whole) {
      rounds.back().insert(rounds.back().end(), pass.begin(), pass.end());
      continue;
    }
    for (int i = 0; i < degree; i += kMostProducts)
      rounds.emplace_back(pass.begin() + i, pass.begin() + std::min(i + kMostProducts, degree));
  }
  return rounds;
}

/// Four columns in the order of the tiles: at the ends of a pass the sum is x and y is not read.
struct PolynomialColumns {
  Buffer<Double4> sum;
  Buffer<Double4> y;
};

/// What a thread needs for one tile.
struct PolynomialScratch {
  Buffer<Double4> sum;
  Buffer<Double4> y;
  Buffer<Double4> next;

  std::size_t size() const { return sum.size(); }
  void resize(std::size_t count) {
    sum.resize(count);
    y.resize(count);
    next.resize(count);
  }
};

/// The caller's columns [first, first + count).
struct Window {
  const double* in;
  std::ptrdiff_t in_stride;
  double* out;
  std::ptrdiff_t out_stride;
  std::ptrdiff_t count;

  Double4 load(Index row) const {
    const double* from = in + row * in_stride;
    if (count == 3) return Double4{from[0], from[1], from[2], 0.0};
    Double4 value{0.0, 0.0, 0.0, 0.0};
    for (std::ptrdiff_t c = 0; c < count; ++c) value[c] = from[c];
    return value;
  }
  void store(Index row, const Double4& value) const {
    double* to = out + row * out_stride;
    for (std::ptrdiff_t c = 0; c < count; ++c) to[c] = value[c];
  }
};

/// Where a round reads and writes: the columns of the round before and its own, or, in the first and the last round,
/// the caller's.
struct Places {
  const Window* from;  ///< null: `before`
  const Window* to;    ///< null: `after`
  const PolynomialColumns* before;
  PolynomialColumns* after;
};

void load(const Tiling& tiling, const Tile& tile, int rings, bool with_y, const Places& places,
          PolynomialScratch& scratch) {
  const Index own = tile.own_count;
  const Index all = tile.ring_end[rings];
  if (places.from != nullptr) {
    for (Index i = 0; i < own; ++i) scratch.sum[i] = places.from->load(tiling.order[tile.first + i]);
    for (Index i = own; i < all; ++i) scratch.sum[i] = places.from->load(tiling.order[tile.ghosts[i - own]]);
    return;
  }
  const PolynomialColumns& before = *places.before;
  std::copy_n(before.sum.begin() + tile.first, own, scratch.sum.begin());
  for (Index i = own; i < all; ++i) scratch.sum[i] = before.sum[tile.ghosts[i - own]];
  if (!with_y) return;
  std::copy_n(before.y.begin() + tile.first, own, scratch.y.begin());
  for (Index i = own; i < all; ++i) scratch.y[i] = before.y[tile.ghosts[i - own]];
}

void run_round(const Tiling& tiling, const Tile& tile, const Round& round, const Places& places) {
  PolynomialScratch& scratch = scratch_for<PolynomialScratch>(tile);
  const auto steps = static_cast<int>(round.size());
  load(tiling, tile, steps, !round.front().first, places, scratch);
  for (int k = 0; k < steps; ++k) {
    const Step& step = round[k];
    const int last_ring = steps - 1 - k;
    const Double4* source = step.first ? scratch.sum.data() : scratch.y.data();
    tile_remainder(tile, tiling.patterns, last_ring, source, scratch.next.data());
    std::swap(scratch.y, scratch.next);
    if (step.keep == 1.0 && step.coefficient == 0.0) continue;
    for (Index i = 0; i < tile.ring_end[last_ring]; ++i)
      scratch.sum[i] = step.keep * scratch.sum[i] + step.coefficient * scratch.y[i];
  }
  if (places.to != nullptr) {
    for (Index i = 0; i < tile.own_count; ++i) places.to->store(tiling.order[tile.first + i], scratch.sum[i]);
    return;
  }
  std::copy_n(scratch.sum.begin(), tile.own_count, places.after->sum.begin() + tile.first);
  if (!round.back().last) std::copy_n(scratch.y.begin(), tile.own_count, places.after->y.begin() + tile.first);
}

/// The columns of G, with the same weights in all rows that have as many: what a tiling is made from.
class ColumnsOnly : public RowSource {
 public:
  explicit ColumnsOnly(const RemainderRows& rows) : RowSource(rows.size()), rows_(rows) {}
  void row(Index row, RowEntries& entries) const override {
    const Index count = off_diagonal(row);
    for (Index k = 0; k < count; ++k) entries.add(rows_.columns[rows_.offsets[row] + k], 1.0);
    entries.add(row, 1.0);
  }
  Index weights_key(Index row) const override { return off_diagonal(row) + 1; }
  void columns_of(Index row, Index* columns) const override {
    std::copy_n(rows_.columns.begin() + static_cast<std::ptrdiff_t>(rows_.offsets[row]), off_diagonal(row), columns);
  }

 private:
  Index off_diagonal(Index row) const {
    const std::size_t entries = rows_.offsets[row + 1] - rows_.offsets[row];
    return entries > 0 ? static_cast<Index>(entries) - 1 : 0;
  }

  const RemainderRows& rows_;
};

}  // namespace

struct TiledPolynomial::Parts {
  Tiling tiling;
  mutable Spare<std::array<PolynomialColumns, 2>> spare;

  void run(const std::vector<Round>& rounds, const Window& window, const Progress& progress) const {
    std::array<PolynomialColumns, 2> columns = spare.take();
    const std::size_t size = tiling.order.size();
    const bool with_y = !rounds.front().back().last;
    for (std::size_t r = 0; r < std::min<std::size_t>(rounds.size() - 1, 2); ++r) {
      columns[r].sum.resize(size);
      if (with_y) columns[r].y.resize(size);
    }
    const auto tile_count = static_cast<std::ptrdiff_t>(tiling.tiles.size());
    const double share = 1.0 / static_cast<double>(rounds.size());
    for (std::size_t r = 0; r < rounds.size(); ++r) {
      const Places places{r == 0 ? &window : nullptr, r + 1 == rounds.size() ? &window : nullptr, &columns[(r + 1) % 2],
                          &columns[r % 2]};
      const double done = share * static_cast<double>(r);
      parallel_for_each(
          tile_count, [&](std::ptrdiff_t t) { run_round(tiling, tiling.tiles[t], rounds[r], places); },
          progress_within(progress, done, done + share));
    }
    spare.give_back(std::move(columns));
  }
};

TiledPolynomial::TiledPolynomial(const RowSource& rows, const Progress& progress) : parts_(std::make_unique<Parts>()) {
  const RowTable table(rows, progress_within(progress, 0.0, 0.4));
  parts_->tiling = make_tiling(table, progress_within(progress, 0.4, 1.0));
}

TiledPolynomial::TiledPolynomial(const RemainderRows& rows, const Progress& progress)
    : TiledPolynomial(static_cast<const RowSource&>(ColumnsOnly(rows)), progress_within(progress, 0.0, 0.9)) {
  set_own_weights(rows, parts_->tiling, progress_within(progress, 0.9, 1.0));
}

TiledPolynomial::~TiledPolynomial() = default;
TiledPolynomial::TiledPolynomial(TiledPolynomial&&) noexcept = default;

bool TiledPolynomial::fits() const { return !parts_->tiling.tiles.empty() || parts_->tiling.order.empty(); }
double TiledPolynomial::overlap() const { return parts_->tiling.overlap; }

void TiledPolynomial::apply(const std::vector<double>& coefficients, int passes, ConstValuesRef x, ValuesRef result,
                            const Progress& progress) const {
  if (x.rows() != static_cast<Eigen::Index>(parts_->tiling.order.size()) || result.rows() != x.rows() ||
      result.cols() != x.cols())
    throw Error(ErrorCode::BadShape, "values and results must have one row an unknown and as many columns");
  if (coefficients.empty()) throw Error(ErrorCode::BadArgument, "a polynomial needs a coefficient");
  if (!fits()) throw Error(ErrorCode::NotAvailable, "this system has rows too wide for tiles");
  if (x.size() == 0) return;
  if (passes <= 0 || coefficients.size() == 1) {
    result = std::pow(coefficients[0], std::max(passes, 0)) * x;
    return;
  }
  const std::vector<Round> rounds = plan(coefficients, passes);
  const Eigen::Index groups = (x.cols() + 3) / 4;
  for (Eigen::Index g = 0; g < groups; ++g) {
    const Window window{x.data() + 4 * g, x.outerStride(), result.data() + 4 * g, result.outerStride(),
                        std::min<Eigen::Index>(4, x.cols() - 4 * g)};
    const double share = 1.0 / static_cast<double>(groups);
    parts_->run(rounds, window,
                progress_within(progress, share * static_cast<double>(g), share * static_cast<double>(g + 1)));
  }
}

}  // namespace batten
