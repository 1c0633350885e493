/// \file How many control meshes a fit has, each the refinement of the one before.
#pragma once
#include "batten/fit/fit_surface.h"

namespace batten {

/// The number of control points where nothing else is said.
inline constexpr Index kUsualFitVertices = 400;

/// The number that refinement may reach; 0 keeps the control mesh.
Index most_fit_vertices(const FitOptions& options);

/// How many control meshes there are from this one on, itself included, for the progress bar: exact but for the
/// last few control points.
int fit_level_count(const Topology& topology, SchemeKind kind, Index most);

}  // namespace batten
