#include "batten/io/scanner.h"

#include <algorithm>

namespace batten::io {

std::string in_quotes(std::string_view token) {
  constexpr std::size_t kShown = 40;
  std::string text(token.substr(0, kShown));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return "'" + text + (token.size() > kShown ? "...'" : "'");
}

std::string Scanner::rest_of_line() {
  std::string text;
  for (bool first = true; here_ != end_ && *here_ != '\n'; ++here_) {
    if (first && is_blank(*here_)) continue;
    if (*here_ == '\\' && continues_line(here_)) {
      here_ = static_cast<const char*>(std::memchr(here_, '\n', static_cast<std::size_t>(end_ - here_)));
      text.push_back(' ');
      continue;
    }
    first = false;
    // A name with a carriage return inside could not be written again.
    text.push_back(*here_ == '\r' ? ' ' : *here_);
  }
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  return text;
}

bool Scanner::has_comment(const char* begin, const char* end) const {
  for (const char* at = begin; (at = std::find(at, end, '#')) != end; ++at) {
    if (at == begin || is_blank(at[-1])) return true;
  }
  return false;
}

void Scanner::skip_line() {
  const bool comment = here_ != end_ && *here_ == '#';
  while (here_ != end_) {
    const char* begin = here_;
    const void* found = std::memchr(here_, '\n', static_cast<std::size_t>(end_ - here_));
    if (found == nullptr) {
      here_ = end_;
      return;
    }
    here_ = static_cast<const char*>(found) + 1;
    const char* last = here_ - 1;
    if (last != begin && last[-1] == '\r') --last;
    if (comment || last == begin || last[-1] != '\\' || has_comment(begin, last)) return;
  }
}

void Scanner::fail_token(const char* wanted, const char* what) const {
  Scanner copy(*this);
  fail(ErrorCode::BadFile, in_quotes(copy.word()) + " is not " + wanted + " (" + what + "); correct this line");
}

void Scanner::fail_missing(const char* what) const {
  fail(ErrorCode::BadFile, std::string("missing ") + what + "; correct this line");
}

void Scanner::fail_not_finite(const char* token, const char* what) const {
  const std::string_view shown(token, static_cast<std::size_t>(here_ - token));
  throw Fault{token, ErrorCode::NotFinite,
              in_quotes(shown) + " is not a finite double (" + what + "); remove the vertex or give it a place"};
}

}  // namespace batten::io
