/// \file A caller of the library that runs oneTBB tasks of its own.
#pragma once
#include <functional>

namespace batten {

/// Runs work(i) for each i in [0, count), each in a task of the caller's; one after the other in a build without
/// oneTBB.
void run_in_tasks(int count, const std::function<void(int)>& work);

/// Runs work() in a task whose group is cancelled already.
void run_in_cancelled_task(const std::function<void()>& work);

}  // namespace batten
