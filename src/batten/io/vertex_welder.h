/// \file Vertices with equal coordinates become one.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "batten/io/source.h"
#include "batten/types.h"

namespace batten::io {

/// Makes equal coordinates one vertex, numbered by first appearance, with a hash table with open addressing.
class VertexWelder {
 public:
  explicit VertexWelder(const std::string& name) : name_(name), slots_(kFirstSlots, kFree) {}

  Index add(const double* point) {
    if (2 * count_ >= slots_.size()) grow();
    const std::size_t slot = find(point);
    if (slots_[slot] == kFree) {
      require_index_count(name_, count_ + 1, "vertices");
      slots_[slot] = static_cast<Index>(count_++);
      coordinates_.insert(coordinates_.end(), point, point + 3);
    }
    return slots_[slot];
  }

  Points points() const { return Eigen::Map<const Points>(coordinates_.data(), static_cast<Eigen::Index>(count_), 3); }

 private:
  static constexpr Index kFree = -1;
  static constexpr std::size_t kFirstSlots = 1024;

  static std::uint64_t hash(const double* point) {
    std::uint64_t mixed = 0;
    for (int k = 0; k < 3; ++k) {
      const double value = point[k] + 0.0;  // -0 equals 0
      std::uint64_t bits;
      std::memcpy(&bits, &value, sizeof(bits));
      mixed = (mixed ^ bits) * 0x9E3779B97F4A7C15U;
      mixed ^= mixed >> 32;
    }
    return mixed;
  }

  /// The slot of the vertex, or the free one for it.
  std::size_t find(const double* point) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(point) & mask;
    while (slots_[slot] != kFree &&
           !std::equal(point, point + 3, coordinates_.data() + 3 * std::size_t(slots_[slot]))) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::size_t vertex = 0; vertex < count_; ++vertex) {
      slots_[find(coordinates_.data() + 3 * vertex)] = static_cast<Index>(vertex);
    }
  }

  const std::string& name_;
  std::vector<Index> slots_;
  Buffer<double> coordinates_;
  std::size_t count_ = 0;
};

}  // namespace batten::io
