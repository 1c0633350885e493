#include "batten/expand/cotangent_rows.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/mesh/face_triangles.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

constexpr double kLargestCotangent = 114.6;  // of half a degree
constexpr double kShare = 8.0 / 9.0;         // 1 - 1/9; 1/9 is the lowest eigenvalue of regular quads

/// One row of C without the diagonal, and a third of the area around its vertex.
struct Row {
  std::vector<std::pair<Index, double>> entries;
  double area = 0.0;

  /// Sorts by column and adds up those of the same.
  void sort() {
    sort_stably();
    std::size_t used = 0;
    for (const auto& entry : entries) {
      if (used > 0 && entries[used - 1].first == entry.first) {
        entries[used - 1].second += entry.second;
      } else {
        entries[used++] = entry;
      }
    }
    entries.resize(used);
  }
  double diagonal() const {
    double sum = 0.0;
    for (const auto& entry : entries) sum += entry.second;
    return sum;
  }
  /// sum_j |C_ij| with the diagonal.
  double absolute_sum() const {
    double sum = std::abs(diagonal());
    for (const auto& entry : entries) sum += std::abs(entry.second);
    return sum;
  }

 private:
  /// std::stable_sort takes memory from the heap, which for the dozen entries of most rows costs more than sorting.
  void sort_stably() {
    constexpr std::size_t kFew = 64;
    if (entries.size() > kFew) {
      std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      return;
    }
    for (std::size_t i = 1; i < entries.size(); ++i) {
      const std::pair<Index, double> entry = entries[i];
      std::size_t k = i;
      for (; k > 0 && entries[k - 1].first > entry.first; --k) entries[k] = entries[k - 1];
      entries[k] = entry;
    }
  }
};

/// The rows of a block of vertices before they are scaled, diagonals last.
struct RowBlock {
  Buffer<Index> columns;
  Buffer<double> weights;
  std::size_t first = 0;  ///< among the entries of all blocks
};

/// What scales a row: nothing on curves, kept and fixed vertices.
struct RowMeasure {
  double area = 0.0;
  double absolute_sum = 0.0;
  bool scaled = false;
};

class CotangentBuilder {
 public:
  CotangentBuilder(const LimitMatrix& matrix, ConstValuesRef points, const Buffer<std::uint8_t>& kept)
      : matrix_(matrix), topology_(matrix.topology()), points_(points), kept_(kept), triangles_(topology_, points) {}

  bool is_smooth(Index v) const {
    const LimitRow kind = matrix_.row_kind(v);
    return !is_kept(v) && (kind == LimitRow::Smooth || kind == LimitRow::Special);
  }

  void row(Index v, Row& row) const {
    row.entries.clear();
    row.area = 0.0;
    const Eigen::Vector3d here = at(v);
    topology_.for_each_outgoing(v, [&](Index h) {
      triangles_.at_corner(h, [&](Index b, Index c) {
        const Eigen::Vector3d to_b = at(b) - here;
        const Eigen::Vector3d to_c = at(c) - here;
        const TriangleCotangents cot = triangle_cotangents(to_b, to_c);
        if (!(cot.twice_area > 0.0)) return;
        const double largest = std::max({std::abs(cot.origin), std::abs(cot.b), std::abs(cot.c)});
        if (!std::isfinite(largest)) return;
        const double share = largest > kLargestCotangent ? kLargestCotangent / largest : 1.0;
        row.entries.emplace_back(b, -0.5 * share * cot.c);
        row.entries.emplace_back(c, -0.5 * share * cot.b);
        row.area += cot.twice_area / 6.0;
      });
    });
    row.sort();
  }

  /// Appends row v of E - A, or of C where that is still to be scaled.
  RowMeasure append(Index v, Row& scratch, RowBlock& block) const {
    if (is_kept(v)) return {};
    if (is_smooth(v)) {
      row(v, scratch);
      for (const auto& entry : scratch.entries) {
        block.columns.push_back(entry.first);
        block.weights.push_back(entry.second);
      }
      block.columns.push_back(v);
      block.weights.push_back(-scratch.diagonal());
      return {scratch.area, scratch.absolute_sum(), true};
    }
    double diagonal = 1.0;
    matrix_.visit_row(v, [&](Index column, double weight) {
      if (column == v) {
        diagonal -= weight;
      } else {
        block.columns.push_back(column);
        block.weights.push_back(-weight);
      }
    });
    block.columns.push_back(v);
    block.weights.push_back(diagonal);
    return {};
  }

 private:
  Eigen::Vector3d at(Index v) const { return {points_(v, 0), points_(v, 1), points_(v, 2)}; }
  bool is_kept(Index v) const { return !kept_.empty() && kept_[v] != 0; }

  const LimitMatrix& matrix_;
  Topology topology_;
  ConstValuesRef points_;
  const Buffer<std::uint8_t>& kept_;
  FaceTriangles triangles_;
};

/// The median over the scaled rows of (sum_j |C_ij|) / area.
double median_ratio(const Buffer<RowMeasure>& measures) {
  Buffer<double> ratios;
  ratios.reserve(measures.size());
  for (const RowMeasure& measure : measures) {
    if (measure.scaled && measure.area > 0.0) ratios.push_back(measure.absolute_sum / measure.area);
  }
  return ratios.empty() ? 0.0 : quantile(ratios, 0.5);
}

/// Where each block's entries stand among those of all.
std::size_t place_blocks(std::vector<RowBlock>& blocks) {
  std::size_t total = 0;
  for (RowBlock& block : blocks) {
    block.first = total;
    total += block.columns.size();
  }
  return total;
}

/// Scales the rows [begin, end), moves them to their place and frees the block.
void finish_block(const Buffer<RowMeasure>& measures, double ratio, std::ptrdiff_t begin, std::ptrdiff_t end,
                  RowBlock& block, CotangentRows& rows) {
  Buffer<std::size_t>& offsets = rows.remainder.offsets;
  const std::size_t count = block.columns.size();
  for (std::ptrdiff_t v = begin; v < end; ++v) {
    rows.scales[v] = 1.0;
    const RowMeasure& measure = measures[v];
    const std::size_t last = v + 1 < end ? offsets[v + 1] : count;
    if (measure.scaled) {
      const double scale = std::max(ratio * measure.area, measure.absolute_sum);
      if (scale > 0.0) rows.scales[v] = scale;
      const double factor = scale > 0.0 ? kShare / scale : 0.0;
      for (std::size_t k = offsets[v]; k < last; ++k) block.weights[k] *= factor;
    }
  }
  for (std::ptrdiff_t v = begin; v < end; ++v) offsets[v] += block.first;
  std::copy_n(block.columns.begin(), count, rows.remainder.columns.begin() + static_cast<std::ptrdiff_t>(block.first));
  std::copy_n(block.weights.begin(), count, rows.remainder.weights.begin() + static_cast<std::ptrdiff_t>(block.first));
  block = {};
}

}  // namespace

CotangentRows cotangent_rows(const LimitMatrix& matrix, ConstValuesRef points, const Buffer<std::uint8_t>& kept,
                             const Progress& progress) {
  require_vertex_rows(matrix.topology(), points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "cotangents need points of three columns");
  if (!points.allFinite()) throw Error(ErrorCode::NotFinite, "the points hold a number that is not finite");
  const Index count = matrix.topology().vertex_count();
  const CotangentBuilder builder(matrix, points, kept);
  std::vector<RowBlock> blocks(static_cast<std::size_t>(block_count(count)));
  Buffer<RowMeasure> measures(static_cast<std::size_t>(count));
  CotangentRows rows;
  RemainderRows& remainder = rows.remainder;
  remainder.offsets.resize(static_cast<std::size_t>(count) + 1);
  rows.scales.resize(static_cast<std::size_t>(count));
  parallel_for(
      count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Row scratch;
        RowBlock& block = blocks[begin / kDefaultBlock];
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          remainder.offsets[v] = block.columns.size();
          measures[v] = builder.append(v, scratch, block);
        }
      },
      kDefaultBlock, progress);
  const double ratio = median_ratio(measures);
  const std::size_t total = place_blocks(blocks);
  remainder.columns.resize(total);
  remainder.weights.resize(total);
  remainder.offsets[count] = total;
  parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    finish_block(measures, ratio, begin, end, blocks[begin / kDefaultBlock], rows);
  });
  return rows;
}

}  // namespace batten
