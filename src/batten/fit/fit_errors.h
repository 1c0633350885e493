/// \file How far the points are from a surface on the way to it.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Shares of the diameter; outliers are left out.
struct FitErrors {
  double rms = 0.0;
  double max = 0.0;
  double bulk = 0.0;  ///< RMS of the nearest 95 %
};

/// outliers: one flag a point. All zero where all points are outliers.
FitErrors fit_errors(const Scalars& distances, const Buffer<std::uint8_t>& outliers, double diameter);

}  // namespace batten
