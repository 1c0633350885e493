#include "batten/fit/cloud_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

using BoxKey = std::uint64_t;
constexpr int kBoxBits = 20;

/// The box of a place in [-1/2, 1/2]^3, one bit of room on each side.
BoxKey box_key(const Points& points, Eigen::Index row, double boxes) {
  BoxKey key = 0;
  for (Eigen::Index c = 0; c < 3; ++c)
    key = key << kBoxBits | static_cast<BoxKey>(std::floor((points(row, c) + 0.5) * boxes) + 2.0);
  return key;
}

struct KeyedRow {
  BoxKey key;
  Index row;
};

/// The boxes with points: rows sorted by box, and where each begins.
struct FilledBoxes {
  std::vector<KeyedRow> rows;
  std::vector<Index> starts;  ///< one more than boxes
  std::vector<std::uint8_t> kept;
  Index kept_count = 0;
  std::size_t size() const { return starts.size() - 1; }
  Index count(std::size_t box) const { return starts[box + 1] - starts[box]; }
};

FilledBoxes fill_boxes(const Points& points, double boxes) {
  FilledBoxes filled;
  filled.rows.resize(static_cast<std::size_t>(points.rows()));
  parallel_for(points.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t row = begin; row < end; ++row)
      filled.rows[row] = {box_key(points, row, boxes), static_cast<Index>(row)};
  });
  std::sort(filled.rows.begin(), filled.rows.end(),
            [](const KeyedRow& a, const KeyedRow& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
  for (std::size_t i = 0; i < filled.rows.size(); ++i) {
    if (i == 0 || filled.rows[i].key != filled.rows[i - 1].key) filled.starts.push_back(static_cast<Index>(i));
  }
  filled.starts.push_back(static_cast<Index>(filled.rows.size()));
  return filled;
}

/// How many points lie in each box and the 26 around it.
std::vector<double> counts_around(const FilledBoxes& filled) {
  std::vector<double> around(filled.size(), 0.0);
  std::vector<BoxKey> keys(filled.size());
  for (std::size_t box = 0; box < keys.size(); ++box) keys[box] = filled.rows[filled.starts[box]].key;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      // Three boxes in a row along z follow each other; both lists run on together.
      const auto step = static_cast<BoxKey>((std::int64_t{dx} * (std::int64_t{1} << 2 * kBoxBits)) +
                                            (std::int64_t{dy} * (std::int64_t{1} << kBoxBits)));
      std::size_t other = 0;
      for (std::size_t box = 0; box < keys.size(); ++box) {
        const BoxKey low = keys[box] + step - 1;
        while (other < keys.size() && keys[other] < low) ++other;
        for (std::size_t near = other; near < keys.size() && keys[near] <= low + 2; ++near)
          around[box] += filled.count(near);
      }
    }
  }
  return around;
}

/// Leaves out boxes around which there are far fewer points than around the median point.
void mark_filled(FilledBoxes& filled) {
  constexpr double kFew = 0.03;
  const std::vector<double> around = counts_around(filled);
  std::vector<double> of_points;
  of_points.reserve(filled.rows.size());
  for (std::size_t box = 0; box < filled.size(); ++box)
    of_points.insert(of_points.end(), filled.count(box), around[box]);
  const double usual = quantile(of_points, 0.5);
  filled.kept.assign(filled.size(), 0);
  filled.kept_count = 0;
  for (std::size_t box = 0; box < filled.size(); ++box) {
    filled.kept[box] = around[box] >= kFew * usual ? 1 : 0;
    filled.kept_count += filled.kept[box];
  }
}

/// The means of the kept boxes. The points of a box are added in the order of their coordinates.
void take_means(CloudSamples& samples, const FilledBoxes& filled) {
  const bool has_normals = samples.normals.rows() > 0;
  std::vector<std::size_t> boxes;
  for (std::size_t box = 0; box < filled.size(); ++box) {
    if (filled.kept[box] != 0) boxes.push_back(box);
  }
  Points points(static_cast<Eigen::Index>(boxes.size()), 3);
  Points normals(has_normals ? points.rows() : 0, 3);
  const auto take = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    using Row = std::array<double, 6>;
    std::vector<Row> rows;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      rows.clear();
      for (Index at = filled.starts[boxes[i]]; at < filled.starts[boxes[i] + 1]; ++at) {
        const Index row = filled.rows[at].row;
        Row numbers{samples.points(row, 0), samples.points(row, 1), samples.points(row, 2), 0.0, 0.0, 0.0};
        for (Index c = 0; has_normals && c < 3; ++c) numbers[3 + c] = samples.normals(row, c);
        rows.push_back(numbers);
      }
      std::sort(rows.begin(), rows.end());
      Row sum{};
      for (const Row& row : rows) {
        for (std::size_t c = 0; c < 6; ++c) sum[c] += row[c];
      }
      for (Index c = 0; c < 3; ++c) {
        points(i, c) = sum[c] / static_cast<double>(rows.size());
        if (has_normals) normals(i, c) = sum[3 + c];
      }
    }
  };
  parallel_for(points.rows(), take, 256);
  samples.points = std::move(points);
  samples.normals = std::move(normals);
}

}  // namespace

void thin_cloud(CloudSamples& samples, Index wanted, const Progress& progress) {
  constexpr double kMostBoxes = 1 << 18;
  double boxes = 96.0;
  FilledBoxes filled;
  for (int round = 0; round < 4; ++round) {
    report_progress(progress, 0.25 * round);
    filled = fill_boxes(samples.points, boxes);
    mark_filled(filled);
    const double share = static_cast<double>(filled.kept_count) / wanted;
    if ((share > 0.5 && share < 1.5) || boxes >= kMostBoxes) break;
    if (round < 3) boxes = std::min(kMostBoxes, boxes / std::sqrt(share));
  }
  for (std::size_t box = 0; box < filled.size(); ++box) {
    if (filled.kept[box] == 0) samples.outliers += filled.count(box);
  }
  take_means(samples, filled);
}

}  // namespace batten
