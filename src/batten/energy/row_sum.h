/// \file The sum of sparse rows.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// One row at a time: adds up entries of the same column. Which columns it has stands in bits, and which words of these
/// are not zero in bits again, so that columns come out ascending without a sort.
class RowSum {
 public:
  explicit RowSum(Index columns)
      : places_(static_cast<std::size_t>(columns), kNone),
        bits_(static_cast<std::size_t>(columns) / 64 + 1, 0),
        words_(bits_.size() / 64 + 1, 0),
        first_word_(static_cast<Index>(words_.size())) {}

  /// Adds weight(j) at columns[j], for each j.
  template <typename Weight>
  void add(std::span<const Index> columns, const Weight& weight) {
    if (values_.size() < count_ + columns.size()) values_.resize(2 * (count_ + columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      Index& place = places_[columns[j]];
      if (place == kNone) {
        place = static_cast<Index>(count_);
        mark(columns[j]);
        values_[count_++] = weight(static_cast<Index>(j));
      } else {
        values_[place] += weight(static_cast<Index>(j));
      }
    }
  }

  std::size_t size() const { return count_; }

  /// Calls visit(column, value), columns ascending, and forgets the row.
  template <typename Visit>
  void take(const Visit& visit) {
    for (Index w = first_word_; w <= last_word_; ++w) {
      for_bits(words_[w], 64 * w, [&](Index word) {
        for_bits(bits_[word], 64 * word, [&](Index column) {
          visit(column, values_[places_[column]]);
          places_[column] = kNone;
        });
      });
    }
    count_ = 0;
    first_word_ = static_cast<Index>(words_.size());
    last_word_ = -1;
  }

 private:
  static constexpr Index kNone = -1;

  void mark(Index column) {
    const Index word = column / 64;
    bits_[word] |= std::uint64_t{1} << (column % 64);
    words_[word / 64] |= std::uint64_t{1} << (word % 64);
    first_word_ = std::min(first_word_, word / 64);
    last_word_ = std::max(last_word_, word / 64);
  }
  /// Calls visit(first + b) for each bit b, ascending, and clears them.
  template <typename Visit>
  static void for_bits(std::uint64_t& bits, Index first, const Visit& visit) {
    for (; bits != 0; bits &= bits - 1) visit(first + static_cast<Index>(std::countr_zero(bits)));
  }

  Buffer<Index> places_;  ///< of each column among those of the row, or kNone
  Buffer<double> values_;
  Buffer<std::uint64_t> bits_;
  Buffer<std::uint64_t> words_;
  Index first_word_;
  Index last_word_ = -1;
  std::size_t count_ = 0;
};

}  // namespace batten
