#include "fuzz/memory.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

// The address sanitizer's interface; absent in other builds.
extern "C" {
int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, size_t), void (*)(const volatile void*))
    __attribute__((weak));
size_t __sanitizer_get_allocated_size(const volatile void*) __attribute__((weak));
}

namespace batten::fuzz {

namespace {

std::atomic<std::ptrdiff_t> live{0};
std::atomic<std::ptrdiff_t> peak{0};

void allocated(const volatile void* /*memory*/, std::size_t size) {
  const std::ptrdiff_t now = live += static_cast<std::ptrdiff_t>(size);
  std::ptrdiff_t most = peak;
  while (now > most && !peak.compare_exchange_weak(most, now)) {
  }
}

void freed(const volatile void* memory) {
  if (memory != nullptr) live -= static_cast<std::ptrdiff_t>(__sanitizer_get_allocated_size(memory));
}

}  // namespace

std::size_t peak_bytes(const std::function<void()>& body) {
  static const bool counted = __sanitizer_install_malloc_and_free_hooks != nullptr &&
                              __sanitizer_install_malloc_and_free_hooks(allocated, freed) > 0;
  const std::ptrdiff_t before = live;
  peak = before;
  body();
  return counted ? static_cast<std::size_t>(peak - before) : 0;
}

void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

}  // namespace batten::fuzz
