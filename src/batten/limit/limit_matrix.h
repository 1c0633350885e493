/// \file Where the control points' surface passes: limit positions and limit normals at the vertices.
///
/// The limit matrix A is V-by-V; row i takes control points P to the limit position of vertex i: A P. Rows by kind of
/// vertex (docs/mathematics.md, Limit positions): smooth [(n(n-1) + n alpha) v + (2 - alpha) sum e + 4 sum c]/(n(n+5))
/// on centroids c (Catmull-Clark) or (w v + sum e)/(w + n) (Loop); crease and boundary (a + 4 v + b)/6; corner and
/// isolated v; a dart's row is its ring's left eigenvector; where tags still fade, the row of the surface once they
/// have. Under the Butterflies A is the identity.
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/parallel/spare.h"
#include "batten/scheme/masks.h"
#include "batten/scheme/scheme.h"

namespace batten {

struct VertexRing;

/// What a row of the limit matrix consists of.
enum class LimitRow : std::uint8_t {
  Fixed,   ///< the vertex itself: corners, vertices without faces
  Curve,   ///< on a crease or boundary curve: itself and its two neighbours along it
  Smooth,  ///< the ring, with weights that are symmetric after scaling by n(n+5) or w + n
  Special  ///< stored weights: darts, semi-sharp surroundings, smooth triangles
};

/// With smooth vertices of valence 2 the limit matrix may have negative eigenvalues (docs/mathematics.md,
/// Interpolation); Lai's alpha = 1 on their components makes them positive.
inline constexpr double kValenceTwoAlpha = 1.0;

/// How the rows of a limit matrix are chosen.
struct LimitOptions {
  LimitMasks masks = LimitMasks::Exact;
  std::vector<double> vertex_alpha;  ///< empty, or Lai's alpha for each vertex instead of the scheme's
};

/// Build O(H); apply O(H k), matrix-free but for special rows. Safe to share.
class LimitMatrix {
 public:
  /// Throws Error(NotTriangles) for Loop on other faces, Error(Cancelled).
  LimitMatrix(const Topology& topology, const Scheme& scheme, LimitOptions options = {}, const Progress& progress = {});

  const Topology& topology() const { return topology_; }
  const Scheme& scheme() const { return scheme_; }
  LimitRow row_kind(Index vertex) const { return static_cast<LimitRow>(kinds_[vertex]); }
  double alpha(Index vertex) const {
    return options_.vertex_alpha.empty() ? scheme_.alpha : options_.vertex_alpha[vertex];
  }

  /// Number of faces at a vertex.
  int face_count(Index vertex) const {
    return face_counts_[vertex] < 255 ? face_counts_[vertex] : static_cast<int>(topology_.vertex_face_count(vertex));
  }

  /// A values: values is V-by-k. Throws Error(BadShape), Error(NotFinite) naming the row, Error(Cancelled).
  Values apply(ConstValuesRef values, const Progress& progress = {}) const;

  /// The same, written into `result`, which has the shape of `values` and stands apart from it in memory. A call keeps
  /// its working memory for the next, 8 k bytes a face, so that calls for a row of frames allocate nothing.
  void apply_into(ConstValuesRef values, ValuesRef result, const Progress& progress = {}) const;

  /// apply_into() without its checks, for solvers: what is not finite goes on to the rows that depend on it.
  void apply_unchecked(ConstValuesRef values, ValuesRef result, const Progress& progress = {}) const;

  /// Calls visit(column, weight) for the entries of a row; a column may come several times.
  template <typename Visit>
  void visit_row(Index vertex, const Visit& visit) const;

  /// The factor that makes the smooth rows symmetric among themselves: n(n+5), or w + n for Loop; 1 for other rows.
  double row_scale(Index vertex) const;

  /// The two neighbours along the curve of a Curve row.
  std::pair<Index, Index> curve_neighbours(Index vertex) const;

  Index special_count() const { return static_cast<Index>(special_vertices_.size()); }

  /// About how many entries visit_row meets in all rows: a face of d corners has d (d - 2) of them.
  double entry_count() const;

  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix() const;

 private:
  struct Weights {
    double vertex;
    double edge;
    double face;
  };
  void classify(Index vertex, VertexRing& ring);
  void add_special_row(Index vertex, VertexRing& ring);
  Weights compute_weights(int valence, double alpha) const;
  Weights smooth_weights(Index vertex, int valence) const {
    if (valence < static_cast<int>(usual_weights_.size()) && alpha(vertex) == scheme_.alpha)
      return usual_weights_[valence];
    return compute_weights(valence, alpha(vertex));
  }
  template <typename Visit>
  void visit_quad_row(Index vertex, const Visit& visit) const;
  template <int K>
  void apply_columns(ConstValuesRef values, ValuesRef result, Buffer<double>& face_means,
                     const Progress& progress) const;
  Index special_place(Index vertex) const;

  Topology topology_;
  Scheme scheme_;
  LimitOptions options_;
  Buffer<std::uint8_t> kinds_;
  Buffer<std::uint8_t> face_counts_;  ///< 255 stands for 255 or more
  Buffer<Index> special_vertices_;    ///< ascending
  Buffer<std::size_t> special_offsets_;
  Buffer<Index> special_columns_;
  Buffer<double> special_weights_;
  std::vector<Weights> usual_weights_;  ///< of smooth rows by valence, with the scheme's alpha
  std::shared_ptr<Spare<Buffer<double>>> face_means_ = std::make_shared<Spare<Buffer<double>>>();
};

/// Unit normals of the limit surface, outward for counter-clockwise faces.
struct LimitNormals {
  Values vertices;  ///< V-by-3: at a crease or corner the normal of the first sector; zero where there is none
  Values corners;   ///< H-by-3: per half-edge, the normal of its own side at its origin
};
/// control: V-by-3. O(H). Throws Error(BadShape), Error(Cancelled).
LimitNormals limit_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                           LimitMasks masks = LimitMasks::Exact, const Progress& progress = {});

template <typename Visit>
void LimitMatrix::visit_row(Index vertex, const Visit& visit) const {
  switch (row_kind(vertex)) {
    case LimitRow::Fixed:
      visit(vertex, 1.0);
      return;
    case LimitRow::Curve: {
      const std::pair<Index, Index> ends = curve_neighbours(vertex);
      visit(vertex, kCreaseLimitVertex);
      visit(ends.first, kCreaseLimitNeighbour);
      visit(ends.second, kCreaseLimitNeighbour);
      return;
    }
    case LimitRow::Special: {
      const Index place = special_place(vertex);
      for (std::size_t i = special_offsets_[place]; i < special_offsets_[place + 1]; ++i) {
        visit(special_columns_[i], special_weights_[i]);
      }
      return;
    }
    case LimitRow::Smooth:
      break;
  }
  if (topology_.uniform_face_size() == 4 && scheme_.kind == SchemeKind::CatmullClark)
    return visit_quad_row(vertex, visit);
  const Weights weights = smooth_weights(vertex, face_count(vertex));
  double centre = weights.vertex;
  const auto share_of = [&](Index h) { return weights.face / topology_.face_size(topology_.face(h)); };
  topology_.for_each_outgoing(vertex, [&](Index h) {
    if (scheme_.kind == SchemeKind::Loop) return visit(topology_.destination(h), weights.edge);
    // The face left of h, and the one right of it, each give every corner an equal share of the centroid's weight.
    const double share = share_of(h);
    centre += share;
    visit(topology_.destination(h), weights.edge + share + share_of(topology_.twin(h)));
    const Index last = topology_.previous(h);
    for (Index i = topology_.next(topology_.next(h)); i != last; i = topology_.next(i)) {
      visit(topology_.origin(i), share);
    }
  });
  visit(vertex, centre);
}

/// A smooth row among quads: the half-edges of face f are 4 f .. 4 f + 3, which saves most of the look-ups.
template <typename Visit>
void LimitMatrix::visit_quad_row(Index vertex, const Visit& visit) const {
  const Weights weights = smooth_weights(vertex, face_count(vertex));
  const double share = weights.face / 4;
  const double edge = weights.edge + share + share;
  double centre = weights.vertex;
  const Index start = topology_.vertex_half_edge(vertex);
  for (Index h = start; h >= 0;) {
    const Index first = h & ~3;
    centre += share;
    visit(topology_.origin(first | ((h + 1) & 3)), edge);
    visit(topology_.origin(first | ((h + 2) & 3)), share);
    h = topology_.twin(first | ((h + 3) & 3));
    if (h == start) break;
  }
  visit(vertex, centre);
}

}  // namespace batten
