/// \file A file being written: every failure becomes an Error.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace batten::io {

/// "-" and the names that stand for open descriptors (/dev/stdout, /dev/stderr, /dev/fd/N) write to those.
/// Every member throws Error(FileNotWritable) with the system's reason; the file is truncated when opened.
class OutputFile {
 public:
  /// `name` is what messages call the file; empty: the path.
  explicit OutputFile(const std::string& path, const std::string& name = "");
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& name() const { return name_; }
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// A full disk may show only here.
  void close();

 private:
  std::string name_;
  int descriptor_ = -1;
};

/// True where renaming over `path` would be wrong: descriptors, devices, pipes.
bool is_special_target(const std::string& path);

}  // namespace batten::io
