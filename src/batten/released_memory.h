/// \file Memory that has been freed, back to the system.
#pragma once
#include <cstdlib>  // which says whether the C library is that of GNU
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace batten {

/// The C library keeps freed memory for later: after large temporary objects of several threads more than what is in
/// use. To be called between the stages of long work; some milliseconds. Does nothing with other C libraries.
inline void release_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace batten
