/// \file The bytes of a file while a reader works on them, and how a reader says where it gave up.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "batten/buffer.h"
#include "batten/error.h"

namespace batten::io {

/// Text is cut into pieces of about this size, which are parsed in parallel.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// What a reader reads. `chunk_bytes` changes no result; tests make it tiny.
struct Source {
  std::string name;        ///< for messages
  std::string_view bytes;  ///< the whole file
  std::size_t chunk_bytes = kChunkBytes;
};

/// Thrown inside the readers only: what is wrong, and the byte where. The format turns it into an Error.
struct Fault {
  const char* where;
  ErrorCode code;
  std::string message;
};

/// Throws Error "NAME:LINE: message" for a fault in a text.
[[noreturn]] void throw_at_line(const Source& source, const Fault& fault);

/// Throws Error "NAME: message (byte N)" for a fault in binary data.
[[noreturn]] void throw_at_byte(const Source& source, const Fault& fault);

/// Throws Error(TooLarge) when `count` elements cannot be told apart by an Index.
void require_index_count(const std::string& name, std::size_t count, const char* elements);

/// A file in memory: regular files are mapped, so that reading costs no copy; pipes and "-" (standard input) are read.
/// As with every mapped file, one that another program cuts short meanwhile ends the process.
/// Throws Error(FileNotReadable), and Error(BadFile) for a file without a single byte.
class InputFile {
 public:
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::string_view bytes() const { return {data_, size_}; }

 private:
  bool map(int descriptor);
  void read_all(int descriptor, const std::string& name);

  const char* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
  Buffer<char> owned_;
};

}  // namespace batten::io
