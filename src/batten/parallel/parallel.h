/// \file Loops and reductions over index ranges whose results have the same bits for any number of threads.
///
/// Ranges are cut into blocks of a fixed size, never by the number of threads; a reduction combines the blocks' results
/// in a fixed tree. With oneTBB the blocks run on its threads, without it one after the other.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "batten/parallel/threads.h"
#include "batten/progress.h"

#ifdef BATTEN_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#endif

namespace batten {

inline constexpr std::ptrdiff_t kDefaultBlock = 4096;

/// Calls body(block) for each block in [begin, end).
template <typename Body>
void parallel_blocks(std::ptrdiff_t begin, std::ptrdiff_t end, const Body& body) {
#ifdef BATTEN_WITH_TBB
  if (end - begin > 1) {
    tbb::parallel_for(tbb::blocked_range<std::ptrdiff_t>(begin, end, 1), [&](const auto& range) {
      for (std::ptrdiff_t i = range.begin(); i != range.end(); ++i) body(i);
    });
    return;
  }
#endif
  for (std::ptrdiff_t i = begin; i < end; ++i) body(i);
}

/// Calls body(block) for each block in [0, count). With a progress callback some blocks a thread run between its calls:
/// a block should take a millisecond or less.
template <typename Body>
void parallel_for_each(std::ptrdiff_t count, const Body& body, const Progress& progress = {}) {
  constexpr std::ptrdiff_t kBlocksBetweenCalls = 64;
  const std::ptrdiff_t step = progress ? kBlocksBetweenCalls * thread_count() : count;
  for (std::ptrdiff_t begin = 0; begin < count; begin += step) {
    report_progress(progress, static_cast<double>(begin) / static_cast<double>(count));
    parallel_blocks(begin, std::min(begin + step, count), body);
  }
}

/// Adds to a counter that several threads share and returns what it held before. Only for integers whose final value,
/// or an order that is sorted out afterwards, does not depend on who came first.
template <typename T>
T atomic_add(T& counter, T amount) {
  return __atomic_fetch_add(&counter, amount, __ATOMIC_RELAXED);
}

/// Runs two pieces of work that do not depend on each other, the first one on the calling thread.
template <typename First, typename Second>
void parallel_both(const First& first, const Second& second) {
  parallel_for_each(2, [&](std::ptrdiff_t i) {
    if (i == 0) {
      first();
    } else {
      second();
    }
  });
}

inline std::ptrdiff_t block_count(std::ptrdiff_t count, std::ptrdiff_t block = kDefaultBlock) {
  return (count + block - 1) / block;
}

/// Calls body(begin, end) for consecutive blocks that cover [0, count).
template <typename Body>
void parallel_for(std::ptrdiff_t count, const Body& body, std::ptrdiff_t block = kDefaultBlock,
                  const Progress& progress = {}) {
  parallel_for_each(
      block_count(count, block),
      [&](std::ptrdiff_t i) {
        const std::ptrdiff_t begin = i * block;
        body(begin, begin + block < count ? begin + block : count);
      },
      progress);
}

/// Combines map(begin, end) over the blocks of [0, count) pairwise, in a tree that depends on count and block only.
template <typename T, typename Map, typename Combine>
T parallel_reduce(std::ptrdiff_t count, T identity, const Map& map, const Combine& combine,
                  std::ptrdiff_t block = kDefaultBlock, const Progress& progress = {}) {
  std::vector<T> parts(static_cast<std::size_t>(block_count(count, block)), identity);
  parallel_for(
      count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) { parts[begin / block] = map(begin, end); }, block,
      progress);
  for (std::size_t width = 1; width < parts.size(); width *= 2) {
    for (std::size_t i = 0; i + width < parts.size(); i += 2 * width) parts[i] = combine(parts[i], parts[i + width]);
  }
  return parts.empty() ? identity : parts[0];
}

}  // namespace batten
