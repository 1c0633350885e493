/// \file The mesh series: values at the vertices of a mesh as a sum of terms, from the overall shape to the finest
/// detail, without eigenvectors (Lai and Cheng 2006, key LC06).
///
/// A takes values at the vertices to smoother ones; its eigenvalues a are in (0, 1], those of smooth shapes near 1.
/// With G = E - A any values M are the sum of the terms G^i A M, i = 0, 1, 2, ..; the first n + 1 of them are
/// M - G^(n+1) M, and G^(n+1) M is what is left. Smoothing, sharpening, bands and morphs are polynomials in G. Powers
/// of matrices are never formed: everything runs A over the values again and again.
#pragma once
#include <memory>
#include <vector>

#include "batten/limit/limit_matrix.h"

namespace batten {

/// What A is.
enum class SeriesMatrix {
  Limit,     ///< the limit matrix of the scheme: vertices weighted by their valence, whatever the shape; the faster
  Cotangent  ///< cotangent weights of a shape, see expand/cotangent_rows.h: the same detail however finely it is meshed
};

/// How a series treats the mesh.
struct SeriesOptions {
  SeriesMatrix matrix = SeriesMatrix::Limit;
  Points shape = Points(0, 3);  ///< V-by-3, for the cotangents only
  Buffer<std::uint8_t> kept;    ///< V, or empty: vertices with a 1 keep their values, and are what the others see
};

/// Built once for a connectivity, applied to any values, N-by-k. Crease and boundary curves are smoothed along
/// themselves only; corners and vertices without a face keep their values. Safe to share
/// between threads; the result does not depend on their number.
/// Build: O(H). Memory: on quads 79 bytes a vertex while it is built, of which 33 stay (Limit: those of TiledPolynomial
/// and two of the limit matrix); 300, of which 140 stay (Cotangent). One application of A: O(H).
class MeshSeries {
 public:
  /// Where a mesh has smooth vertices of valence 2, the limit matrix would have negative eigenvalues; their components
  /// are taken with Lai's alpha = 1, which makes them positive.
  /// Throws Error: NotTriangles (Loop on other faces), BadShape (kept, shape), NotFinite (shape), BadArgument (a
  /// Butterfly scheme, which smooths nothing), Cancelled.
  MeshSeries(const Topology& topology, const Scheme& scheme, const SeriesOptions& options = {},
             const Progress& progress = {});
  ~MeshSeries();
  MeshSeries(MeshSeries&&) noexcept;

  const Topology& topology() const;
  /// The limit matrix that says which vertices are smooth, on a curve, or fixed.
  const LimitMatrix& limit_matrix() const;
  bool is_kept(Index vertex) const;

  /// (c_0 E + c_1 G + .. + c_d G^d)^passes values. All of the below are such polynomials.
  /// Memory: 64 bytes a vertex beside the result, twice that for d above 7; with the limit matrix it is kept for the
  /// next call.
  /// Throws Error: BadShape, BadArgument (no coefficient, or passes below 0), NotFinite (naming the row), Cancelled.
  Values polynomial(ConstValuesRef values, const std::vector<double>& coefficients, int passes = 1,
                    const Progress& progress = {}) const;

  /// A values.
  Values apply(ConstValuesRef values, const Progress& progress = {}) const;
  /// G^power values: what the first `power` terms leave.
  Values remainder(ConstValuesRef values, int power, const Progress& progress = {}) const;
  /// G^index A values.
  Values term(ConstValuesRef values, int index, const Progress& progress = {}) const;
  /// The sum of the terms 0 .. last.
  Values partial_sum(ConstValuesRef values, int last, const Progress& progress = {}) const;
  /// Lai and Cheng's (8): the partial sum of the terms 0 .. m taken `passes` times. A mode with the eigenvalue a comes
  /// out (1 - (1 - a)^(m+1))^passes times as large.
  Values smooth(ConstValuesRef values, int m, int passes, const Progress& progress = {}) const;

  /// The same, written into `result`, which has the shape of `values` and stands apart from it in memory. Throws
  /// Error(BadShape) where the shapes differ.
  void polynomial_into(ConstValuesRef values, ValuesRef result, const std::vector<double>& coefficients, int passes = 1,
                       const Progress& progress = {}) const;
  void apply_into(ConstValuesRef values, ValuesRef result, const Progress& progress = {}) const;
  void remainder_into(ConstValuesRef values, ValuesRef result, int power, const Progress& progress = {}) const;
  void term_into(ConstValuesRef values, ValuesRef result, int index, const Progress& progress = {}) const;
  void partial_sum_into(ConstValuesRef values, ValuesRef result, int last, const Progress& progress = {}) const;
  void smooth_into(ConstValuesRef values, ValuesRef result, int m, int passes, const Progress& progress = {}) const;

  /// Of each of the terms 0 .. count - 1 the mean over the vertices of its rows' squared lengths.
  std::vector<double> energies(ConstValuesRef values, int count, const Progress& progress = {}) const;

  /// The factor that makes the smooth rows of A symmetric among themselves.
  double weight(Index vertex) const;
  /// sum w_i values_i / sum w_i: on a closed mesh without creases, corners and kept vertices no smoothing moves it.
  ValueRow weighted_centroid(ConstValuesRef values) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
