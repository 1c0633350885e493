/// \file The binary chunk of a GLB: blocks of numbers, each with its buffer view and accessor.
#pragma once
#include <tiny_gltf.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/types.h"

namespace batten::io {

/// Appends blocks to the first buffer of a model. Every block begins at a multiple of four bytes, as glTF requires.
class GlbBlocks {
 public:
  /// `bytes`: the size of all blocks together. Throws Error(TooLarge) if it exceeds the format's 32-bit lengths.
  GlbBlocks(const std::string& name, tinygltf::Model& model, std::size_t bytes) : model_(model) {
    constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20);
    if (bytes > kLargest) {
      throw Error(ErrorCode::TooLarge, name + ": a GLB holds 4 GiB, and this surface needs " + std::to_string(bytes) +
                                           " bytes; take fewer levels");
    }
    model_.buffers.emplace_back();
    model_.buffers[0].data.reserve(bytes);
  }

  /// Appends K numbers row_of(i) for each i in [0, count), as floats. Returns the accessor's index.
  template <int K, typename RowOf>
  int add_floats(std::ptrdiff_t count, const RowOf& row_of) {
    tinygltf::Accessor accessor;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = K == 1 ? TINYGLTF_TYPE_SCALAR : K;  // TINYGLTF_TYPE_VEC2 is 2, and so on
    accessor.count = static_cast<std::size_t>(count);
    unsigned char* target = add_block(accessor.count * K * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER, accessor);
    parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        const Eigen::Matrix<double, 1, K> row = row_of(i);
        const Eigen::Matrix<float, 1, K> floats = row.template cast<float>();
        std::memcpy(target + i * K * std::ptrdiff_t{sizeof(float)}, floats.data(), sizeof(floats));
      }
    });
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  /// Appends single numbers as floats, for animations. Returns the accessor's index.
  int add_numbers(const double* numbers, std::ptrdiff_t count);

  /// Appends `count` indices, which fill(target) writes.
  template <typename Index, typename Fill>
  int add_indices(std::size_t count, const Fill& fill) {
    tinygltf::Accessor accessor;
    accessor.componentType =
        sizeof(Index) == 2 ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    accessor.type = TINYGLTF_TYPE_SCALAR;
    accessor.count = count;
    unsigned char* target = add_block(count * sizeof(Index), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, accessor);
    fill([target](std::ptrdiff_t place, batten::Index vertex) {
      const auto value = static_cast<Index>(vertex);
      std::memcpy(target + place * std::ptrdiff_t{sizeof(Index)}, &value, sizeof(Index));
    });
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  /// Appends bytes that are no numbers. Returns the buffer view's index.
  int add_bytes(std::string_view bytes);

  /// Adds the bounds of an accessor of `components` floats, computed from the floats.
  void add_bounds(int accessor, int components = 3);

 private:
  /// target: the block's use on a graphics card, or 0.
  unsigned char* add_block(std::size_t bytes, int target, tinygltf::Accessor accessor);
  unsigned char* add_view(std::size_t bytes, int target);

  tinygltf::Model& model_;
};

}  // namespace batten::io
