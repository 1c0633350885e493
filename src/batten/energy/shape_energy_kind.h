/// \file What a fair surface has little of.
#pragma once

namespace batten {

/// Integrals over the area of a reference surface, in its lengths, of a surface X over it:
///
///     Stretch      |grad X|^2        X as the reference: twice its area
///     Bending      |Hess X|^2        X as the reference: the sum of its principal curvatures' squares, k1^2 + k2^2
///     Variation    |D^3 X|^2         X as the reference: the square of how its curvature changes along the surface,
///                                    |grad II|^2; spheres and cylinders have none
///
/// The derivatives at a place of the reference are by Cartesian coordinates of its tangent plane there: X is seen as
/// over the plane, by projection. Of the second order they are those that follow the surface (covariant ones), D^3 X is
/// grad Hess X + II . S . grad X, with the reference's second fundamental form II and shape operator S, without which
/// the projection onto the tangent plane itself would have an energy.
enum class ShapeEnergyKind { Stretch, Bending, Variation };

}  // namespace batten
