/// \file Arrays and errors between C++ and JavaScript.
#pragma once
#include <emscripten/val.h>

#include <new>
#include <span>
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/types.h"

namespace batten::studio {

using emscripten::val;

/// A typed array of its own with these numbers: the engine's memory may move when it grows.
template <typename Number>
val typed_array(const Number* numbers, std::size_t count) {
  return val(emscripten::typed_memory_view(count, numbers)).template call<val>("slice");
}
template <typename Container>
val typed_array(const Container& numbers) {
  return typed_array(numbers.data(), static_cast<std::size_t>(numbers.size()));
}

/// The same in `room`, a typed array that the page has done with, where it has just as many numbers; otherwise, as
/// where it is null, in one of its own: fresh memory, which a browser clears before it is written.
template <typename Number>
val typed_array_in(const val& room, const Number* numbers, std::size_t count) {
  if (room.isNull() || room.isUndefined() || room["length"].as<std::size_t>() != count)
    return typed_array(numbers, count);
  room.call<void>("set", val(emscripten::typed_memory_view(count, numbers)));
  return room;
}
template <typename Container>
val typed_array_in(const val& room, const Container& numbers) {
  return typed_array_in(room, numbers.data(), static_cast<std::size_t>(numbers.size()));
}

/// An array of JavaScript with what `make` gives for each element.
template <typename Container, typename Make>
val list(const Container& elements, const Make& make) {
  val result = val::array();
  for (const auto& element : elements) result.call<void>("push", make(element));
  return result;
}

/// Rounded to float, row by row.
std::vector<float> to_floats(const Values& values);

/// N-by-3 from a typed array of 3 N numbers. Throws Error(BadShape).
Points to_points(const val& numbers);

/// What the page gets instead of a result: code and sentence. The page throws it as an exception of its own, since one
/// of C++ says nothing in JavaScript.
val failure(int code, const std::string& message);

/// Calls work() and returns its result, or the failure.
template <typename Work>
val guarded(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    return failure(static_cast<int>(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return failure(static_cast<int>(ErrorCode::TooLarge), "this does not fit the memory of the page");
  } catch (const std::exception& error) {
    return failure(-1, error.what());
  }
}

/// report: a function of JavaScript that takes the fraction done and returns false to stop, or null.
Progress progress_of(const val& report);

}  // namespace batten::studio
