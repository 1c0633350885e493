#include "batten/parallel/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "parallel/caller_tasks.h"

namespace batten {
namespace {

TEST(Parallel, TheLimitHoldsWhileItLives) {
  const int before = thread_count();
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(thread_count(), 1);
  }
  EXPECT_EQ(thread_count(), before);
  const ThreadLimit none(0);
  EXPECT_EQ(thread_count(), before);
}

TEST(Parallel, EveryIndexIsVisitedOnce) {
  std::vector<int> visits(100'001, 0);
  parallel_for(
      static_cast<std::ptrdiff_t>(visits.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) ++visits[i];
      },
      1000);
  for (const int count : visits) ASSERT_EQ(count, 1);
}

double harmonic_sum(int threads) {
  const ThreadLimit limit(threads);
  return parallel_reduce(
      1'000'000, 0.0,
      [](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double sum = 0.0;
        for (std::ptrdiff_t i = begin; i < end; ++i) sum += 1.0 / static_cast<double>(i + 1);
        return sum;
      },
      [](double a, double b) { return a + b; });
}

TEST(Parallel, SumsHaveTheSameBitsForAnyNumberOfThreads) {
  EXPECT_EQ(harmonic_sum(1), harmonic_sum(2));
  EXPECT_NEAR(harmonic_sum(1), std::log(1e6) + 0.57721566490153286 + 0.5e-6,
              1e-12);  // Euler's constant; the next term is 1e-13
}

TEST(Parallel, NothingIsTheIdentity) {
  EXPECT_EQ(parallel_reduce(
                0, 7, [](std::ptrdiff_t, std::ptrdiff_t) { return 1; }, [](int a, int b) { return a + b; }),
            7);
}

// Many small blocks: under the thread sanitizer, two threads writing bits of one word are seen here.
TEST(Parallel, AllHoldOnlyWhereEveryBlockHolds) {
  constexpr std::ptrdiff_t kCount = 10'000;
  EXPECT_TRUE(parallel_all_of(
      kCount, [](std::ptrdiff_t, std::ptrdiff_t) { return true; }, 1));
  EXPECT_TRUE(parallel_all_of(0, [](std::ptrdiff_t, std::ptrdiff_t) { return false; }));
  for (std::ptrdiff_t bad = 0; bad < kCount; bad += 97) {
    const auto good = [&](std::ptrdiff_t begin, std::ptrdiff_t end) { return bad < begin || bad >= end; };
    ASSERT_FALSE(parallel_all_of(kCount, good, 1)) << bad;
    ASSERT_FALSE(parallel_all_of(kCount, good, 64)) << bad;
  }
}

TEST(Parallel, EveryBlockIsTestedAlsoAfterOneFailed) {
  std::vector<int> visits(1000, 0);
  EXPECT_FALSE(parallel_all_of(
      1000,
      [&](std::ptrdiff_t begin, std::ptrdiff_t /*end*/) {
        ++visits[begin];
        return false;
      },
      1));
  for (const int count : visits) ASSERT_EQ(count, 1);
}

TEST(Parallel, OfTwoPiecesAtOnceTheFirstRunsOnTheCallersThread) {
  parallel_for_each(64, [](std::ptrdiff_t) {
    const std::thread::id caller = std::this_thread::get_id();
    std::thread::id first;
    bool second = false;
    parallel_both([&] { first = std::this_thread::get_id(); }, [&] { second = true; });
    EXPECT_EQ(first, caller);
    EXPECT_TRUE(second);
  });
}

TEST(Parallel, AnExceptionOfEitherPieceReachesTheCallerWhenNeitherRunsAnyMore) {
  for (const bool of_first : {true, false}) {
    for (int i = 0; i < 100; ++i) {
      std::atomic<int> running = 0;
      const auto piece = [&](bool fails) {
        ++running;
        int visited = 0;
        parallel_for_each(4, [&](std::ptrdiff_t) { atomic_add(visited, 1); });
        EXPECT_EQ(visited, 4);
        --running;
        if (fails) throw std::runtime_error("piece");
      };
      EXPECT_THROW(parallel_both([&] { piece(of_first); }, [&] { piece(!of_first); }), std::runtime_error);
      EXPECT_EQ(running, 0);
    }
  }
}

void wait_a_little() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

TEST(Parallel, AThreadThatWaitsForALoopTakesUpNothingElse) {
  std::atomic<int> entered_again = 0;
  run_in_tasks(64, [&](int) {
    thread_local int depth = 0;
    if (depth++ > 0) ++entered_again;
    parallel_for_each(8, [](std::ptrdiff_t) { wait_a_little(); });
    parallel_both(wait_a_little, [] {
      wait_a_little();
      wait_a_little();
    });
    --depth;
  });
  EXPECT_EQ(entered_again, 0);
}

TEST(Parallel, ALoopMayStandInsideCallOnce) {
  for (int i = 0; i < 5; ++i) {
    std::once_flag once;
    std::vector<int> made(64, 0);
    std::atomic<int> incomplete = 0;
    run_in_tasks(64, [&](int) {
      std::call_once(once, [&] {
        parallel_for_each(64, [&](std::ptrdiff_t k) {
          if (k % 8 == 0) wait_a_little();
          made[k] = 1;
        });
      });
      for (const int value : made) incomplete += value == 1 ? 0 : 1;
    });
    EXPECT_EQ(incomplete, 0);
  }
}

TEST(Parallel, ALoopInACancelledTaskStillVisitsEveryIndex) {
  std::vector<int> visits(1000, 0);
  int pieces = 0;
  run_in_cancelled_task([&] {
    parallel_for_each(1000, [&](std::ptrdiff_t i) { ++visits[i]; });
    parallel_both([&] { atomic_add(pieces, 1); }, [&] { atomic_add(pieces, 1); });
  });
  for (const int count : visits) ASSERT_EQ(count, 1);
  EXPECT_EQ(pieces, 2);
}

}  // namespace
}  // namespace batten
