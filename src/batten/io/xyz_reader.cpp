#include "batten/io/chunks.h"
#include "batten/io/formats.h"
#include "batten/io/line_ends.h"

namespace batten::io {

namespace {

constexpr char kSeparator = ',';

std::ptrdiff_t count_tokens(Scanner& scanner) {
  std::ptrdiff_t count = 0;
  while (!scanner.word().empty()) ++count;
  return count;
}

/// The first row determines the number of columns.
std::ptrdiff_t count_columns(std::string_view text) {
  Scanner scanner(text, kSeparator);
  while (!scanner.next_token()) scanner.skip_line();
  return count_tokens(scanner);
}

/// Finds the line to report after a row turned out to be shorter than the first.
[[noreturn]] void fail_ragged(const Source& source, const Rows& rows, std::ptrdiff_t columns) {
  const auto check = [&](Scanner& scanner, std::ptrdiff_t /*row*/, std::size_t /*chunk*/) {
    const Scanner line = scanner;
    if (count_tokens(scanner) == columns) return;
    line.fail(ErrorCode::BadFile, "the first line has " + std::to_string(columns) + " numbers, this one has not");
  };
  for_each_row(source, rows, check, kSeparator);
  throw Error(ErrorCode::BadFile, "the rows do not have the same number of columns");
}

Mesh read_rows(const Source& source) {
  const Rows rows = find_rows(source, source.bytes, kSeparator);
  if (rows.count == 0)
    throw Error(ErrorCode::BadFile, source.name + ": no points (`x y z`) in it; is this an XYZ file?");
  require_index_count(source.name, static_cast<std::size_t>(rows.count), "points");
  const std::ptrdiff_t columns = count_columns(source.bytes);
  // Each number takes at least a digit and a blank. Counts that the text cannot hold are refused before memory is
  // allocated.
  if (columns > static_cast<std::ptrdiff_t>(source.bytes.size() + 1) / 2 / rows.count)
    fail_ragged(source, rows, columns);
  Mesh mesh;
  mesh.points.resize(rows.count, 3);
  Values extra(rows.count, std::max<std::ptrdiff_t>(columns - 3, 0));
  const auto read = [&](Scanner& scanner, std::ptrdiff_t row, std::size_t /*chunk*/) {
    const char* const names[] = {"x coordinate", "y coordinate", "z coordinate"};
    for (int k = 0; k < 3; ++k) mesh.points(row, k) = scanner.coordinate(names[k]);
    for (double& value : extra.row(row)) value = scanner.number("value of a point, as the first line has it");
  };
  for_each_row(source, rows, read, kSeparator);
  if (columns > 3) mesh.attributes.push_back({columns == 6 ? "normal" : "extra", std::move(extra), {}});
  return mesh;
}

}  // namespace

Mesh read_xyz(const Source& source) {
  return with_line_feeds(source, has_only_carriage_returns(source.bytes), [](const Source& lines) {
    try {
      return read_rows(lines);
    } catch (const Fault& fault) {
      throw_at_line(lines, fault);
    }
  });
}

}  // namespace batten::io
