/// \file A subdivision surface as an elastic body: its mass, its damping, and the energy of its deformation.
///
/// With the control points P (V-by-3), mass matrix M, damping matrix D and stiffness matrix K, all V-by-V and symmetric
/// (after Qin, Mandal and Vemuri 1998, key QMV98; docs/mathematics.md):
///
///     M P'' + D P' = F_elastic(P) + other forces,     F_elastic = -gradient of E
///     E = 1/2 * sum over the columns of (P - R)^T K (P - R)
///
/// where R is nothing, the rest shape, or the rest shape turned face by face, as RestModel says.
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <optional>

#include "batten/dynamics/elastic_material.h"
#include "batten/patch/surface_patches.h"
#include "batten/progress.h"
#include "batten/types.h"

namespace batten {

/// What the energy is measured from.
enum class RestModel {
  /// From the rest shape, each face of which may turn freely: what one expects of an elastic body. The energy of a face
  /// is the least over all rotations of its rest shape (after Bouaziz and others 2014, key BMLKP14). Moving and turning
  /// the whole body costs nothing.
  Rotating,
  /// From the rest shape as it stands: linear in P, for small deformations. Turning the body costs energy.
  Linear,
  /// From a point: the paper's energy of the shape itself. A free surface shrinks.
  Point
};

/// How lengths along the surface are measured.
enum class ElasticMeasure {
  Lengths,    ///< along the rest shape, in its unit (energy/shape_energy.h)
  Parameters  ///< by the faces' parameters, as in the paper: each quad is a unit square (energy/surface_energy.h)
};

/// What a body is made of, and what its elastic energy is measured by.
struct ElasticOptions {
  ElasticMaterial material = {};
  RestModel rest = RestModel::Rotating;
  ElasticMeasure measure = ElasticMeasure::Lengths;
  std::optional<int> cutoff_levels = {};  ///< with Parameters: the paper's thin plate (EnergyOptions)
};

/// Immutable, safe from several threads, a handle as Topology is: copies share what they stand for.
class ElasticSurface {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// rest: the control points of the rest shape, V-by-3. About 10 microseconds a face. Throws Error(BadArgument) for
  /// the Butterflies and options out of range, Error(NotTriangles, BadShape, NotFinite, TooLarge, Cancelled).
  ElasticSurface(const SurfacePatches& patches, ConstValuesRef rest, const ElasticOptions& options = {},
                 const Progress& progress = {});
  ElasticSurface(const Topology& topology, const Scheme& scheme, ConstValuesRef rest,
                 const ElasticOptions& options = {}, const Progress& progress = {});

  const SurfacePatches& patches() const;
  const Topology& topology() const { return patches().topology(); }
  const ElasticOptions& options() const;
  const Points& rest() const;
  double diagonal() const;  ///< of the box around the rest shape's control points

  const Matrix& mass() const;  ///< M: its entries sum to the mass of the body
  /// D. Where it is a factor of M it is made at the first call: damping_ratio() says so without it.
  const Matrix& damping() const;
  /// The number that D is M times, where density and damping are each one for all faces and the density is not 0.
  std::optional<double> damping_ratio() const;
  const Matrix& stiffness() const;  ///< K

  /// K R for RestModel's R; zero for Point. What a step with K in its system puts on the right hand side. positions,
  /// result: V-by-3. Threaded. Throws Error(BadShape, NotFinite).
  void rest_force(ConstValuesRef positions, ValuesRef result) const;

  /// E. Throws Error(BadShape, NotFinite).
  double energy(ConstValuesRef positions) const;
  /// The force K (R - P). Throws Error(BadShape, NotFinite).
  Points force(ConstValuesRef positions) const;
  /// 1/2 * sum over the columns of v^T M v.
  double kinetic_energy(ConstValuesRef velocities) const;

  /// The body on the control mesh refined once: the same surface with four times the control points. Mass, damping and
  /// coefficients of each face are the same. Energies that do not depend on the size of elements stay: stretching, and
  /// bending away from extraordinary vertices, under Linear and Point; under Rotating smaller faces may turn.
  ElasticSurface refined(const Progress& progress = {}) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// Where a body is and how it moves: all that a run depends on, to be kept and taken up again.
struct ElasticState {
  double time = 0.0;  ///< seconds
  Points positions;   ///< of the control points, V-by-3
  Points velocities;  ///< of the control points per second, V-by-3
};

/// The rest shape, not moving, at time 0.
ElasticState state_at_rest(const ElasticSurface& surface);

/// The same place and motion of the surface on `surface.refined()`. Throws Error(BadShape).
ElasticState refined_state(const ElasticSurface& surface, const ElasticState& state);

}  // namespace batten
