/// \file Faces around which the rules are those of a spline: sixteen control points of a uniform bicubic B-spline
/// (Catmull-Clark) or twelve of Loop's quartic box spline.
///
/// At a boundary or an infinitely sharp crease the points beyond it are missing; they follow by reflection, 2 a - b
/// (quads) or a + b - c (triangles), which makes the spline's own rules give the curve (a + 6 v + b)/8 there.
#pragma once
#include <array>

#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// Rows of the control points in the frame of one half-edge of the face: u along it, v to its left.
///
/// Quads: row 4 j + i stands at (i - 1, j - 1), the face's corners at (0, 0), (1, 0), (1, 1), (0, 1).
/// Triangles: row i stands at kTriangleLattice[i], the face's corners at (0, 0), (1, 0), (0, 1).
struct RegularPatch {
  static constexpr Index kMissing = -1;
  std::array<Index, 16> rows;
};

inline constexpr int kQuadPatchSize = 16;
inline constexpr int kTrianglePatchSize = 12;
constexpr int patch_size(bool quads) { return quads ? kQuadPatchSize : kTrianglePatchSize; }
inline constexpr std::array<std::array<int, 2>, kTrianglePatchSize> kTriangleLattice{
    {{0, 0}, {1, 0}, {0, 1}, {0, -1}, {1, -1}, {2, -1}, {-1, 0}, {2, 0}, {-1, 1}, {1, 1}, {-1, 2}, {0, 2}}};

/// Which vertices are regular, and the patches of the faces between them.
class PatchFinder {
 public:
  /// Catmull-Clark: faces are quads. O(H).
  PatchFinder(const Topology& topology, const Scheme& scheme);

  /// The patch of the half-edge's face; false where there is none: next to an extraordinary vertex, a dart, a crease
  /// that meets others or fades, a boundary with another number of faces.
  bool find(Index half_edge, RegularPatch& patch) const;

 private:
  enum class Kind : std::uint8_t { Irregular, Smooth, Curve, Corner };
  Kind classify(Index vertex) const;
  /// Within a face of four (three) half-edges.
  Index next(Index half_edge) const {
    return quads_ ? (half_edge & ~3) | ((half_edge + 1) & 3) : topology_.next(half_edge);
  }
  Index previous(Index half_edge) const {
    return quads_ ? (half_edge & ~3) | ((half_edge + 3) & 3) : topology_.previous(half_edge);
  }
  bool has_regular_fan(Index vertex) const;  ///< at a vertex that is not on the boundary
  bool is_sharp_edge(Index half_edge) const;
  void find_quad(Index half_edge, RegularPatch& patch) const;
  void find_triangle(Index half_edge, RegularPatch& patch) const;
  bool sector_is_regular(Index half_edge) const;

  Topology topology_;
  Scheme scheme_;
  bool quads_;
  Buffer<Kind> kinds_;
};

/// Fills in the missing points. rows: a patch's; points: 16 (12) rows of `columns` numbers; those of missing rows are
/// overwritten.
template <typename Scalar>
void complete_patch(bool quads, const Index* rows, Scalar* points, int columns);

}  // namespace batten
