#include "batten/io/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "batten/types.h"
#if !defined(__EMSCRIPTEN__)
#include <sys/mman.h>
#endif

namespace batten::io {

namespace {

[[noreturn]] void throw_unreadable(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::FileNotReadable, name + ": cannot be read: " + why);
}

/// Closes on every way out.
struct Descriptor {
  int number;
  bool owned;
  ~Descriptor() {
    if (owned && number >= 0) ::close(number);
  }
};

}  // namespace

void throw_at_line(const Source& source, const Fault& fault) {
  const std::string_view before(source.bytes.data(), static_cast<std::size_t>(fault.where - source.bytes.data()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  throw Error(fault.code, source.name + ":" + std::to_string(line) + ": " + fault.message);
}

void throw_at_byte(const Source& source, const Fault& fault) {
  const auto byte = fault.where - source.bytes.data();
  throw Error(fault.code, source.name + ": " + fault.message + " (byte " + std::to_string(byte) + ")");
}

void require_index_count(const std::string& name, std::size_t count, const char* elements) {
  if (count < static_cast<std::size_t>(std::numeric_limits<Index>::max())) return;
  throw Error(ErrorCode::TooLarge, name + ": " + std::to_string(count) + " " + elements +
                                       " are more than a 32-bit index can count; split the file");
}

InputFile::InputFile(const std::string& path) {
  const bool standard = path == "-";
  const std::string name = standard ? "standard input" : path;
  const Descriptor file{standard ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC), !standard};
  if (file.number < 0) throw_unreadable(name, std::strerror(errno));
  struct stat status {};
  if (::fstat(file.number, &status) != 0) throw_unreadable(name, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw_unreadable(name, "it is a folder; name a file in it");
  if (!(S_ISREG(status.st_mode) && !standard && map(file.number))) read_all(file.number, name);
  if (size_ == 0) throw Error(ErrorCode::BadFile, name + ": the file is empty; write or download it again");
}

InputFile::~InputFile() {
#if !defined(__EMSCRIPTEN__)
  if (mapped_) ::munmap(const_cast<char*>(data_), size_);
#endif
}

bool InputFile::map(int descriptor) {
#if defined(__EMSCRIPTEN__)
  (void)descriptor;
  return false;
#else
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || status.st_size <= 0) return false;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (memory == MAP_FAILED) return false;
  ::madvise(memory, size, MADV_WILLNEED);
  data_ = static_cast<const char*>(memory);
  size_ = size;
  mapped_ = true;
  return true;
#endif
}

void InputFile::read_all(int descriptor, const std::string& name) {
  constexpr std::size_t kFirst = std::size_t{1} << 16;
  owned_.resize(kFirst);
  for (;;) {
    if (size_ == owned_.size()) owned_.resize(2 * size_);
    const ssize_t got = ::read(descriptor, owned_.data() + size_, owned_.size() - size_);
    if (got == 0) break;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_unreadable(name, std::strerror(errno));
    size_ += static_cast<std::size_t>(got);
  }
  data_ = owned_.data();
}

}  // namespace batten::io
