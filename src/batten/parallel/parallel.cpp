#include "batten/parallel/parallel.h"

#include <memory>

#ifdef BATTEN_WITH_TBB
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
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

#else

struct ThreadLimit::Control {};

int thread_count() { return 1; }

ThreadLimit::ThreadLimit(int /*threads*/) {}

#endif

ThreadLimit::~ThreadLimit() = default;

}  // namespace batten
