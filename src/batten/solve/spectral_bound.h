/// \file Where the spectrum of a system in tiles ends.
#pragma once
#include "batten/solve/tiles.h"

namespace batten {

/// An upper bound of the spectral radius of D^-1 A, D the diagonal of A: max_i (|D^-1 A| u)_i / u_i, which holds for
/// any positive u (Collatz 1942, Wielandt 1950; key C42); power iteration on u brings it down to the radius of |D^-1
/// A|. O(nonzeros), one pass through memory.
double spectral_bound(const Tiling& tiling);

}  // namespace batten
