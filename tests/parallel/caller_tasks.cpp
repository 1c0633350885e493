#include "parallel/caller_tasks.h"

#ifdef BATTEN_WITH_TBB
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "batten/parallel/task_order.h"
#include "batten/parallel/threads.h"
#endif

namespace batten {

#ifdef BATTEN_WITH_TBB

void run_in_tasks(int count, const std::function<void(int)>& work) {
  // More threads than a small machine has cores: while one waits for its loop, others work on it and tasks are left.
  constexpr int kThreads = 4;
  const ThreadLimit limit(kThreads);
  tbb::task_arena arena(kThreads);
  TaskOrder order;
  arena.execute([&] {
    tbb::task_group group;
    for (int i = 0; i < count; ++i) {
      group.run([&, i] {
        const TaskOrder::Task task(order);
        work(i);
      });
    }
    group.wait();
  });
}

void run_in_cancelled_task(const std::function<void()>& work) {
  TaskOrder order;
  tbb::task_group group;
  group.run_and_wait([&] {
    const TaskOrder::Task task(order);
    group.cancel();
    work();
  });
}

#else

void run_in_tasks(int count, const std::function<void(int)>& work) {
  for (int i = 0; i < count; ++i) work(i);
}

void run_in_cancelled_task(const std::function<void()>& work) { work(); }

#endif

}  // namespace batten
