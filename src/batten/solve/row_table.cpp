#include "batten/solve/row_table.h"

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
    if (last_ >= 0 && patterns_[last_] == pattern) return last_;
    std::vector<Index>& bucket = buckets_[hash_of(pattern)];
    for (const Index candidate : bucket) {
      if (patterns_[candidate] == pattern) return last_ = candidate;
    }
    bucket.push_back(static_cast<Index>(patterns_.size()));
    patterns_.push_back(pattern);
    return last_ = bucket.back();
  }

 private:
  std::vector<RowPattern>& patterns_;
  std::unordered_map<std::size_t, std::vector<Index>> buckets_;
  Index last_ = -1;
};

}  // namespace

RowTable::RowTable(const RowSource& source, const Progress& progress)
    : places_(static_cast<std::size_t>(source.size())),
      block_columns_(static_cast<std::size_t>(block_count(source.size(), kBlock))) {
  std::vector<Found> found(block_columns_.size());
  parallel_for(
      size(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        fill(source, static_cast<Index>(begin), static_cast<Index>(end), found[begin / kBlock]);
      },
      kBlock, progress);
  merge(found);
}

void RowTable::fill(const RowSource& source, Index first, Index last, Found& found) {
  PatternIndex index(found.patterns);
  RowEntries entries;
  RowPattern pattern;
  Buffer<Index>& columns = block_columns_[first / kBlock];
  columns.reserve(static_cast<std::size_t>(last - first) * 9);
  for (Index row = first; row < last; ++row) {
    places_[row] = {static_cast<Index>(columns.size()), -1};
    if (!source.is_free(row)) continue;
    ++found.free_count;
    entries.clear();
    source.row(row, entries);
    pattern.diagonal = 0.0;
    pattern.weights.clear();
    for (std::size_t i = 0; i < entries.columns.size(); ++i) {
      const Index column = entries.columns[i];
      if (column == row) {
        pattern.diagonal += entries.weights[i];
      } else if (source.is_free(column)) {
        columns.push_back(column);
        pattern.weights.push_back(entries.weights[i]);
      } else {
        found.held.push_back({row, column, entries.weights[i]});
      }
    }
    places_[row].pattern = index.find_or_add(pattern);
  }
}

void RowTable::merge(std::vector<Found>& found) {
  PatternIndex index(patterns_);
  std::vector<std::vector<Index>> global(found.size());
  for (std::size_t b = 0; b < found.size(); ++b) {
    for (const RowPattern& pattern : found[b].patterns) global[b].push_back(index.find_or_add(pattern));
    held_.insert(held_.end(), found[b].held.begin(), found[b].held.end());
    free_count_ += found[b].free_count;
  }
  parallel_for(
      size(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) {
          Index& pattern = places_[row].pattern;
          if (pattern >= 0) pattern = global[begin / kBlock][pattern];
        }
      },
      kBlock);
  for (RowPattern& pattern : patterns_) {
    counts_.push_back(static_cast<Index>(pattern.weights.size()));
    for (const double weight : pattern.weights) {
      pattern.normalised.push_back(static_cast<float>(weight / pattern.diagonal));
    }
  }
}

}  // namespace batten
