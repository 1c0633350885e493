/// \file Changed targets met by the control points of a few rings alone.
#pragma once
#include "batten/interpolate/local_rows.h"

namespace batten {

/// What is to be added to the control points of some vertices.
struct LocalFit {
  std::vector<Index> places;    ///< of LocalRows
  std::vector<Index> affected;  ///< places of all rows that they are part of
  Values change;                ///< a row for each of `places`
};

/// The places of the vertices within `rings` rings of faces of the changed ones, those first and in their order.
std::vector<Index> places_within(LocalRows& rows, std::span<const Index> changed, int rings);

/// The change of the control points at `places` that meets the first `exact` of these rows and, of all that do, leaves
/// the least sum of squared residuals on the rows that they are part of. rows: as places_within() left it.
/// Throws Error: SingularSystem, Cancelled.
LocalFit fit_locally(LocalRows& rows, std::vector<Index> places, std::size_t exact, ConstValuesRef targets,
                     ConstValuesRef control, const Progress& progress);

}  // namespace batten
