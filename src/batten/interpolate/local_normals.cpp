#include "batten/interpolate/local_normals.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "batten/error.h"
#include "batten/interpolate/ring_relaxation.h"
#include "batten/interpolate/ring_turns.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/mesh/checked_values.h"
#include "batten/progress.h"
#include "batten/refine/refined_mesh.h"

namespace batten {

namespace {

constexpr int kLevels = 2;

void require_turnable(const Topology& topology, const Scheme& scheme, ConstValuesRef wanted,
                      const TurnOptions& options) {
  if (is_interpolating(scheme.kind)) {
    throw Error(ErrorCode::BadArgument, std::string("wanted normals need Catmull-Clark or Loop: limits of ") +
                                            scheme_name(scheme.kind) + " depend on more than one ring");
  }
  if (!(options.tolerance >= 0.0 && options.tolerance <= std::numbers::pi))
    throw Error(ErrorCode::BadArgument, "the tolerance of normals must be an angle from 0 to pi");
  if (wanted.rows() > topology.vertex_count())
    throw Error(ErrorCode::BadShape, "there are more wanted normals than vertices");
}

/// Lets the displacement from `before` bend less; energies and iterations go into the report.
void relax(const Topology& topology, const Scheme& scheme, const Values& before, const HeldLimits& held,
           Values& control, TurnEnergy& report, const Progress& progress) {
  const SurfaceEnergy::Matrix thin_plate = SurfaceEnergy(topology, scheme, {}, progress_within(progress, 0.0, 0.3))
                                               .matrix(EnergyKind::ThinPlate, progress_within(progress, 0.3, 0.7));
  report.before = quadratic_form(thin_plate, before);
  report.turned = quadratic_form(thin_plate, control);
  Values displacement = control - before;
  report.iterations = relax_displacement(thin_plate, held, displacement, progress_within(progress, 0.7, 1.0));
  control = before + displacement;
  report.relaxed = quadratic_form(thin_plate, control);
}

/// Turns and relaxes the control points of a mesh that has been refined kLevels times.
TurnReport turn_refined(const Topology& topology, const Scheme& scheme, const Values& wanted,
                        const TurnOptions& options, Values& control, const Progress& progress) {
  const double turned = options.relax ? 0.1 : 1.0;  // of the time
  Values before;
  if (options.relax) before = control;
  TurnReport report;
  const VertexFrames frames(topology, scheme);
  turn_rings(frames, wanted, options.tolerance, control, report, progress_within(progress, 0.0, turned));
  if (options.relax && report.counts.turned > 0) {
    relax(topology, scheme, before, HeldLimits(frames, static_cast<Index>(wanted.rows())), control, report.energy,
          progress_within(progress, turned, 1.0));
  }
  measure_turned(frames, wanted, control, report);
  return report;
}

}  // namespace

TurnedSurface turn_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                           ConstValuesRef wanted, const TurnOptions& options, const Progress& progress) {
  constexpr double kRefined = 0.3;  // of the time
  require_turnable(topology, scheme, wanted, options);
  if (control.cols() != 3) throw Error(ErrorCode::BadShape, "control points must have three columns");
  const Values unit = wanted_normals(wanted);
  RefinedSurface fine =
      refine(with_surface_holes(topology, scheme), scheme, control, kLevels, progress_within(progress, 0.0, kRefined));
  TurnedSurface result{fine.topology, scheme.after_first_step(), std::move(fine.values), {}};
  result.report = turn_refined(result.topology, result.scheme, unit, options, result.control,
                               progress_within(progress, kRefined, 1.0));
  return result;
}

TurnReport turn_normals(InterpolatedMesh& surface, ConstValuesRef wanted, const TurnOptions& options,
                        const Progress& progress) {
  constexpr double kRefined = 0.3;  // of the time
  require_turnable(surface.topology, surface.scheme, wanted, options);
  const Values unit = wanted_normals(wanted);
  RefinedMesh fine =
      refine_mesh(surface.topology, surface.scheme, surface.mesh, kLevels, progress_within(progress, 0.0, kRefined));
  Values control = fine.mesh.points;
  TurnReport report =
      turn_refined(fine.topology, surface.scheme, unit, options, control, progress_within(progress, kRefined, 1.0));
  if (report.counts.turned == 0) return report;
  fine.mesh.points = control;
  surface.mesh = std::move(fine.mesh);
  surface.topology = fine.topology;
  return report;
}

}  // namespace batten
