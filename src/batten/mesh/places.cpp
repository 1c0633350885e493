#include "batten/mesh/places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t x : cell)
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U + (hash >> 29);
    return hash;
  }
};

std::uint64_t coordinate_hash(const Eigen::RowVector3d& point) {
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k) {
    const double x = point[k] + 0.0;  // -0 equals 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof(bits));
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32;
  }
  return hash;
}

Buffer<Index> equal_places(const Points& points, const Buffer<Index>& rows) {
  Buffer<Index> order(rows.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  const auto row = [&](Index i) { return points.row(rows[i]); };
  const auto less = [&](Index i, Index j) {
    for (int k = 0; k < 3; ++k) {
      if (row(i)[k] != row(j)[k]) return row(i)[k] < row(j)[k];
    }
    return i < j;
  };
  std::sort(order.begin(), order.end(), less);
  Buffer<Index> numbers(rows.size());
  Index number = -1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || row(order[i]) != row(order[i - 1])) ++number;
    numbers[order[i]] = number;
  }
  return numbers;
}

/// Rows in order: each takes the place of the first earlier row within reach that has a place of its own.
Buffer<Index> near_places(const Points& points, const Buffer<Index>& rows, double tolerance) {
  std::unordered_map<Cell, std::vector<Index>, CellHash> cells;
  Buffer<Index> numbers(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::RowVector3d point = points.row(rows[i]);
    Cell cell;
    for (int k = 0; k < 3; ++k) cell[k] = static_cast<std::int64_t>(std::floor(point[k] / tolerance));
    auto nearest = static_cast<Index>(i);
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const auto found =
          cells.find({cell[0] + neighbour % 3 - 1, cell[1] + neighbour / 3 % 3 - 1, cell[2] + neighbour / 9 - 1});
      if (found == cells.end()) continue;
      for (const Index other : found->second) {
        const bool within = (points.row(rows[other]) - point).cwiseAbs().maxCoeff() <= tolerance;
        if (within) nearest = std::min(nearest, other);
      }
    }
    if (nearest == static_cast<Index>(i)) cells[cell].push_back(nearest);
    numbers[i] = nearest;
  }
  return numbers;
}

}  // namespace

Buffer<Index> place_numbers(const Points& points, const Buffer<Index>& rows, double tolerance) {
  double largest = 0.0;
  for (const Index row : rows) largest = std::max(largest, points.row(row).cwiseAbs().maxCoeff());
  // A tolerance below the resolution of a double would make the cells' numbers overflow.
  return tolerance > 1e-16 * largest ? near_places(points, rows, tolerance) : equal_places(points, rows);
}

namespace {

/// Rows by the hash of their point, so that equal points are in one part, and the parts are small enough for a cache.
struct HashParts {
  Buffer<std::uint64_t> hashes;  ///< of row i
  Buffer<Index> rows;            ///< part after part, each in ascending order
  std::vector<Index> starts;
};

HashParts part_by_hash(const Points& points, const Buffer<Index>& rows) {
  constexpr std::size_t kPartBits = 8;
  constexpr std::size_t kWorthParts = 1U << 15U;
  const std::size_t bits = rows.size() < kWorthParts ? 0 : kPartBits;
  HashParts parts{Buffer<std::uint64_t>(rows.size()), Buffer<Index>(rows.size()), {}};
  parallel_for(static_cast<std::ptrdiff_t>(rows.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) parts.hashes[i] = coordinate_hash(points.row(rows[i]));
  });
  // Tables take the low bits of a hash.
  const auto part_of = [&](std::size_t i) { return parts.hashes[i] >> 32U & ((std::size_t{1} << bits) - 1); };
  parts.starts.assign((std::size_t{1} << bits) + 1, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) ++parts.starts[part_of(i) + 1];
  std::partial_sum(parts.starts.begin(), parts.starts.end(), parts.starts.begin());
  std::vector<Index> next(parts.starts.begin(), parts.starts.end() - 1);
  for (std::size_t i = 0; i < rows.size(); ++i) parts.rows[next[part_of(i)]++] = static_cast<Index>(i);
  return parts;
}

}  // namespace

Buffer<Index> first_equal(const Points& points, const Buffer<Index>& rows) {
  const HashParts parts = part_by_hash(points, rows);
  Buffer<Index> first(rows.size());
  parallel_for_each(static_cast<std::ptrdiff_t>(parts.starts.size()) - 1, [&](std::ptrdiff_t part) {
    const Index begin = parts.starts[part];
    const Index end = parts.starts[part + 1];
    std::size_t size = 2;
    while (size < 2 * static_cast<std::size_t>(end - begin)) size *= 2;
    Buffer<Index> table(size, -1);
    for (Index k = begin; k < end; ++k) {
      const Index i = parts.rows[k];
      const Eigen::RowVector3d point = points.row(rows[i]);
      std::size_t slot = parts.hashes[i] & (size - 1);
      while (table[slot] >= 0 && points.row(rows[table[slot]]) != point) slot = (slot + 1) & (size - 1);
      if (table[slot] < 0) table[slot] = i;
      first[i] = table[slot];
    }
  });
  return first;
}

Index coincident_count(const Points& points) {
  Buffer<Index> rows;
  rows.reserve(static_cast<std::size_t>(points.rows()));
  for (Index v = 0; v < points.rows(); ++v) {
    if (points.row(v).allFinite()) rows.push_back(v);
  }
  const Buffer<Index> first = first_equal(points, rows);
  Index count = 0;
  for (std::size_t i = 0; i < first.size(); ++i) count += first[i] != static_cast<Index>(i) ? 1 : 0;
  return count;
}

}  // namespace batten
