/// \file The matrix of a shape energy on one face, and how it is added to the whole.
#pragma once
#include <Eigen/SparseCore>
#include <span>

#include "batten/energy/jet_tables.h"
#include "batten/energy/shape_rows.h"
#include "batten/types.h"

namespace batten {

/// What an element needs room for; one for each thread.
struct ShapeScratch {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> forms;
  ShapeJet jet;
  ShapeRows rows;
};

/// matrix: n^2 numbers for n vertices, row by row; symmetric to the last bit.
void shape_matrix(ShapeEnergyKind kind, const JetTable& table, std::span<const Index> vertices,
                  ConstValuesRef reference, ShapeScratch& scratch, double* matrix);

/// The energy of the element's surface in its own lengths.
double shape_energy_of(ShapeEnergyKind kind, const JetTable& table, std::span<const Index> vertices,
                       ConstValuesRef control, ShapeScratch& scratch);

/// Adds the matrix times the reference itself to `gradient`, three numbers a vertex, without the matrix.
void shape_gradient(ShapeEnergyKind kind, const JetTable& table, std::span<const Index> vertices,
                    ConstValuesRef reference, ShapeScratch& scratch, double* gradient);

}  // namespace batten
