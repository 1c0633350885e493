/// \file Memory that has been freed, back to the system.
#pragma once
#include <cstddef>
#include <cstdlib>  // which says whether the C library is that of GNU
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace batten {

/// The C library keeps freed memory for later: after large temporary objects of several threads more than what is in
/// use. To be called between the stages of long work: it takes some milliseconds, and where what is worked on has less
/// than 16 MB it does nothing, as with other C libraries. bytes: of that.
inline void release_freed_memory([[maybe_unused]] std::size_t bytes) {
#if defined(__GLIBC__)
  constexpr std::size_t kWorthIt = 16'000'000;
  if (bytes >= kWorthIt) malloc_trim(0);
#endif
}

}  // namespace batten
