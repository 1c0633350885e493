/// \file The error of a wrong command line.
#pragma once
#include <stdexcept>

namespace batten::cli {

/// A command line that makes no sense; the tool says why and ends with exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace batten::cli
