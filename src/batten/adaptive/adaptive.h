/// \file The limit surface as few faces as a tolerance allows, without cracks or T-junctions.
///
/// Faces of the base are cut into quarters where a bound asks for it, neighbours at most one level apart
/// (adaptive/cell_forest.h), and what borders on finer neighbours is closed with triangles, or all with quads
/// (adaptive/cell_faces.h). Every vertex stands on the limit surface, exactly, those on boundaries and creases on their
/// curves, with the limit's normal.
#pragma once
#include <functional>
#include <span>

#include "batten/mesh/face_kind.h"
#include "batten/mesh/mesh.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// A face of an adaptive mesh, as AdaptiveOptions::cut sees it. A row of `points` and `normals` a corner.
struct AdaptiveFace {
  Index base_face;
  int level;  ///< how often its base face was cut to come to it
  Eigen::Ref<const Points> points;
  Eigen::Ref<const Points> normals;
};

/// 0: not asked for. Several bounds hold together; at least one is needed.
struct AdaptiveOptions {
  /// Largest distance between mesh and surface, in the points' unit. On regular quads this is certain, from bounds of
  /// the second derivatives (adaptive/chord_bound.h). So it is on regular triangles whose control points show that the
  /// patch does not fold over its plane; of others that is taken for granted. Around other vertices it rests on exact
  /// points three levels deeper and on the control points' hull from there.
  double chord = 0.0;
  /// No edge is longer.
  double edge_length = 0.0;
  /// No two of the limit normals at the corners and the middle of a face differ by more, in degrees: a bound of the
  /// curvature times the size of a face. Under the Butterflies at the corners only.
  double angle = 0.0;
  /// Your own bound: a face of which it says true is cut, as far as max_level. Called by one thread.
  std::function<bool(const AdaptiveFace&)> cut = {};
  FaceKind faces = FaceKind::Triangles;
  /// Cells of this level stay, whatever the bounds say: 0 to 16. Quads are once more halved.
  int max_level = 16;
  /// Error(TooLarge) beyond, and beyond 2^31 - 1 corners.
  Index max_faces = 20'000'000;
};

/// A mesh on the surface. Faces stand in an order that depends on the input alone, not grouped.
struct AdaptiveMesh {
  /// Points, faces, and "normal": a row a vertex; where the surface has creases also rows for the corners that differ.
  /// The base's vertices come first, in its order, without those that no face of the surface has.
  Mesh mesh;
  std::vector<SurfacePlace> places;                 ///< V, of LimitSurface(topology, scheme, control), or the mesh
  Buffer<Index> base_faces;                         ///< F
  Buffer<std::array<double, 2>> corner_parameters;  ///< (u, v) of each corner in its face's base face
  int deepest_level = 0;                            ///< of the cells
  Index unmet = 0;                                  ///< cells of max_level that a bound would have cut
  double longest_edge = 0.0;                        ///< of all edges, measured
  double widest_angle = 0.0;                        ///< as AdaptiveOptions::angle, measured where an angle is asked for
};

/// Under the Butterflies every vertex is one of those that uniform refinement makes; there is no chord tolerance, which
/// needs a closed form between vertices, and there are no quads.
/// control: V-by-3. Threaded, the same for any number of threads. O(result), some 100 bytes of memory a face beside it.
/// Throws Error(BadArgument) without a bound or for one that is negative or not finite, Error(TooLarge), and what
/// LimitSurface throws.
AdaptiveMesh tessellate_adaptively(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                                   const AdaptiveOptions& options, const Progress& progress = {});
/// The same where the surface's pieces are known.
AdaptiveMesh tessellate_adaptively(const SurfacePatches& patches, ConstValuesRef control,
                                   const AdaptiveOptions& options, const Progress& progress = {});

/// The greatest distance from the surface to the mesh, by samples: the surface at the middles of each face's edges and
/// at four places inside (a quad: of both its halves), against the face and those around. O(faces), threaded.
double measured_chord(const LimitSurface& surface, const AdaptiveMesh& mesh, const Progress& progress = {});

}  // namespace batten
