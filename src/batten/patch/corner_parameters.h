/// \file Where the corners of a face lie in its parameters.
#pragma once
#include <array>

#include "batten/types.h"

namespace batten {

/// The parameters (u, v) of corner `corner` of a face with 3 or 4 corners (patch/surface_place.h); each is 0 or 1.
constexpr std::array<double, 2> corner_parameters(Index corner_count, Index corner) {
  const bool ends_u = corner == 1 || (corner == 2 && corner_count == 4);
  return {ends_u ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0};
}

}  // namespace batten
