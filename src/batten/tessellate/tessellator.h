/// \file The surface as a fine uniform mesh, at the speed of memory.
///
/// The same points as Refinement's after `levels` steps, to rounding, in another order: each face of the base is a grid
/// of 2^steps steps a side, filled at once from the control points that its spline needs (patch/pieces.h), or, under
/// the Butterflies, level by level (tessellate/butterfly_grids.h). The base is the control mesh itself, or, for
/// Catmull-Clark with faces that are no quads or with alpha, its first refinement; then steps is levels - 1.
///
/// Vertex order: the base's vertices (so vertex i of the control mesh is vertex i), then the points inside each edge,
/// from the origin of its lower half-edge on, then those inside each face, row by row of v, u along its first
/// half-edge. Faces: base face by base face, row by row; of a triangle's row upright and turned ones in turn. Faces of
/// holes are left out.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/patch/surface_patches.h"

namespace batten {

/// Built once for a connectivity, evaluated again when control values move. Build O(H), at the first evaluation;
/// evaluate O(output), threaded, the same bits for any number of threads. Memory: 120 bytes a base face, and about as
/// much a piece next to irregular ones; for one level of refined points none.
class Tessellator {
 public:
  /// levels: 1 or more. Throws Error(NotTriangles, BadArgument, TooLarge).
  Tessellator(const Topology& topology, const Scheme& scheme, int levels);
  Tessellator(const SurfacePatches& patches, int levels);
  ~Tessellator();
  Tessellator(Tessellator&&) noexcept;

  Index vertex_count() const;
  Index face_count() const;
  Index face_size() const;  ///< 4 or 3

  /// out: vertex_count() rows of control.cols() numbers. Scalar is float or double.
  /// Throws Error(BadShape) where a size is wrong, Error(Cancelled).
  template <typename Scalar>
  void refined(ConstValuesRef control, std::span<Scalar> out, const Progress& progress = {}) const;

  /// Limit positions, and where `normals` is not empty the unit normals of the limit surface (control: V-by-3); at a
  /// crease the normal of the side that the vertex or edge belongs to, zero where there is none.
  template <typename Scalar>
  void limit(ConstValuesRef control, std::span<Scalar> out, std::span<Scalar> normals = {},
             const Progress& progress = {}) const;

  /// After some control vertices moved: `out` and `normals` hold limit() of the control points before, and hold it of
  /// those now afterwards, the same bits. Only the faces that these vertices reach are evaluated (under the Butterflies
  /// all), so that one vertex of 98,306 takes 0.9 ms and not 83 in
  /// WebAssembly; what is refined beside irregular vertices, and the first
  /// step where there is one, is still worked out for the whole mesh. Returns the vertices that were written, each
  /// once. Throws as limit(), and Error(IndexOutOfRange).
  template <typename Scalar>
  std::vector<Index> limit_around(std::span<const Index> moved, ConstValuesRef control, std::span<Scalar> out,
                                  std::span<Scalar> normals = {}) const;

  /// out: face_count() * face_size() vertices, counter-clockwise.
  void faces(std::span<Index> out) const;

  /// An attribute at the corners of the control mesh, texture coordinates above all, at the corners of faces(): the
  /// same values as refine_at_corners() gives level by level. Throws Error(BadShape, TooLarge).
  Attribute at_corners(const Attribute& attribute) const;

  /// Values at the control vertices under CarryRule::Midpoint, V-by-k: a row a vertex. Throws Error(BadShape,
  /// Cancelled).
  Values midpoints(ConstValuesRef control, const Progress& progress = {}) const;

  /// The grid of a base face, for those who attach things to it: base() has its faces, steps() its side, vertex() its
  /// points, 0 <= i, j <= steps().
  const Topology& base() const;
  Index steps() const;
  Index vertex(Index base_face, Index i, Index j) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A tessellation in fresh memory.
template <typename Scalar>
struct Tessellation {
  Index face_size = 0;
  Buffer<Scalar> points;   ///< three numbers a vertex
  Buffer<Scalar> normals;  ///< three a vertex, or empty
  Buffer<Index> faces;     ///< face_size vertices a face
};

/// What tessellate() computes.
struct TessellateOptions {
  bool limit = false;    ///< limit positions instead of refined control points
  bool normals = false;  ///< of the limit surface
};

/// Tessellates once. control: V-by-3. Throws what Tessellator throws.
template <typename Scalar = float>
Tessellation<Scalar> tessellate(const Topology& topology, const Scheme& scheme, ConstValuesRef control, int levels,
                                const TessellateOptions& options = {}, const Progress& progress = {});

}  // namespace batten
