/// \file A std::vector that leaves new numbers uninitialised and asks the system for huge pages when it is large.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace batten {

/// The first touch of fresh memory costs ten times as much as writing it when pages are small. Allocations of 4 MiB and
/// more are therefore aligned to 2 MiB, and the system is advised to use huge pages. Shorter ones start at a cache
/// line, except below 1 KiB, where malloc is several times faster. Elements are default-initialised: resize() leaves
/// numbers undefined.
template <typename T>
struct BufferAllocator {
  using value_type = T;
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;
  static constexpr std::size_t kShort = 1024;

  BufferAllocator() = default;
  template <typename U>
  BufferAllocator(const BufferAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) {
    if (count > (static_cast<std::size_t>(PTRDIFF_MAX) - kHugePage) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    const bool huge = bytes >= 2 * kHugePage;
    const std::size_t alignment = huge ? kHugePage : 64;
    const bool plain = bytes < kShort && alignof(T) <= alignof(std::max_align_t);
    void* memory = plain ? std::malloc(std::max<std::size_t>(bytes, 1))
                         : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    if (huge) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t /*count*/) { std::free(memory); }

  template <typename U, typename... Args>
  void construct(U* place, Args&&... args) {
    if constexpr (sizeof...(Args) == 0) {
      ::new (static_cast<void*>(place)) U;
    } else {
      ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
    }
  }
  template <typename U>
  bool operator==(const BufferAllocator<U>& /*other*/) const {
    return true;
  }
};

/// A std::vector of numbers that uses this allocator.
template <typename T>
using Buffer = std::vector<T, BufferAllocator<T>>;

}  // namespace batten
