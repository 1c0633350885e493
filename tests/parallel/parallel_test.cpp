#include "batten/parallel/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

}  // namespace
}  // namespace batten
