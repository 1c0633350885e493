/// \file Text output: numbers that read back bit for bit, formatted in parallel.
#pragma once
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "batten/buffer.h"
#include "batten/mesh/mesh.h"
#include "batten/output.h"
#include "batten/parallel/parallel.h"
#include "batten/types.h"

namespace batten::io {

/// A growing sequence of bytes that is written as one block.
class OutputBuffer {
 public:
  void clear() { size_ = 0; }
  std::string_view text() const { return {buffer_.data(), size_}; }

 protected:
  /// Space for `count` bytes. grow() then says how many were used.
  char* room(std::size_t count) {
    if (size_ + count >= buffer_.size()) buffer_.resize(std::max(size_ + count, 2 * buffer_.size()) + kFirst);
    return buffer_.data() + size_;
  }
  void grow(std::size_t count) { size_ += count; }

 private:
  static constexpr std::size_t kFirst = 4096;

  Buffer<char> buffer_;
  std::size_t size_ = 0;
};

/// A text without a terminating zero.
class TextBuffer : public OutputBuffer {
 public:
  TextBuffer& put(char c) {
    *room(1) = c;
    grow(1);
    return *this;
  }
  TextBuffer& put(std::string_view words) {
    std::memcpy(room(words.size()), words.data(), words.size());
    grow(words.size());
    return *this;
  }
  TextBuffer& put(Index value) {
    char* begin = room(kLongestNumber);
    grow(static_cast<std::size_t>(std::to_chars(begin, begin + kLongestNumber, value).ptr - begin));
    return *this;
  }
  /// Appends the fewest digits that read back to the same double, or 17 digits if the standard library has no such
  /// function.
  TextBuffer& put(double value) {
    char* begin = room(kLongestNumber);
#ifdef __cpp_lib_to_chars
    grow(static_cast<std::size_t>(std::to_chars(begin, begin + kLongestNumber, value).ptr - begin));
#else
    grow(static_cast<std::size_t>(std::snprintf(begin, kLongestNumber, "%.17g", value)));
#endif
    return *this;
  }
  /// Appends each number of an Eigen row after a blank.
  template <typename Row>
  TextBuffer& put_row(const Row& row) {
    for (Eigen::Index i = 0; i < row.size(); ++i) put(' ').put(row[i]);
    return *this;
  }

 private:
  static constexpr std::size_t kLongestNumber = 32;
};

/// Calls body(output, row) for each row of [0, count), blocks of rows in parallel, and writes the outputs in order.
/// `Output` has clear() and text(). Memory: a few megabytes for any count (more for very long rows).
template <typename Output, typename Body>
void write_rows(OutputFile& file, std::ptrdiff_t count, const Body& body) {
  constexpr std::ptrdiff_t kBlock = 4096;
  constexpr std::ptrdiff_t kBatch = 16;
  std::vector<Output> outputs(static_cast<std::size_t>(std::min(block_count(count, kBlock), kBatch)));
  for (std::ptrdiff_t first = 0; first < count; first += kBlock * kBatch) {
    const std::ptrdiff_t blocks = std::min(block_count(count - first, kBlock), kBatch);
    parallel_for_each(blocks, [&](std::ptrdiff_t i) {
      outputs[i].clear();
      const std::ptrdiff_t begin = first + i * kBlock;
      const std::ptrdiff_t end = std::min(begin + kBlock, count);
      for (std::ptrdiff_t row = begin; row < end; ++row) body(outputs[i], row);
    });
    for (std::ptrdiff_t i = 0; i < blocks; ++i) file.write(outputs[i].text());
    file.rows_written(std::min(kBlock * kBatch, count - first));
  }
}

/// Writes a line for each face: its size and its vertices, counted from 0 (OFF and PLY).
inline void write_face_rows(OutputFile& file, const Mesh& mesh) {
  write_rows<TextBuffer>(file, mesh.face_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
    const auto face = static_cast<Index>(row);
    out.put(mesh.face_size(face));
    for (Index i = mesh.face_offsets[face]; i < mesh.face_offsets[face + 1]; ++i) {
      out.put(' ').put(mesh.face_vertices[i]);
    }
    out.put('\n');
  });
}

}  // namespace batten::io
