/// \file How many threads the library may use. It changes how long something takes, never a result.
#pragma once
#include <memory>

namespace batten {

/// Number of threads that the library may use now; 1 in a build without oneTBB.
int thread_count();

/// While it lives, the library uses at most `threads` threads in this process; fewer than 1 means no limit.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace batten
