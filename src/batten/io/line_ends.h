/// \file Texts whose lines end in carriage returns alone, as some old programs write them.
#pragma once
#include <algorithm>
#include <string>

#include "batten/io/source.h"

namespace batten::io {

/// True if the text has carriage returns but no line feed.
inline bool has_only_carriage_returns(std::string_view text) {
  return text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos;
}

/// Calls read with the source. If its lines end in carriage returns alone, read gets a copy in which each of the first
/// `size` bytes that is one is a line feed. read must throw Errors and no Faults, since they point into the copy.
template <typename Read>
auto with_line_feeds(const Source& source, bool needed, const Read& read, std::size_t size = std::string::npos) {
  if (!needed) return read(source);
  std::string text(source.bytes);
  std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(size, text.size())), '\r', '\n');
  Source copy = source;
  copy.bytes = text;
  return read(copy);
}

}  // namespace batten::io
