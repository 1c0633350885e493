/// \file Wanted normals by turning parts of the control mesh (Thall 2002, key Thall02, 2.5).
///
/// A vertex's limit position and normal depend on its one-ring alone. After two refinements the one-rings of the
/// vertices given have no vertex in common. So each may turn as a rigid body about its limit point: the point stays,
/// and the normal becomes the wanted one. The rotation is the smallest that does this; at a boundary it turns about the
/// curve where the wanted normal is perpendicular to it, and otherwise the curve's tangent turns too. Turning alone
/// leaves ripples. Relaxing softens them: the displacement changes to the one that bends least (thin-plate energy)
/// among those that leave the limit positions and tangents of the vertices given. Everything is local: where normals
/// are already right all around, no bit changes, and what is relaxed dies away within a few faces.
#pragma once
#include "batten/interpolate/interpolated_mesh.h"
#include "batten/interpolate/turn_report.h"

namespace batten {

/// How to turn.
struct TurnOptions {
  /// In radians, 0 to pi: normals within it stay, others turn until they are within it. Below 1e-13, where rounding
  /// decides, all stay.
  double tolerance = 0.0;
  bool relax = true;  ///< soften the ripples
};

/// An ordinary control mesh, refined twice.
struct TurnedSurface {
  Topology topology;
  Scheme scheme;   ///< without alpha
  Values control;  ///< row i belongs to vertex i of the topology given
  TurnReport report;
};

/// control: V-by-3. wanted: up to V rows of three columns, row i for vertex i, of any length, zero for none. Vertices
/// beyond its rows are no targets: they may move. Limit positions of the others stay to rounding, normals are reached
/// to rounding of their rings. O(H); turning takes some 40 ns of processor time for each vertex of the refined mesh,
/// relaxing some 5 microseconds and 1,700 bytes. Throws Error(BadArgument) for the Butterflies, whose limits depend on
/// two rings, and a tolerance out of range, Error(BadShape, NotFinite, Cancelled) and what Refinement and, relaxing,
/// SurfaceEnergy throw.
TurnedSurface turn_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                           ConstValuesRef wanted, const TurnOptions& options = {}, const Progress& progress = {});

/// The same for a mesh with all that hangs on it, which refine_mesh() carries. A mesh whose normals are all within the
/// tolerance is left as it is, unrefined. Returns what was achieved.
TurnReport turn_normals(InterpolatedMesh& surface, ConstValuesRef wanted, const TurnOptions& options = {},
                        const Progress& progress = {});

}  // namespace batten
