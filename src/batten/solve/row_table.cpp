#include "batten/solve/row_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

std::size_t hash_of(const RowPattern& pattern) {
  std::size_t hash = std::hash<double>()(pattern.diagonal);
  for (const double weight : pattern.weights) {
    hash = (hash ^ std::hash<double>()(weight)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  }
  return hash;
}

/// Numbers patterns by first appearance.
class PatternIndex {
 public:
  explicit PatternIndex(std::vector<RowPattern>& patterns) : patterns_(patterns) {}

  Index find_or_add(const RowPattern& pattern) {
    // Neighbouring rows mostly have the pattern of the row before.
    if (last_ >= 0 && equal(patterns_[last_], pattern)) return last_;
    std::vector<Index>& bucket = buckets_[hash_of(pattern)];
    for (const Index candidate : bucket) {
      if (equal(patterns_[candidate], pattern)) return last_ = candidate;
    }
    bucket.push_back(static_cast<Index>(patterns_.size()));
    patterns_.push_back(pattern);
    return last_ = bucket.back();
  }

 private:
  static bool equal(const RowPattern& a, const RowPattern& b) {
    return a.diagonal == b.diagonal && a.weights == b.weights;
  }
  std::vector<RowPattern>& patterns_;
  std::unordered_map<std::size_t, std::vector<Index>> buckets_;
  Index last_ = -1;
};

}  // namespace

RowTable::RowTable(const RowSource& source, const Progress& progress) : size_(source.size()) {
  blocks_.resize(static_cast<std::size_t>(block_count(size_, kBlock)));
  parallel_for(
      size_,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        fill(source, static_cast<Index>(begin), static_cast<Index>(end), blocks_[begin / kBlock]);
      },
      kBlock, progress);
  merge_patterns();
}

void RowTable::fill(const RowSource& source, Index first, Index last, Block& block) {
  PatternIndex index(block.found);
  RowEntries entries;
  RowPattern pattern;
  block.patterns.assign(static_cast<std::size_t>(last - first), -1);
  block.begins.resize(static_cast<std::size_t>(last - first));
  block.columns.reserve(static_cast<std::size_t>(last - first) * 9);
  for (Index row = first; row < last; ++row) {
    block.begins[row - first] = static_cast<Index>(block.columns.size());
    if (!source.is_free(row)) continue;
    entries.clear();
    source.row(row, entries);
    pattern.diagonal = 0.0;
    pattern.weights.clear();
    for (std::size_t i = 0; i < entries.columns.size(); ++i) {
      const Index column = entries.columns[i];
      if (column == row) {
        pattern.diagonal += entries.weights[i];
      } else if (source.is_free(column)) {
        block.columns.push_back(column);
        pattern.weights.push_back(entries.weights[i]);
      } else {
        block.held.push_back({row, column, entries.weights[i]});
      }
    }
    block.patterns[row - first] = index.find_or_add(pattern);
  }
}

void RowTable::merge_patterns() {
  PatternIndex index(patterns_);
  for (Block& block : blocks_) {
    std::vector<Index> global;
    global.reserve(block.found.size());
    for (const RowPattern& pattern : block.found) global.push_back(index.find_or_add(pattern));
    for (Index& pattern : block.patterns) {
      if (pattern < 0) continue;
      pattern = global[pattern];
      ++free_count_;
    }
    held_.insert(held_.end(), block.held.begin(), block.held.end());
    std::vector<RowPattern>().swap(block.found);
    std::vector<HeldEntry>().swap(block.held);
  }
  for (RowPattern& pattern : patterns_) {
    for (const double weight : pattern.weights) {
      pattern.normalised.push_back(static_cast<float>(weight / pattern.diagonal));
      pattern.off_diagonal_sum += std::abs(weight / pattern.diagonal);
    }
  }
}

}  // namespace batten
