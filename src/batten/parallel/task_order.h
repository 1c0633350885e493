/// \file The order between a loop's tasks and what stands around the loop, as the thread sanitizer must be told it.
#pragma once

#ifdef BATTEN_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace batten {

/// Every task begins after the loop began, and ends before the loop ends; tasks have no order among themselves. oneTBB
/// sees to that, but its library is not built with the thread sanitizer, which would take each task for a race with
/// its caller. So the sources that include oneTBB's headers are not built with it either, and tell it the order with
/// this class. Does nothing in other builds.
class TaskOrder {
 public:
  /// Lives while a task runs, also when it ends by an exception.
  class Task {
   public:
#ifdef BATTEN_THREAD_SANITIZER
    explicit Task(TaskOrder& order) : order_(order) { __tsan_acquire(&order_.begun_); }
    ~Task() { __tsan_release(&order_.ended_); }
#else
    explicit Task(TaskOrder& order) : order_(order) {}
    ~Task() = default;
#endif
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    [[maybe_unused]] TaskOrder& order_;
  };

#ifdef BATTEN_THREAD_SANITIZER
  TaskOrder() { __tsan_release(&begun_); }
  ~TaskOrder() { __tsan_acquire(&ended_); }
#else
  TaskOrder() = default;
  ~TaskOrder() = default;
#endif
  TaskOrder(const TaskOrder&) = delete;
  TaskOrder& operator=(const TaskOrder&) = delete;

 private:
  [[maybe_unused]] char begun_ = 0;
  [[maybe_unused]] char ended_ = 0;
};

}  // namespace batten
