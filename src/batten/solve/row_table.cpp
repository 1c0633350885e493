#include "batten/solve/row_table.h"

#include <algorithm>
#include <unordered_map>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The weights of a row as they come, before it is known whether another row has them too.
struct RowWeights {
  double diagonal = 0.0;
  Buffer<double> off_diagonal;
  std::size_t count = 0;

  std::size_t hash() const {
    std::size_t hash = std::hash<double>()(diagonal);
    for (std::size_t i = 0; i < count; ++i) {
      hash = (hash ^ std::hash<double>()(off_diagonal[i])) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29;
    }
    return hash;
  }
  bool are_those_of(const RowPattern& pattern) const {
    return pattern.diagonal == diagonal && pattern.weights.size() == count &&
           std::equal(pattern.weights.begin(), pattern.weights.end(), off_diagonal.begin());
  }
};

/// Numbers patterns by first appearance.
class PatternIndex {
 public:
  explicit PatternIndex(std::vector<RowPattern>& patterns) : patterns_(patterns) {}

  Index find_or_add(const RowWeights& weights) {
    // Neighbouring rows mostly have the pattern of the row before.
    if (last_ >= 0 && weights.are_those_of(patterns_[last_])) return last_;
    std::vector<Index>& bucket = buckets_[weights.hash()];
    for (const Index candidate : bucket) {
      if (weights.are_those_of(patterns_[candidate])) return last_ = candidate;
    }
    bucket.push_back(static_cast<Index>(patterns_.size()));
    const double* first = weights.off_diagonal.data();
    patterns_.push_back({weights.diagonal, {first, first + weights.count}, {}});
    return last_ = bucket.back();
  }

  Index find_or_add(const RowPattern& pattern) {
    RowWeights weights{pattern.diagonal, {pattern.weights.begin(), pattern.weights.end()}, pattern.weights.size()};
    return find_or_add(weights);
  }

 private:
  std::vector<RowPattern>& patterns_;
  std::unordered_map<std::size_t, std::vector<Index>> buckets_;
  Index last_ = -1;
};

/// Writes the free columns of a row off the diagonal, and their weights; what is held goes to `held`.
void add_free(const RowSource& source, Index row, const RowEntries& entries, Index* columns, RowWeights& weights,
              std::vector<HeldEntry>& held) {
  const std::size_t most = entries.columns.size();
  if (weights.off_diagonal.size() < most) weights.off_diagonal.resize(most);
  weights.diagonal = 0.0;
  weights.count = 0;
  for (std::size_t i = 0; i < most; ++i) {
    const Index column = entries.columns[i];
    if (column == row) {
      weights.diagonal += entries.weights[i];
    } else if (source.is_free(column)) {
      columns[weights.count] = column;
      weights.off_diagonal[weights.count++] = entries.weights[i];
    } else {
      held.push_back({row, column, entries.weights[i]});
    }
  }
}

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
  RowWeights weights;
  Buffer<Index> pattern_of_key;
  Buffer<Index>& columns = block_columns_[first / kBlock];
  columns.resize(static_cast<std::size_t>(last - first) * 9);
  std::size_t used = 0;
  const auto make_room = [&](std::size_t count) {
    if (used + count > columns.size()) columns.resize(std::max(2 * columns.size(), used + count));
    return columns.data() + used;
  };
  for (Index row = first; row < last; ++row) {
    places_[row] = {static_cast<Index>(used), -1};
    if (!source.is_free(row)) continue;
    ++found.free_count;
    const auto key = static_cast<std::size_t>(source.weights_key(row));
    if (key >= pattern_of_key.size()) pattern_of_key.resize(key + 1, -1);
    if (const Index pattern = pattern_of_key[key]; pattern >= 0) {
      const std::size_t count = found.patterns[pattern].weights.size();
      Index* begin = make_room(count);
      source.columns_of(row, begin);
      if (source.all_free() || std::all_of(begin, begin + count, [&](Index c) { return source.is_free(c); })) {
        places_[row].pattern = pattern;
        used += count;
        continue;
      }
    }
    entries.clear();
    source.row(row, entries);
    add_free(source, row, entries, make_room(entries.columns.size()), weights, found.held);
    places_[row].pattern = index.find_or_add(weights);
    used += weights.count;
    const bool complete = weights.count + 1 == entries.columns.size();
    if (key > 0 && complete) pattern_of_key[key] = places_[row].pattern;
  }
  columns.resize(used);
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
