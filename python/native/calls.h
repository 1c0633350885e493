/// \file Long calls: without Python's lock, with progress, and stopped by Ctrl-C or by what a progress callable raises.
#pragma once
#include <pybind11/pybind11.h>

#include <chrono>
#include <optional>
#include <utility>

#include "batten/error.h"
#include "batten/types.h"

namespace batten::python {

namespace py = pybind11;

/// Asks Python now and then whether to go on. Used by one call.
class Watch {
 public:
  /// progress: None, or a callable that gets the share done; it stops the call by raising, or by returning False.
  explicit Watch(py::object progress) : progress_(std::move(progress)) {}

  bool go_on(double done) {
    const auto now = std::chrono::steady_clock::now();
    constexpr auto kBetween = std::chrono::milliseconds(20);
    if (done < 1.0 && now - asked_ < kBetween) return true;
    asked_ = now;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) {
      raised_.emplace();
      return false;
    }
    if (progress_.is_none()) return true;
    told_ = done;
    try {
      const py::object answer = progress_(done);
      return answer.ptr() != Py_False;
    } catch (py::error_already_set& error) {
      raised_.emplace(std::move(error));
      return false;
    }
  }
  /// The last word is always 1.
  void finish() {
    if (!progress_.is_none() && told_ < 1.0) progress_(1.0);
  }
  /// Raises what stopped the call, if Python raised something.
  void rethrow() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }

 private:
  py::object progress_;
  double told_ = 0.0;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  std::optional<py::error_already_set> raised_;
};

/// body(progress), without Python's lock.
template <typename Body>
auto run(const py::object& progress, const Body& body) {
  Watch watch(progress);
  const Progress report = [&watch](double done) { return watch.go_on(done); };
  try {
    auto result = [&] {
      const py::gil_scoped_release unlocked;
      return body(report);
    }();
    watch.finish();
    return result;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) watch.rethrow();
    throw;
  }
}

}  // namespace batten::python
