#include "batten/io/source.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "batten/parallel/parallel.h"

namespace batten::io {

namespace {

[[noreturn]] void throw_unreadable(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::FileNotReadable, name + ": cannot be read: " + why);
}

/// Closes the descriptor in its destructor.
struct Descriptor {
  int number;
  bool owned;
  ~Descriptor() {
    if (owned && number >= 0) ::close(number);
  }
};

/// Reads as many bytes as there are, in pieces that threads share.
Buffer<char> read_file(int descriptor, const std::string& name, std::size_t size, const Progress& progress) {
  constexpr std::ptrdiff_t kPiece = std::ptrdiff_t{1} << 20;
  Buffer<char> bytes(size);
  const auto read_piece = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    while (begin < end) {
      const ssize_t got = ::pread(descriptor, bytes.data() + begin, static_cast<std::size_t>(end - begin), begin);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw_unreadable(name, std::strerror(errno));
      if (got == 0) throw_unreadable(name, "another program made it shorter meanwhile; try again when it has finished");
      begin += got;
    }
  };
  parallel_for(static_cast<std::ptrdiff_t>(size), read_piece, kPiece, progress);
  return bytes;
}

/// Reads until the end. Since another program may write slowly, the callback is called ten times a second.
Buffer<char> read_stream(int descriptor, const std::string& name, const Progress& progress) {
  constexpr std::size_t kFirst = std::size_t{1} << 16;
  Buffer<char> bytes(kFirst);
  for (std::size_t size = 0;;) {
    report_progress(progress, 0.0);
    pollfd waiting{descriptor, POLLIN, 0};
    const int ready = progress ? ::poll(&waiting, 1, 100) : 1;
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    if (size == bytes.size()) bytes.resize(2 * size);
    const ssize_t got = ::read(descriptor, bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_unreadable(name, std::strerror(errno));
    size += static_cast<std::size_t>(got);
    if (got == 0) {
      bytes.resize(size);
      return bytes;
    }
  }
}

}  // namespace

void note(const Source& source, const std::string& message) {
  if (source.notes != nullptr) source.notes->push_back(source.name + ": " + message);
}

std::ptrdiff_t line_number(const Source& source, const char* where) {
  return std::count(source.bytes.data(), where, '\n') + 1;
}

void throw_at_line(const Source& source, const Fault& fault) {
  const std::string line = std::to_string(line_number(source, fault.where));
  throw Error(fault.code, source.name + ":" + line + ": " + fault.message);
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

InputFile::InputFile(const std::string& path, const Progress& progress) {
  const bool standard = path == "-";
  const std::string name = standard ? "standard input" : path;
  const Descriptor file{standard ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC), !standard};
  if (file.number < 0) throw_unreadable(name, std::strerror(errno));
  struct stat status {};
  if (::fstat(file.number, &status) != 0) throw_unreadable(name, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw_unreadable(name, "it is a folder; name a file in it");
  // Files that the system generates (/proc) have size 0.
  const bool known = S_ISREG(status.st_mode) && !standard && status.st_size > 0;
  bytes_ = known ? read_file(file.number, name, static_cast<std::size_t>(status.st_size), progress)
                 : read_stream(file.number, name, progress);
  if (bytes_.empty()) throw Error(ErrorCode::BadFile, name + ": the file is empty; write or download it again");
}

}  // namespace batten::io
