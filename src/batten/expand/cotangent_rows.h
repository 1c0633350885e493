/// \file The cotangent matrix of a polygon mesh, scaled so that its series converges.
#pragma once
#include "batten/limit/limit_matrix.h"
#include "batten/solve/remainder_rows.h"

namespace batten {

/// E - A, and what makes A symmetric.
struct CotangentRows {
  RemainderRows remainder;  ///< rows of fixed and kept vertices have no weights but zeros
  Buffer<double> scales;    ///< V: scales_i A_ij is symmetric on the smooth rows
};

/// E - A = 8/9 D^-1 C on the smooth rows. C is the stiffness matrix of linear elements, with half of the cotangents'
/// sum for each edge (Pinkall and Polthier 1993, key PP93), on faces split as triangulate_face does. It is positive
/// semi-definite whatever the signs of its entries. D_i is the larger of two numbers: sum_j |C_ij|, and a third of the
/// area around vertex i times the median over the vertices of (sum_j |C_ij|) / area. Hence no eigenvalue of D^-1 C
/// exceeds 1 (Gershgorin), and the spectrum of A is in [1/9, 1], as on regular quads. Half of the vertices are weighted
/// by area alone; where triangles are small or thin, the weights stay below the bound. Rows of curves and fixed
/// vertices are those of the limit matrix. A triangle with an angle below half a degree has the weights of half a
/// degree; one without area has none, and a vertex with no other triangle is kept.
/// points: V-by-3, finite. kept: V, or empty. O(H); on quads 250 bytes for each vertex, of which 125 stay. Throws
/// Error: BadShape, NotFinite, Cancelled.
CotangentRows cotangent_rows(const LimitMatrix& matrix, ConstValuesRef points, const Buffer<std::uint8_t>& kept,
                             const Progress& progress = {});

}  // namespace batten
