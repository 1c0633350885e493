/// \file Expectations about the Error that a call throws.
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>

#include "batten/error.h"

namespace batten::test {

/// The Error that `action` throws; a failed expectation and nothing where it throws none.
inline std::optional<Error> error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no Error was thrown";
  return std::nullopt;
}

/// Its code; a failed expectation and nothing where `action` throws none.
inline std::optional<ErrorCode> code_of(const std::function<void()>& action) {
  const std::optional<Error> error = error_of(action);
  return error ? std::optional(error->code()) : std::nullopt;
}

/// Expects an Error with this code whose message has this part.
inline void expect_error(const std::function<void()>& action, ErrorCode code, const std::string& part) {
  const std::optional<Error> error = error_of(action);
  if (!error) return;
  EXPECT_EQ(static_cast<int>(error->code()), static_cast<int>(code)) << error->what();
  EXPECT_NE(std::string(error->what()).find(part), std::string::npos) << error->what() << "\nlacks: " << part;
}

}  // namespace batten::test
