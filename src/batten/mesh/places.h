/// \file Points with equal or nearly equal positions.
#pragma once
#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// A number for each of the rows (indices into points, which must be finite there); rows at the same place have the
/// same number. Tolerance 0 means equal coordinates, in O(n log n). Otherwise a row takes the place of the first row
/// that lies within the tolerance in each coordinate and has a place of its own, in O(n) expected.
Buffer<Index> place_numbers(const Points& points, const Buffer<Index>& rows, double tolerance);

/// For each of the rows (indices into points) the place in `rows` of the first one with equal coordinates: i for row i
/// itself where no earlier one lies there. NaN equals nothing. O(n) expected.
Buffer<Index> first_equal(const Points& points, const Buffer<Index>& rows);

/// The number of vertices whose coordinates equal those of an earlier vertex. Points that are not finite do not count.
Index coincident_count(const Points& points);

}  // namespace batten
