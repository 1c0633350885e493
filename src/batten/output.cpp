#include "batten/output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>

#include "batten/error.h"
#include "batten/progress.h"

namespace batten {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void throw_unwritable(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::FileNotWritable, name + ": cannot be written: " + why);
}

/// The descriptor that this name stands for, or -1 for an ordinary name.
int named_descriptor(const std::string& path) {
  if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    const std::string digits = path.substr(std::min(prefix.size(), path.size()));
    if (path.rfind(prefix, 0) != 0 || digits.empty() || digits.size() > 6) continue;
    if (std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; })) {
      return std::atoi(digits.c_str());
    }
  }
  return -1;
}

void make_parent_folder(const fs::path& target) {
  const fs::path folder = target.parent_path();
  std::error_code error;
  if (folder.empty() || fs::is_directory(folder, error)) return;
  fs::create_directories(folder, error);
  if (error) {
    throw_unwritable(target.string(), "the folder " + folder.string() + " does not exist and cannot be made (" +
                                          error.message() + "); make it or choose another");
  }
}

/// A name in the target's folder that no other call uses and that is short enough for every file system.
fs::path temporary_beside(const fs::path& target) {
  constexpr std::size_t kKeptName = 100;
  static std::atomic<unsigned> calls{0};
  const std::string name = target.filename().string().substr(0, kKeptName);
  const std::string unique = std::to_string(::getpid()) + "." + std::to_string(calls.fetch_add(1));
  return target.parent_path() / ("." + name + "." + unique + ".tmp");
}

/// Removes the temporary unless it was renamed.
struct TemporaryFile {
  fs::path path;
  bool renamed = false;
  ~TemporaryFile() {
    std::error_code ignored;
    if (!renamed) fs::remove(path, ignored);
  }
};

}  // namespace

namespace io {

OutputFile::OutputFile(const std::string& path, const std::string& name, const Progress& progress)
    : name_(name.empty() ? path : name), progress_(progress) {
  const int known = named_descriptor(path);
  do {
    descriptor_ = known >= 0 ? ::dup(known) : ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ < 0) throw_unwritable(name_, std::strerror(errno));
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::report() const {
  const double done = static_cast<double>(rows_) / static_cast<double>(std::max<std::ptrdiff_t>(expected_rows_, 1));
  report_progress(progress_, std::min(done, 1.0));
}

void OutputFile::write(const void* bytes, std::size_t count) {
  // Writing in pieces lets a user cancel while the disk is slow.
  constexpr std::size_t kMost = std::size_t{1} << 23;
  const char* at = static_cast<const char*>(bytes);
  while (count > 0) {
    report();
    const ssize_t written = ::write(descriptor_, at, std::min(count, kMost));
    // The signal may be the user's request to stop, so the callback is asked again.
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_unwritable(name_, std::strerror(errno));
    at += written;
    count -= static_cast<std::size_t>(written);
  }
}

void OutputFile::close() {
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0 && errno != EINTR) throw_unwritable(name_, std::strerror(errno));
}

bool is_special_target(const std::string& path) {
  if (named_descriptor(path) >= 0) return true;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace io

void write_atomically(const std::string& path, const std::function<void(const std::string&)>& write) {
  if (path.empty()) throw_unwritable("''", "the file name is empty");
  if (io::is_special_target(path)) {
    write(path);
    return;
  }
  std::error_code error;
  // A link is kept: the file that it names is replaced.
  const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : fs::path(path);
  if (target.empty()) throw_unwritable(path, error.message());
  const bool exists = fs::exists(target, error);
  if (fs::is_directory(target, error) || !target.has_filename()) {
    throw_unwritable(path, "it is a folder; name a file in it");
  }
  if (exists && ::access(target.c_str(), W_OK) != 0) throw_unwritable(path, std::strerror(errno));
  make_parent_folder(target);
  TemporaryFile temporary{temporary_beside(target)};
  write(temporary.path.string());
  if (exists) fs::permissions(temporary.path, fs::status(target, error).permissions(), error);
  fs::rename(temporary.path, target, error);
  if (error) throw_unwritable(path, error.message());
  temporary.renamed = true;
}

void write_bytes(const std::string& path, const Buffer<unsigned char>& bytes) {
  write_atomically(path, [&](const std::string& target) {
    io::OutputFile file(target, path);
    file.write(bytes.data(), bytes.size());
    file.close();
  });
}

}  // namespace batten
