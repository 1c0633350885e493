/// \file Memory that a call leaves for the next one.
#pragma once
#include <mutex>
#include <utility>

namespace batten {

/// Keeps the working memory of one call, so that an operator that is applied again and again does not pay for fresh
/// memory each time. Calls that run at the same time get memory of their own, of which one is kept. T() is empty.
template <typename T>
class Spare {
 public:
  /// What an earlier call gave back, or T().
  T take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(spare_, T());
  }
  void give_back(T memory) {
    const std::lock_guard<std::mutex> lock(mutex_);
    spare_ = std::move(memory);
  }

 private:
  std::mutex mutex_;
  T spare_;
};

}  // namespace batten
