/// \file The cotangent matrix of a polygon mesh, scaled so that its series converges.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// The rows of E - A, entry by entry. Fixed and kept rows are empty.
struct RemainderRows {
  Buffer<std::size_t> offsets;  ///< V+1
  Buffer<Index> columns;
  Buffer<double> weights;
  Buffer<double> scales;  ///< V: scales_i A_ij is symmetric among the smooth rows

  /// out = (E - A) x, both V-by-k. Throws Error(Cancelled).
  void apply(const Values& x, Values& out, const Progress& progress = {}) const;
};

/// E - A = 8/9 D^-1 C on the smooth rows. C is the stiffness matrix of linear elements, cotangents over two for each
/// edge (Pinkall and Polthier 1993, key PP93), on faces split as triangulate_face does; it is positive semi-definite
/// whatever the signs of its entries. D_i is the larger of the third of the areas around vertex i, times the median
/// over the vertices of (sum_j |C_ij|) / area, and of sum_j |C_ij|: then no eigenvalue of D^-1 C exceeds 1
/// (Gershgorin), and the spectrum of A is in [1/9, 1], as regular quads have it. Half of the vertices are weighted by
/// area alone; where triangles are small or thin, weights stay below what the bound allows. Curve and fixed rows are
/// the limit matrix's. A triangle with an angle below half a degree counts with the weights that it has there, and one
/// without an area counts for nothing; a vertex with nothing else around it is kept. points: V-by-3, finite. kept: V,
/// or empty. O(H), 90 bytes a vertex. Throws Error: BadShape, NotFinite, Cancelled.
RemainderRows cotangent_rows(const LimitMatrix& matrix, ConstValuesRef points, const Buffer<std::uint8_t>& kept,
                             const Progress& progress = {});

}  // namespace batten
