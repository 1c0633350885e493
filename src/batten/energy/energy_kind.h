/// \file The energies of a limit surface.
#pragma once

namespace batten {

/// Quadratic forms of the surface s(u, v), with coefficients that are constant on each face:
///
///     Mass         density  * integral of |s|^2
///     Membrane     tension  * integral of |s_u|^2 + |s_v|^2
///     ThinPlate    rigidity * integral of |s_uu|^2 + 2 |s_uv|^2 + |s_vv|^2
///     Stiffness    Membrane + ThinPlate
///
/// A quad is the unit square. A triangle is equilateral and of area 1/2, as its parameters' triangle is, so that no
/// corner is preferred; the derivatives are by arc length on it.
enum class EnergyKind { Mass, Membrane, ThinPlate, Stiffness };

}  // namespace batten
