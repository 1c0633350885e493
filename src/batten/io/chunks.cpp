#include "batten/io/chunks.h"

#include <algorithm>

namespace batten::io {

namespace {

/// The first position after `from` that certainly starts a line.
const char* next_line(const char* from, const char* begin, const char* end) {
  while (from < end) {
    const void* found = std::memchr(from, '\n', static_cast<std::size_t>(end - from));
    if (found == nullptr) return end;
    const char* newline = static_cast<const char*>(found);
    const char* last = newline;
    if (last != begin && last[-1] == '\r') --last;
    if (last == begin || last[-1] != '\\') return newline + 1;
    from = newline + 1;
  }
  return end;
}

}  // namespace

std::vector<std::string_view> cut_lines(std::string_view text, std::size_t chunk_bytes) {
  std::vector<std::string_view> pieces;
  const char* begin = text.data();
  const char* end = begin + text.size();
  while (begin != end) {
    const std::size_t wanted = std::max<std::size_t>(chunk_bytes, 1);
    const auto left = static_cast<std::size_t>(end - begin);
    const char* stop = left <= wanted ? end : next_line(begin + wanted - 1, begin, end);
    pieces.emplace_back(begin, static_cast<std::size_t>(stop - begin));
    begin = stop;
  }
  return pieces;
}

Rows find_rows(const Source& source, std::string_view text, char separator) {
  const std::vector<std::string_view> pieces = cut_lines(text, source.chunk_bytes);
  std::vector<std::ptrdiff_t> counts(pieces.size(), 0);
  const auto count = [&](std::size_t i) {
    Scanner scanner(pieces[i], separator);
    while (!scanner.at_end()) {
      counts[i] += scanner.next_token() ? 1 : 0;
      scanner.skip_line();
    }
  };
  for_each_chunk(pieces.size(), count, progress_within(source.progress, 0.0, 0.33));
  Rows rows;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    rows.chunks.push_back({pieces[i], rows.count});
    rows.count += counts[i];
  }
  return rows;
}

}  // namespace batten::io
