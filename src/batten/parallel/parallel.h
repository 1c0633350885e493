/// \file Loops and reductions over index ranges whose results have the same bits for any number of threads.
///
/// Ranges are cut into blocks of a fixed size, never by the number of threads; a reduction combines the blocks' results
/// in a fixed tree. With oneTBB the blocks run on its threads, without it one after the other.
///
/// Every loop is isolated: a thread that waits for the end of a loop takes up blocks of that loop and of loops inside
/// it, and nothing else. So a loop may stand inside std::call_once or between uses of a thread_local object, also where
/// the caller is a oneTBB task itself. A loop is not cancelled together with the caller's task group either: it visits
/// every index or throws.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <vector>

#include "batten/parallel/threads.h"
#include "batten/progress.h"

namespace batten {

inline constexpr std::ptrdiff_t kDefaultBlock = 4096;

/// Calls body(block) for each block in [begin, end).
void parallel_blocks(std::ptrdiff_t begin, std::ptrdiff_t end, const std::function<void(std::ptrdiff_t)>& body);

/// Runs two pieces of work that do not depend on each other, the first one on the calling thread: it may report
/// progress. Throws what a piece throws, after both have ended.
void parallel_both(const std::function<void()>& first, const std::function<void()>& second);

/// Calls body(block) for each block in [0, count). With a progress callback some blocks a thread run between its calls:
/// a block should take a millisecond or less.
template <typename Body>
void parallel_for_each(std::ptrdiff_t count, const Body& body, const Progress& progress = {}) {
  constexpr std::ptrdiff_t kBlocksBetweenCalls = 64;
  const std::ptrdiff_t step = progress ? kBlocksBetweenCalls * thread_count() : count;
  for (std::ptrdiff_t begin = 0; begin < count; begin += step) {
    report_progress(progress, static_cast<double>(begin) / static_cast<double>(count));
    parallel_blocks(begin, std::min(begin + step, count), std::cref(body));
  }
}

/// Adds to a counter that several threads share and returns what it held before. Only for integers whose final value,
/// or an order that is sorted out afterwards, does not depend on who came first.
template <typename T>
T atomic_add(T& counter, T amount) {
  return __atomic_fetch_add(&counter, amount, __ATOMIC_RELAXED);
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
/// Memory: one T a block.
template <typename T, typename Map, typename Combine>
T parallel_reduce(std::ptrdiff_t count, T identity, const Map& map, const Combine& combine,
                  std::ptrdiff_t block = kDefaultBlock, const Progress& progress = {}) {
  static_assert(!std::is_same_v<T, bool>,
                "the bits of a std::vector<bool> share words that two threads would write at once: parallel_all_of");
  std::vector<T> parts(static_cast<std::size_t>(block_count(count, block)), identity);
  parallel_for(
      count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) { parts[begin / block] = map(begin, end); }, block,
      progress);
  for (std::size_t width = 1; width < parts.size(); width *= 2) {
    for (std::size_t i = 0; i + width < parts.size(); i += 2 * width) parts[i] = combine(parts[i], parts[i + width]);
  }
  return parts.empty() ? identity : parts[0];
}

/// True where test(begin, end) is true for every block of [0, count). All blocks are tested, also after one has failed.
template <typename Test>
bool parallel_all_of(std::ptrdiff_t count, const Test& test, std::ptrdiff_t block = kDefaultBlock,
                     const Progress& progress = {}) {
  const auto holds = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    return static_cast<std::uint8_t>(test(begin, end) ? 1 : 0);
  };
  const auto both = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a & b); };
  return parallel_reduce(count, std::uint8_t{1}, holds, both, block, progress) != 0;
}

}  // namespace batten
