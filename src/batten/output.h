/// \file Files that are written whole or not at all, where every failure becomes an Error.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Calls write(temporary_path), then renames the temporary to path; removes the temporary when write throws or the
/// rename fails. The temporary stands in the same folder, which is made where it is missing. A link stays, its target
/// is replaced and keeps its permissions. Devices, pipes, "-" and /dev/stdout cannot be renamed: there write(path) is
/// called. Throws Error(FileNotWritable).
void write_atomically(const std::string& path, const std::function<void(const std::string&)>& write);

/// These bytes and nothing else, by write_atomically; "-" is standard output. Throws Error(FileNotWritable).
void write_bytes(const std::string& path, const Buffer<unsigned char>& bytes);

namespace io {

/// "-" and the names that stand for open descriptors (/dev/stdout, /dev/stderr, /dev/fd/N) write to those.
/// Every member throws Error(FileNotWritable) with the system's reason, and write() Error(Cancelled); the file is
/// truncated when opened.
class OutputFile {
 public:
  /// `name` is what messages call the file; empty: the path. write() asks `progress` whether to go on.
  explicit OutputFile(const std::string& path, const std::string& name = "", const Progress& progress = {});
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& name() const { return name_; }
  /// For the progress: how many rows all calls of write_rows (text_output.h) will have.
  void expect_rows(std::ptrdiff_t count) { expected_rows_ = count; }
  void rows_written(std::ptrdiff_t count) { rows_ += count; }
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// A full disk may show only here.
  void close();

 private:
  void report() const;

  std::string name_;
  Progress progress_;
  std::ptrdiff_t expected_rows_ = 0;
  std::ptrdiff_t rows_ = 0;
  int descriptor_ = -1;
};

/// True where renaming over `path` would be wrong: descriptors, devices, pipes.
bool is_special_target(const std::string& path);

}  // namespace io
}  // namespace batten
