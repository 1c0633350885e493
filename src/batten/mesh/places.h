/// \file Points that lie at the same place.
#pragma once
#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// A number for each of the rows (indices into points, which must be finite there), equal for those at the same place.
/// Tolerance 0: equal coordinates, O(n log n). Otherwise a row takes the place of the first one that lies within the
/// tolerance in each coordinate and has a place of its own: O(n), expected.
Buffer<Index> place_numbers(const Points& points, const Buffer<Index>& rows, double tolerance);

/// How many vertices lie where an earlier one lies, bit for bit; points that are not finite do not count.
Index coincident_count(const Points& points);

}  // namespace batten
