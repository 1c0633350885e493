/// \file The integrand of a shape energy at one place, as squares of linear forms of the jet, for four faces at a time.
#pragma once
#include <array>
#include <span>

#include "batten/double4.h"
#include "batten/energy/shape_energy_kind.h"
#include "batten/surface/face_jets.h"

namespace batten {

inline constexpr int kMostShapeRows = 4;
inline constexpr int kMostShapeJetRows = 9;

/// The derivatives that an energy's integrand depends on.
std::span<const JetRow> shape_jet_rows(ShapeEnergyKind kind);

/// How many squares the integrand is the sum of.
constexpr int shape_row_count(ShapeEnergyKind kind) { return static_cast<int>(kind) + 2; }

/// x, y and z of a vector, each of four faces.
using FourVectors = std::array<Double4, 3>;

/// The references' derivatives in the order of shape_jet_rows(), and the forms likewise.
using ShapeJet = std::array<FourVectors, kMostShapeJetRows>;
using ShapeRows = std::array<std::array<Double4, kMostShapeJetRows>, kMostShapeRows>;

/// The integrand of X is the sum of the squares of rows * (X's derivatives). Returns |x_u cross x_v|, or 0 where the
/// reference has no tangent plane (its derivatives are nearly parallel); then rows are finite and mean nothing.
Double4 shape_rows(ShapeEnergyKind kind, const ShapeJet& reference, ShapeRows& rows);

}  // namespace batten
