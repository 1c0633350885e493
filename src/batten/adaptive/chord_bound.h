/// \file A bound for the distance between a regular patch and flat faces between points of it.
#pragma once

namespace batten {

/// The sides of a cell that lie on a boundary or a crease: bit s for side s. Bit s + 4 marks sides where the surface
/// ends or folds although its rules continue, beside holes and at vertices of two faces; there all second derivatives
/// count fully.
using CurveSides = unsigned;
inline constexpr unsigned kEndSides = 0xF0U;

/// An upper bound for the distance between a patch and any triangles or quads that cover it with their corners on it at
/// their own parameters. It follows from the second differences of the control points, of which the second derivatives
/// are averages (after Filip, Magedson and Markot 1986, key FMM86). points: 16 (12) rows of three, in the order of
/// patch/spline_jet.h.
///
/// Second derivatives along the patch's mean plane count only by how much they change the surface's height over the
/// plane, so that flat patches have the bound 0 however unevenly they are spaced. This requires a patch that does not
/// fold over its plane. If the control points of a quad do not prove this, its second derivatives count fully; for
/// triangles, whose lattices prove too little, it is assumed. Sides on curves count fully, except for movement along
/// the curve.
double quad_chord_bound(const double* points, CurveSides curves);
double triangle_chord_bound(const double* points, CurveSides curves);

}  // namespace batten
