/// \file One pass over a text, token by token. All rules about blanks, comments, continued lines and numbers are here.
#pragma once
#include <fast_float/fast_float.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "batten/io/source.h"

namespace batten::io {

/// A token as a message can show it: short, in quotes, and without control characters.
std::string in_quotes(std::string_view token);

/// Tokens are separated by blanks (space, tab, CR, form feed) and, if requested, by one more character. A line ends at
/// LF; a backslash before LF continues it. A token that starts with '#' begins a comment, which a backslash never
/// continues, since a comment may end in a Windows path. Every failure throws Fault at the token.
class Scanner {
 public:
  explicit Scanner(std::string_view text, char separator = ' ')
      : here_(text.data()), end_(text.data() + text.size()), separator_(separator) {}

  const char* position() const { return here_; }
  bool at_end() const { return here_ == end_; }

  /// Moves to the next token of this line. Returns false if the line ends first.
  bool next_token() {
    for (; here_ != end_; ++here_) {
      if (is_blank(*here_)) continue;
      if (*here_ == '\\' && continues_line(here_)) {
        here_ = static_cast<const char*>(std::memchr(here_, '\n', static_cast<std::size_t>(end_ - here_)));
        continue;
      }
      return *here_ != '\n' && *here_ != '#';
    }
    return false;
  }

  /// The current token, empty at the end of the line.
  std::string_view word() {
    const bool stands = next_token();
    const char* begin = here_;
    while (stands && !ends_token(here_)) ++here_;
    return {begin, static_cast<std::size_t>(here_ - begin)};
  }

  /// Reads a double, exactly rounded (fast_float). A leading '+', "nan" and "inf" are accepted.
  double number(const char* what) {
    require_token(what);
    const char* begin = here_;
    if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;
    double value = 0.0;
    const fast_float::from_chars_result result = fast_float::from_chars(begin, end_, value);
    if (result.ec == std::errc::invalid_argument || !ends_token(result.ptr)) fail_token("a number", what);
    here_ = result.ptr;
    return value;
  }

  /// Reads a double that is neither NaN nor infinite.
  double coordinate(const char* what) {
    if (!next_token()) fail_missing(what);
    const char* token = here_;
    const double value = number(what);
    if (!std::isfinite(value)) fail_not_finite(token, what);
    return value;
  }

  /// Reads decimal digits with an optional sign. Besides the end of the token, `stop` ends them.
  std::int64_t integer(const char* what, char stop = '\n') {
    require_token(what);
    const char* at = here_;
    const bool negative = *at == '-';
    if (negative || *at == '+') ++at;
    const char* digits = at;
    std::int64_t value = 0;
    for (; at != end_ && static_cast<unsigned char>(*at - '0') < 10 && at - digits < 18; ++at) {
      value = 10 * value + (*at - '0');
    }
    if (at == digits || !(ends_token(at) || *at == stop)) fail_token("an integer", what);
    here_ = at;
    return negative ? -value : value;
  }

  /// Moves past `expected` if it is the next character.
  bool skip(char expected) {
    if (here_ == end_ || *here_ != expected) return false;
    ++here_;
    return true;
  }

  /// True if the next character is a blank or `separator`.
  bool at_field_end(char separator) const { return ends_token(here_) || *here_ == separator; }

  /// The rest of the line without surrounding blanks, continued lines joined.
  std::string rest_of_line();

  /// Moves to the end of the line as a comment does: a backslash continues nothing.
  void skip_comment() {
    while (here_ != end_ && *here_ != '\n') ++here_;
  }

  /// Moves to the next line and skips the rest of this one.
  void skip_line();

  /// Moves to the end of the line and skips its tokens.
  void skip_tokens() {
    while (!word().empty()) {
    }
  }

  /// Moves to the next line. Throws if a token is left.
  void finish_line() {
    if (next_token()) fail_token("the end of the line", "after the last value");
    skip_line();
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& message) const { throw Fault{here_, code, message}; }
  [[noreturn]] void fail_token(const char* wanted, const char* what) const;
  [[noreturn]] void fail_missing(const char* what) const;

 private:
  bool is_blank(char c) const {
    return c == ' ' || c == '\t' || c == '\r' || c == separator_ || c == '\f' || c == '\v';
  }
  bool ends_token(const char* at) const {
    return at == end_ || is_blank(*at) || *at == '\n' || (*at == '\\' && continues_line(at));
  }
  /// True if a token of [begin, end), which begins a token or a line, starts with '#'.
  bool has_comment(const char* begin, const char* end) const;
  bool continues_line(const char* backslash) const {
    const char* next = backslash + 1;
    if (next != end_ && *next == '\r') ++next;
    return next != end_ && *next == '\n';
  }
  void require_token(const char* what) {
    if (!next_token()) fail_missing(what);
  }
  [[noreturn]] void fail_not_finite(const char* token, const char* what) const;

  const char* here_;
  const char* end_;
  char separator_;
};

}  // namespace batten::io
