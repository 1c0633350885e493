/// \file How much memory an input costs, for the fuzz targets.
#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace batten::fuzz {

/// The most bytes that were allocated at a time while `body` ran, beyond what was before. 0 in a build without the
/// address sanitizer, which is what counts them.
std::size_t peak_bytes(const std::function<void()>& body);

/// Prints what is wrong and aborts, which the fuzzer reports with the input.
[[noreturn]] void fail(const std::string& what);
inline void require(bool holds, const std::string& what) {
  if (!holds) fail(what);
}

}  // namespace batten::fuzz
