#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "batten/interpolate/fair_interpolation.h"
#include "batten/interpolate/interpolated_mesh.h"
#include "batten/interpolate/interpolation_updates.h"
#include "batten/interpolate/interpolator.h"
#include "batten/interpolate/local_normals.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/refine/refinement.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/words.h"

namespace batten::python {

namespace {

const Words<OnSingular> kOnSingular{
    {"refuse", OnSingular::Refuse}, {"least-squares", OnSingular::LeastSquares}, {"alpha", OnSingular::Alpha}};
const Words<Outcome> kOutcomes{{"reached", Outcome::Reached},
                               {"rounding", Outcome::Rounding},
                               {"least-squares", Outcome::LeastSquares},
                               {"not-reached", Outcome::NotReached}};
const Words<ShapeEnergyKind> kShapeEnergies{{"stretch", ShapeEnergyKind::Stretch},
                                            {"bending", ShapeEnergyKind::Bending},
                                            {"variation", ShapeEnergyKind::Variation}};

InterpolateOptions options_of(double tolerance, const std::string& method, const std::string& on_singular) {
  InterpolateOptions options;
  options.tolerance = tolerance;
  options.method = choice_of(method, kMethods, "the method");
  options.on_singular = choice_of(on_singular, kOnSingular, "on_singular");
  return options;
}

py::dict report_of(const InterpolationReport& report) {
  py::list worst;
  for (const RowError& entry : report.worst) worst.append(py::make_tuple(entry.row, entry.error));
  py::dict result;
  result["name"] = report.name;
  result["outcome"] = word_of(report.outcome, kOutcomes);
  result["method"] = report.solve.method_name;
  result["iterations"] = report.solve.iterations;
  result["residuals"] = report.solve.residual_history;
  result["seconds"] = report.solve.seconds;
  result["diagonal"] = report.diagonal;
  result["max_error"] = report.max_error;
  result["rms_error"] = report.rms_error;
  result["max_movement"] = report.max_movement;
  result["worst"] = worst;
  result["singular_components"] = static_cast<Index>(report.singular.size());
  return result;
}

py::tuple interpolate_mesh(const Interpolator& interpolator, const Mesh& mesh, const py::object& progress) {
  InterpolatedMesh result =
      run(progress, [&](const Progress& report) { return interpolate(interpolator, mesh, report); });
  py::list reports;
  for (const InterpolationReport& report : result.reports) reports.append(report_of(report));
  return py::make_tuple(std::move(result.mesh), result.is_refined, reports);
}

/// Control points, the report, and where the topology had to be refined, that with its scheme, else None.
py::tuple solve(const Interpolator& interpolator, const Doubles& targets, const py::object& progress) {
  const Eigen::Map<const Values> rows = rows_of(targets, "targets");
  Interpolant result = run(progress, [&](const Progress& report) { return interpolator.solve(rows, report); });
  const bool is_refined = result.topology.vertex_count() != interpolator.topology().vertex_count();
  py::object refined = py::none();
  if (is_refined) refined = py::make_tuple(result.topology, result.scheme);
  return py::make_tuple(array_of(std::move(result.control)), report_of(result.report), refined);
}

py::dict report_of(const FairReport& report) {
  py::dict result;
  result["method"] = report.solve.method_name;
  result["iterations"] = report.solve.iterations;
  result["converged"] = report.solve.converged;
  result["levels"] = report.levels;
  result["plain_energy"] = report.plain_energy;
  result["energy"] = report.energy;
  result["diagonal"] = report.diagonal;
  result["max_error"] = report.max_error;
  result["rms_error"] = report.rms_error;
  result["worst_vertex"] = report.worst_vertex;
  result["normal_count"] = report.normal_count;
  result["max_angle"] = report.max_angle;
  return result;
}

/// normals: of zero rows for none.
py::tuple fair(const Topology& topology, const Scheme& scheme, const Doubles& targets, const Doubles& normals,
               const std::string& energy, double smoothing, int levels, const py::object& progress) {
  FairOptions options;
  options.energy = choice_of(energy, kShapeEnergies, "the energy");
  options.smoothing = smoothing;
  if (levels > 0) options.levels = levels;
  if (normals.size() > 0) options.normals = points_of(normals, "normals");
  const Eigen::Map<const Values> rows = points_of(targets, "targets");
  FairInterpolant result = run(
      progress, [&](const Progress& report) { return interpolate_fairly(topology, scheme, rows, options, report); });
  Mesh mesh = mesh_from_topology(result.topology);
  mesh.points = result.control;
  state_scheme(result.scheme, mesh);
  return py::make_tuple(std::move(mesh), report_of(result.report));
}

/// A surface whose targets move, kept solved.
class Updates {
 public:
  Updates(const Interpolator& interpolator, const Doubles& targets, const py::object& progress)
      : updates_(run(progress, [&, rows = rows_of(targets, "targets")](const Progress& report) {
          return InterpolationUpdates(interpolator, rows, report);
        })) {}

  py::dict update(const Indices& rows, const Doubles& values, int rings, const py::object& progress) {
    const std::span<const Index> changed(rows.data(), static_cast<std::size_t>(rows.size()));
    const Eigen::Map<const Values> given = rows_of(values, "targets");
    const UpdateReport report = run(progress, [&](const Progress& of_call) {
      return rings < 0 ? updates_.update(changed, given, of_call)
                       : updates_.update_within(rings, changed, given, of_call);
    });
    py::dict result;
    result["is_local"] = report.is_local;
    result["moved"] = report.moved;
    result["max_error"] = report.max_error;
    result["error_bound"] = report.error_bound;
    result["max_miss"] = report.max_miss;
    result["worst_miss"] = report.worst_miss;
    return result;
  }
  py::array_t<double> targets() const { return array_of(Values(updates_.targets())); }
  py::array_t<double> control() const { return array_of(Values(updates_.control())); }
  py::array_t<Index> moved() const { return array_of(Buffer<Index>(updates_.moved().begin(), updates_.moved().end())); }

 private:
  InterpolationUpdates updates_;
};

}  // namespace

void bind_interpolation(py::module_& module) {
  py::class_<Interpolator>(module, "Interpolator")
      .def(py::init([](const Topology& topology, const Scheme& scheme, double tolerance, const std::string& method,
                       const std::string& on_singular, const py::object& progress) {
        const InterpolateOptions options = options_of(tolerance, method, on_singular);
        return run(progress, [&](const Progress& report) { return Interpolator(topology, scheme, options, report); });
      }))
      .def("interpolate", &interpolate_mesh)
      .def("solve", &solve);
  py::class_<Updates>(module, "Updates")
      .def(py::init<const Interpolator&, const Doubles&, const py::object&>(), py::keep_alive<1, 2>())
      .def("update", &Updates::update)
      .def("targets", &Updates::targets)
      .def("control", &Updates::control)
      .def("moved", &Updates::moved);
  module.def("interpolate_fairly", &fair);
  module.def("estimated_normals", [](const Topology& topology, const Doubles& points) {
    return array_of(estimated_wanted_normals(topology, points_of(points)));
  });
}

}  // namespace batten::python
