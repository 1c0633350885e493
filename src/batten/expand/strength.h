/// \file How strong smoothing is, in words that a person understands: how long a bump may be and still vanish.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// What one application of G = E - A leaves of a wave of the wavelength `edges`, in edge lengths (2 or more), along the
/// edges of a regular mesh: quads for Catmull-Clark, triangles for Loop. In (0, 1).
double wave_remainder(SchemeKind kind, SeriesMatrix matrix, double edges);

/// The least number of passes of MeshSeries::smooth that halve, or more, every such wave up to the wavelength `edges`.
/// Throws Error(BadArgument): a wavelength below 2, the shortest there is; m below 0; more than a million passes.
int passes_for(SchemeKind kind, SeriesMatrix matrix, int m, double edges);

/// The other way round: the longest wavelength that so many passes halve, in edge lengths; 0 where none is halved.
double halved_wavelength(SchemeKind kind, SeriesMatrix matrix, int m, int passes);

}  // namespace batten
