/// \file Winding numbers on a grid, exact where the surface may be.
#pragma once
#include "batten/fit/value_grid.h"
#include "batten/fit/winding_field.h"

namespace batten {

/// Sets the numbers of a grid to those of the field less `level`. Cubes of four by four by four cells without points in
/// or near them, at whose corners the field is on one side and far from the level, take linear values in between.
void fill_from_field(ValueGrid& grid, const WindingField& field, double level, const Points& points,
                     const Progress& progress = {});

}  // namespace batten
