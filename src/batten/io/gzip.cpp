#include "batten/io/gzip.h"

#include <algorithm>
#ifdef BATTEN_WITH_ZLIB
#include <zlib.h>
#endif

#include "batten/error.h"
#include "batten/progress.h"

namespace batten::io {

bool is_gzip(std::string_view bytes) { return bytes.substr(0, 2) == "\x1f\x8b"; }

#ifdef BATTEN_WITH_ZLIB

namespace {

/// zlib's state, which it frees in its destructor.
class Unpacker {
 public:
  explicit Unpacker(const Source& source) : source_(source) {
    constexpr int kGzip = 16;  // added to the window's bits: the gzip header is expected and its checksum compared
    if (::inflateInit2(&stream_, MAX_WBITS + kGzip) != Z_OK) throw std::bad_alloc();
  }
  ~Unpacker() { ::inflateEnd(&stream_); }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  Buffer<char> unpack() {
    while (at_ < source_.bytes.size() && (at_ == 0 || is_gzip(source_.bytes.substr(at_)))) {
      ::inflateReset(&stream_);
      unpack_member();
    }
    const auto rest = source_.bytes.begin() + static_cast<std::ptrdiff_t>(at_);
    if (!std::all_of(rest, source_.bytes.end(), [](char c) { return c == 0; })) {
      fail("other bytes follow the packed content");
    }
    if (size_ == 0) fail("the packed file is empty");
    content_.resize(size_);
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::BadFile, source_.name + ": " + what + "; download or pack it again");
  }

  /// Unpacks from at_ to the end of one gzip file in pieces, since zlib counts in 32 bits and somebody may cancel.
  void unpack_member() {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    for (int status = Z_OK; status != Z_STREAM_END;) {
      report_progress(source_.progress, static_cast<double>(at_) / static_cast<double>(source_.bytes.size()));
      if (content_.size() < size_ + kPiece) content_.resize(std::max(2 * content_.size(), kPiece));
      const std::string_view packed = source_.bytes.substr(at_, kPiece);
      // zlib does not write to its input, but old interfaces of it are not const.
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream_.avail_in = static_cast<uInt>(packed.size());
      stream_.next_out = reinterpret_cast<Bytef*>(content_.data() + size_);
      stream_.avail_out = static_cast<uInt>(kPiece);
      status = ::inflate(&stream_, Z_NO_FLUSH);
      at_ += packed.size() - stream_.avail_in;
      size_ += kPiece - stream_.avail_out;
      if (status == Z_MEM_ERROR) throw std::bad_alloc();
      if (status == Z_BUF_ERROR || (status == Z_OK && at_ == source_.bytes.size() && stream_.avail_out > 0)) {
        fail("the packed file is cut short");
      }
      if (status != Z_OK && status != Z_STREAM_END) fail("the packed file is damaged");
    }
  }

  const Source& source_;
  z_stream stream_ = {};
  std::size_t at_ = 0;
  Buffer<char> content_;
  std::size_t size_ = 0;
};

}  // namespace

Buffer<char> unpack_gzip(const Source& source) { return Unpacker(source).unpack(); }

#else

Buffer<char> unpack_gzip(const Source& source) {
  throw Error(ErrorCode::NotAvailable,
              source.name + ": this build unpacks no gzip files; configure with BATTEN_WITH_ZLIB=ON, or run gunzip");
}

#endif

}  // namespace batten::io
