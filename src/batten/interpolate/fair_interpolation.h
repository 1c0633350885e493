/// \file The fairest surface through given targets.
///
/// Interpolator gives the one surface of the mesh's own connectivity that passes through the targets; nothing is left
/// to choose, and where targets are few or uneven it swings. On the mesh refined once there are four times as many
/// control points as targets: of all surfaces through the targets this is the one with the least energy (after
/// Halstead, Kass and DeRose 1993, key HKD93). The energy is that of the shape, by the lengths of a reference surface
/// (energy/shape_energy.h), and quadratic for it; the first reference has the targets for its control points, the next
/// is the first result (after Greiner 1994, key G94).
///
/// After a refinement the limit position of an original vertex depends on no other original vertex, so that the
/// targets' equations are solved for these exactly, and conjugate gradients find the others with an incomplete Cholesky
/// factor, or if need be a whole one (docs/decisions/011-fair-solver.md).
#pragma once
#include <optional>

#include "batten/energy/shape_energy_kind.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"
#include "batten/solve/solver.h"

namespace batten {

/// What the fairest surface is, and how it is found.
struct FairOptions {
  /// Refinements of the control mesh, 1 or 2. Empty: 1, or 2 where normals are wanted, which need 2.
  std::optional<int> levels = {};
  ShapeEnergyKind energy = ShapeEnergyKind::Variation;
  /// 0: the surface passes through the targets. Otherwise in their unit: it may leave them where that makes it fairer.
  /// A wave of this length comes out half as high, shorter ones vanish and longer ones stay. At most the diagonal of
  /// the targets' box.
  double smoothing = 0.0;
  /// Normals that the surface shall have at its vertices: V-by-3 of any length, rows of zeros where none is wanted.
  /// Empty: none. The surface's tangent plane becomes perpendicular to the normal. Vertices of creases and corners,
  /// which have several normals or none, are left out.
  Values normals = {};
  /// References one after the other, 1 to 20 at most: fewer where a reference's lengths suit the surface to 1 %.
  int rounds = 2;
  double tolerance = 1e-4;  ///< the energy is within its square, about, of the least, relative to the plain one's
  int max_iterations = 2000;
};

/// What was achieved. Energies are those of ShapeEnergy::energy() on the refined mesh, each surface in its own lengths.
struct FairReport {
  int levels = 1;             ///< refinements of the control mesh
  double plain_energy = 0.0;  ///< of the surface that Interpolator gives; NaN where it gives none
  double energy = 0.0;
  double diagonal = 0.0;   ///< of the targets' bounding box
  double max_error = 0.0;  ///< max_i |limit position of vertex i - target i|
  double rms_error = 0.0;
  Index worst_vertex = -1;  ///< where max_error is reached
  Index normal_count = 0;   ///< normals that were wanted, at vertices that have exactly one
  double max_angle = 0.0;   ///< the largest angle between a normal wanted and reached, in radians
  bool kept_plain = false;  ///< the plain surface, turned to wanted normals, is the best that was found
  SolveReport solve;        ///< of all rounds
};

/// The surface: control points, and the connectivity and scheme that make a surface of them.
struct FairInterpolant {
  Topology topology;  ///< that given, refined
  Scheme scheme;      ///< of the steps that follow
  Values control;     ///< a row a vertex of `topology`; row i < V belongs to target i
  FairReport report;
};

/// targets: V-by-3, row i for vertex i, finite. Catmull-Clark and Loop. Without smoothing and normals the energy is at
/// most that of the plain surface. Some 40 microseconds of processor time a vertex and round with one refinement, 200
/// with two; more where many vertices are irregular. Throws Error(BadArgument) for the Butterflies, BoundaryRule::None
/// and options out of range, Error(NotTriangles, BadShape, NotFinite, TooLarge, Cancelled).
FairInterpolant interpolate_fairly(const Topology& topology, const Scheme& scheme, ConstValuesRef targets,
                                   const FairOptions& options = {}, const Progress& progress = {});

}  // namespace batten
