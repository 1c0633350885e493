/// \file Files that gzip has packed.
#pragma once
#include <string_view>

#include "batten/buffer.h"
#include "batten/io/source.h"

namespace batten::io {

bool is_gzip(std::string_view bytes);

/// The content of a gzip file, also of several in a row. Zeros at the end, as tapes have them, are ignored.
/// Throws Error(BadFile) for a file that is cut short or damaged or has no content, Error(Cancelled), and
/// Error(NotAvailable) in a build without zlib.
Buffer<char> unpack_gzip(const Source& source);

}  // namespace batten::io
