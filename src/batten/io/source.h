/// \file The bytes of a file during reading, and how a reader reports where it failed.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "batten/buffer.h"
#include "batten/error.h"
#include "batten/types.h"

namespace batten::io {

/// Text is cut into pieces of about this size, which are parsed in parallel.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// The input of a reader. `chunk_bytes` changes no result; tests make it tiny.
struct Source {
  std::string name;        ///< for messages
  std::string_view bytes;  ///< the whole file
  std::size_t chunk_bytes = kChunkBytes;
  Progress progress = {};  ///< reports the reading of these bytes
  /// What the reader did not understand or left out, a sentence each; null if nobody asks.
  std::vector<std::string>* notes = nullptr;
};

/// Adds "NAME: message" to the notes.
void note(const Source& source, const std::string& message);

/// An error at a byte of the source, thrown and caught inside the readers. Each format turns it into an Error.
struct Fault {
  const char* where;
  ErrorCode code;
  std::string message;
};

/// Throws Error "NAME:LINE: message" for a fault in a text.
[[noreturn]] void throw_at_line(const Source& source, const Fault& fault);

/// The number of the line, counted from 1.
std::ptrdiff_t line_number(const Source& source, const char* where);

/// Throws Error "NAME: message (byte N)" for a fault in binary data.
[[noreturn]] void throw_at_byte(const Source& source, const Fault& fault);

/// Throws Error(TooLarge) if an Index cannot number `count` elements.
void require_index_count(const std::string& name, std::size_t count, const char* elements);

/// A file in memory. The file is read and not mapped: if another program shortened a mapped file, the process would be
/// killed, and the copy costs only a tenth of the fastest parser's time. "-" is standard input.
/// Throws Error(FileNotReadable, Cancelled), and Error(BadFile) for an empty file.
class InputFile {
 public:
  explicit InputFile(const std::string& path, const Progress& progress = {});

  std::string_view bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  Buffer<char> bytes_;
};

}  // namespace batten::io
