/// \file Text in pieces of whole lines, parsed in parallel with the same results and errors as a single piece.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "batten/io/scanner.h"
#include "batten/parallel/parallel.h"

namespace batten::io {

/// Cuts the text into pieces of about chunk_bytes, at line ends without a backslash.
std::vector<std::string_view> cut_lines(std::string_view text, std::size_t chunk_bytes);

/// Calls body(i) for i in [0, count) in parallel. Throws the Fault of the lowest i that has one.
template <typename Body>
void for_each_chunk(std::size_t count, const Body& body, const Progress& progress) {
  std::vector<std::optional<Fault>> faults(count);
  const auto guarded = [&](std::ptrdiff_t i) {
    try {
      body(static_cast<std::size_t>(i));
    } catch (Fault& fault) {
      faults[i] = std::move(fault);
    }
  };
  parallel_for_each(static_cast<std::ptrdiff_t>(count), guarded, progress);
  for (const std::optional<Fault>& fault : faults) {
    if (fault) throw Fault(*fault);
  }
}

/// Lines with content other than comments, numbered across the pieces.
struct Rows {
  struct Chunk {
    std::string_view text;
    std::ptrdiff_t first_row;
  };
  std::vector<Chunk> chunks;
  std::ptrdiff_t count = 0;
};

/// Cuts the source, or the given part of it, and counts its rows. This is the first third of the source's progress.
Rows find_rows(const Source& source, std::string_view text, char separator = ' ');

/// Calls body(scanner, row, chunk) at the start of each row. The body must read every token of the line. This is the
/// rest of the source's progress.
template <typename Body>
void for_each_row(const Source& source, const Rows& rows, const Body& body, char separator = ' ') {
  const auto read = [&](std::size_t chunk) {
    Scanner scanner(rows.chunks[chunk].text, separator);
    std::ptrdiff_t row = rows.chunks[chunk].first_row;
    while (!scanner.at_end()) {
      if (scanner.next_token()) body(scanner, row++, chunk);
      scanner.finish_line();
    }
  };
  for_each_chunk(rows.chunks.size(), read, progress_within(source.progress, 0.33, 1.0));
}

}  // namespace batten::io
