/// \file The checks of values at the public edge.
#pragma once
#include "batten/types.h"

namespace batten {

/// Throws Error(NotFinite), naming the first row that holds NaN or an infinity; `what` names the values in the message,
/// such as "values". One parallel pass through memory.
void require_finite(ConstValuesRef values, const char* what);

/// Throws Error(BadShape) unless `result`, the caller's memory, has so many rows and columns.
void require_shape(const ValuesRef& result, std::ptrdiff_t rows, std::ptrdiff_t columns);

}  // namespace batten
