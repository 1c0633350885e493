/// \file The integrand of a shape energy at one place, as squares of linear forms of the jet.
#pragma once
#include <Eigen/Core>
#include <span>

#include "batten/energy/shape_energy_kind.h"
#include "batten/surface/face_jets.h"

namespace batten {

inline constexpr int kMostShapeRows = 4;
inline constexpr int kMostShapeJetRows = 9;

/// The derivatives that an energy's integrand depends on.
std::span<const JetRow> shape_jet_rows(ShapeEnergyKind kind);

/// How many squares the integrand is the sum of.
constexpr int shape_row_count(ShapeEnergyKind kind) { return static_cast<int>(kind) + 2; }

/// The reference's derivatives in the order of shape_jet_rows(), and the forms likewise.
using ShapeJet = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMostShapeJetRows, 3>;
using ShapeRows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMostShapeRows, kMostShapeJetRows>;

/// The integrand of X is the sum of the squares of rows * (X's derivatives). Returns |x_u cross x_v|, or 0 where the
/// reference has no tangent plane (its derivatives are nearly parallel); then rows are not set.
double shape_rows(ShapeEnergyKind kind, const ShapeJet& reference, ShapeRows& rows);

}  // namespace batten
