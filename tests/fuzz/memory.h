/// \file How much memory an input costs, for the fuzz targets.
#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace batten::fuzz {

/// The greatest number of bytes allocated at any time while `body` ran, beyond those allocated before. 0 in a build
/// without the address sanitizer, which counts them.
std::size_t peak_bytes(const std::function<void()>& body);

/// Prints what is wrong and aborts, which the fuzzer reports with the input.
[[noreturn]] void fail(const std::string& what);
inline void require(bool holds, const std::string& what) {
  if (!holds) fail(what);
}

}  // namespace batten::fuzz
