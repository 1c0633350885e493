/// \file Energies of regular patches in closed form, and how they change with the size of a patch.
#pragma once
#include <Eigen/Core>

#include "batten/energy/energy_kind.h"

namespace batten {

/// The matrix of one patch, 16-by-16 in the order of RegularPatch or 12-by-12 in that of kTriangleLattice, with
/// coefficient 1. Not for Stiffness. Correctly rounded multiples of rational numbers: those of quads are Kronecker
/// products of the cubic B-spline's matrices (Qin, Mandal and Vemuri 1998, key QMV98), those of triangles integrals of
/// products of Loop's quartic box splines.
Eigen::MatrixXd regular_energy(bool quads, EnergyKind kind);

/// What one of the four children of a face has of the energy of its own unit face: the area falls by 4, and every
/// derivative grows by 2.
constexpr double child_scale(EnergyKind kind) {
  return kind == EnergyKind::Mass ? 0.25 : kind == EnergyKind::Membrane ? 1.0 : 4.0;
}

}  // namespace batten
