/// \file The strength of smoothing as the greatest length of a bump that it removes.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// The factor of G = E - A on a wave along the edges of a regular mesh (quads for Catmull-Clark, triangles for Loop).
/// `edges` is the wavelength in edge lengths, 2 or more. In (0, 1).
double wave_remainder(SchemeKind kind, SeriesMatrix matrix, double edges);

/// The least number of passes of MeshSeries::smooth that at least halve every such wave up to the wavelength `edges`.
/// Throws Error(BadArgument) for a wavelength below 2, which is the shortest, for m below 0, and for more than a
/// million passes.
int passes_for(SchemeKind kind, SeriesMatrix matrix, int m, double edges);

/// The inverse: the longest wavelength, in edge lengths, that so many passes halve; 0 if none is halved.
double halved_wavelength(SchemeKind kind, SeriesMatrix matrix, int m, int passes);

}  // namespace batten
