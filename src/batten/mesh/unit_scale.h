/// \file A scale for coordinates whose squares doubles cannot hold.
#pragma once
#include "batten/types.h"

namespace batten {

/// 1 for ordinary values. Where the largest is beyond 2^200 or all are below 2^-200, the power of two that brings the
/// largest near 1: multiplying by it is exact, and so is going back. 1 for values that are all 0 or not all finite.
/// O(size).
double unit_scale(ConstValuesRef values);

}  // namespace batten
