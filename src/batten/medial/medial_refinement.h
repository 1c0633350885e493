/// \file The sheets of a medial model with more atoms, which interpolate those given.
#pragma once
#include "batten/medial/medial_model.h"

namespace batten {

/// The model with finer sheets. Positions, spokes and crest spokes are those of the Catmull-Clark surface (and, at the
/// edge, of the curves) that passes through the atoms' own. Atoms given keep their values, bit for bit, and are the
/// first ones. levels: 0 or more.
///
/// Each level makes four faces of a quad. On an elliptical grid it doubles the lines and the steps, so that the result
/// is an elliptical grid again; each level then interpolates the atoms of the one before. Coordinates are interpolated
/// as the atoms are; on an elliptical grid they count the new atoms. Hinges are left out, since they name old atoms and
/// faces.
/// Throws what require_medial and Interpolator::solve throw, Error(BadArgument) for negative levels, Error(TooLarge).
/// O(atoms of the result).
MedialModel refine_medial(const MedialModel& model, int levels, const Progress& progress = {});

/// All sheets as one open mesh with a vertex an atom, figure by figure. Attributes: "up" and "down" (k = 3, the
/// spokes), "radius" (k = 1, the mean length of the two) and, where every figure has coordinates, "uv" (k = 2). A group
/// `o` for each of several figures that has a name. Throws what require_medial throws. O(atoms).
Mesh sheet_mesh(const MedialModel& model);

}  // namespace batten
