#include "batten/parallel/parallel.h"

#include <memory>

#ifdef BATTEN_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "batten/parallel/task_order.h"
#endif

namespace batten {

#ifdef BATTEN_WITH_TBB

struct ThreadLimit::Control {
  explicit Control(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};

int thread_count() {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const int arena = tbb::this_task_arena::max_concurrency();
  return arena < static_cast<int>(allowed) ? arena : static_cast<int>(allowed);
}

ThreadLimit::ThreadLimit(int threads) {
  if (threads < 1) return;
  control_ = std::make_unique<Control>(static_cast<std::size_t>(threads));
}

void parallel_blocks(std::ptrdiff_t begin, std::ptrdiff_t end, const std::function<void(std::ptrdiff_t)>& body) {
  if (end - begin <= 1) {
    if (begin < end) body(begin);
    return;
  }
  TaskOrder order;
  const auto run = [&](const tbb::blocked_range<std::ptrdiff_t>& range) {
    const TaskOrder::Task task(order);
    for (std::ptrdiff_t i = range.begin(); i != range.end(); ++i) body(i);
  };
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context uncancelled(tbb::task_group_context::isolated);
    tbb::parallel_for(tbb::blocked_range<std::ptrdiff_t>(begin, end, 1), run, uncancelled);
  });
}

void parallel_both(const std::function<void()>& first, const std::function<void()>& second) {
  TaskOrder order;
  const auto run_second = [&] {
    const TaskOrder::Task task(order);
    second();
  };
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context uncancelled(tbb::task_group_context::isolated);
    tbb::task_group group(uncancelled);
    group.run(run_second);
    first();  // its exception leaves through the group, which drops the second piece or waits for it
    group.wait();
  });
}

#else

struct ThreadLimit::Control {};

int thread_count() { return 1; }

ThreadLimit::ThreadLimit(int /*threads*/) {}

void parallel_blocks(std::ptrdiff_t begin, std::ptrdiff_t end, const std::function<void(std::ptrdiff_t)>& body) {
  for (std::ptrdiff_t i = begin; i < end; ++i) body(i);
}

void parallel_both(const std::function<void()>& first, const std::function<void()>& second) {
  first();
  second();
}

#endif

ThreadLimit::~ThreadLimit() = default;

}  // namespace batten
