#include "batten/expand/cotangent_rows.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/mesh/face_triangles.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr double kLargestCotangent = 114.6;  // of half a degree
constexpr double kShare = 8.0 / 9.0;         // 1 - 1/9; 1/9 is the lowest eigenvalue of regular quads

/// One row of C without the diagonal, and a third of the area around its vertex.
struct Row {
  std::vector<std::pair<Index, double>> entries;
  double area = 0.0;

  void sort() {
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
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

  /// The median over the vertices of (sum_j |C_ij|) / area.
  double median_ratio(const Progress& progress) const {
    Buffer<double> ratios(static_cast<std::size_t>(topology_.vertex_count()), -1.0);
    parallel_for(
        topology_.vertex_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          Row entries;
          for (auto v = static_cast<Index>(begin); v < end; ++v) {
            if (!is_smooth(v)) continue;
            row(v, entries);
            if (entries.area > 0.0) ratios[v] = entries.absolute_sum() / entries.area;
          }
        },
        kDefaultBlock, progress);
    ratios.erase(std::remove_if(ratios.begin(), ratios.end(), [](double ratio) { return !(ratio >= 0.0); }),
                 ratios.end());
    if (ratios.empty()) return 0.0;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
  }

  /// Appends row v of E - A and returns its scale.
  double append(Index v, double ratio, Row& scratch, Buffer<Index>& columns, Buffer<double>& weights) const {
    if (is_kept(v)) return 1.0;
    if (!is_smooth(v)) {
      double diagonal = 1.0;
      matrix_.visit_row(v, [&](Index column, double weight) {
        if (column == v) {
          diagonal -= weight;
        } else {
          columns.push_back(column);
          weights.push_back(-weight);
        }
      });
      columns.push_back(v);
      weights.push_back(diagonal);
      return 1.0;
    }
    row(v, scratch);
    const double scale = std::max(ratio * scratch.area, scratch.absolute_sum());
    if (!(scale > 0.0)) return 1.0;
    const double factor = kShare / scale;
    for (const auto& entry : scratch.entries) {
      columns.push_back(entry.first);
      weights.push_back(factor * entry.second);
    }
    columns.push_back(v);
    weights.push_back(-factor * scratch.diagonal());
    return scale;
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

}  // namespace

RemainderRows cotangent_rows(const LimitMatrix& matrix, ConstValuesRef points, const Buffer<std::uint8_t>& kept,
                             const Progress& progress) {
  require_vertex_rows(matrix.topology(), points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "cotangents need points of three columns");
  if (!points.allFinite()) throw Error(ErrorCode::NotFinite, "the points hold a number that is not finite");
  const Index count = matrix.topology().vertex_count();
  const CotangentBuilder builder(matrix, points, kept);
  const double ratio = builder.median_ratio(progress_within(progress, 0.0, 0.5));
  struct Block {
    Buffer<Index> columns;
    Buffer<double> weights;
    std::size_t first = 0;
  };
  std::vector<Block> blocks(static_cast<std::size_t>(block_count(count)));
  RemainderRows rows;
  rows.offsets.resize(static_cast<std::size_t>(count) + 1);
  rows.scales.resize(static_cast<std::size_t>(count));
  parallel_for(
      count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Row scratch;
        Block& block = blocks[begin / kDefaultBlock];
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          rows.offsets[v] = block.columns.size();
          rows.scales[v] = builder.append(v, ratio, scratch, block.columns, block.weights);
        }
      },
      kDefaultBlock, progress_within(progress, 0.5, 1.0));
  std::size_t total = 0;
  for (Block& block : blocks) {
    block.first = total;
    total += block.columns.size();
  }
  rows.columns.resize(total);
  rows.weights.resize(total);
  rows.offsets[count] = total;
  parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Block& block = blocks[begin / kDefaultBlock];
    for (std::ptrdiff_t v = begin; v < end; ++v) rows.offsets[v] += block.first;
    std::copy(block.columns.begin(), block.columns.end(),
              rows.columns.begin() + static_cast<std::ptrdiff_t>(block.first));
    std::copy(block.weights.begin(), block.weights.end(),
              rows.weights.begin() + static_cast<std::ptrdiff_t>(block.first));
    block = {};
  });
  return rows;
}

void RemainderRows::apply(const Values& x, Values& out, const Progress& progress) const {
  out.resize(x.rows(), x.cols());
  const Eigen::Index columns_of_x = x.cols();
  parallel_for(
      x.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t v = begin; v < end; ++v) {
          double* target = out.data() + v * columns_of_x;
          for (Eigen::Index c = 0; c < columns_of_x; ++c) target[c] = 0.0;
          for (std::size_t k = offsets[v]; k < offsets[v + 1]; ++k) {
            const double* from = x.data() + columns[k] * columns_of_x;
            for (Eigen::Index c = 0; c < columns_of_x; ++c) target[c] += weights[k] * from[c];
          }
        }
      },
      kDefaultBlock, progress);
}

}  // namespace batten
