/// \file How far a regular patch strays from flat faces between points of it.
#pragma once

namespace batten {

/// Which sides of a cell lie on a boundary or a crease: bit s for side s. Bit s + 4: where the surface ends or folds
/// though its rules go on, beside holes and at vertices of two faces; there all second derivatives count in full.
using CurveSides = unsigned;
inline constexpr unsigned kEndSides = 0xF0U;

/// An upper bound for the distance between a patch and any triangles or quads that cover it with their corners on it,
/// at their own parameters: from the second differences of its control points, which the second derivatives are means
/// of (after Filip, Magedson and Markot 1986, key FMM86). points: 16 (12) rows of three, as patch/spline_jet.h.
///
/// Second derivatives along the patch's middle plane count only as they displace the surface, by what that changes its
/// height over the plane: flat patches have bound 0 however unevenly they are spaced. That needs a patch that does not
/// fold over its plane. Where the control points do not show it, second derivatives of quads count in full; of
/// triangles, whose lattices show too little, it is taken for granted. Sides on curves count in full, but for what runs
/// along them.
double quad_chord_bound(const double* points, CurveSides curves);
double triangle_chord_bound(const double* points, CurveSides curves);

}  // namespace batten
