/// \file Files are written completely or not at all, and every failure becomes an Error.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Calls write(temporary_path) and then renames the temporary file to path. It removes the temporary file when write
/// throws or when the rename fails. The temporary file is in the folder of path, which is created if necessary. Where
/// path is a link, the link stays and its target is replaced; the permissions of an existing file are kept. Devices,
/// pipes, "-" and /dev/stdout cannot be renamed: for those write(path) is called. Throws Error(FileNotWritable).
void write_atomically(const std::string& path, const std::function<void(const std::string&)>& write);

/// Writes these bytes with write_atomically; "-" is standard output. Throws Error(FileNotWritable).
void write_bytes(const std::string& path, const Buffer<unsigned char>& bytes);

namespace io {

/// A file that is open for writing. "-" and the names of open descriptors (/dev/stdout, /dev/stderr, /dev/fd/N) write
/// to those descriptors. Opening truncates the file. Every member throws Error(FileNotWritable) with the system's
/// reason; write() also throws Error(Cancelled).
class OutputFile {
 public:
  /// `name` is what messages call the file, the path if empty. write() reports to `progress`, which may cancel.
  explicit OutputFile(const std::string& path, const std::string& name = "", const Progress& progress = {});
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& name() const { return name_; }
  /// Sets how many rows all calls of write_rows (io/text_output.h) will write together, for the progress.
  void expect_rows(std::ptrdiff_t count) { expected_rows_ = count; }
  void rows_written(std::ptrdiff_t count) { rows_ += count; }
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Closes the file. A full disk may only be noticed here.
  void close();

 private:
  void report() const;

  std::string name_;
  Progress progress_;
  std::ptrdiff_t expected_rows_ = 0;
  std::ptrdiff_t rows_ = 0;
  int descriptor_ = -1;
};

/// True for descriptors, devices and pipes, which must not be replaced by a rename.
bool is_special_target(const std::string& path);

}  // namespace io
}  // namespace batten
