#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

#include "batten/fit/fit_surface.h"
#include "batten/refine/refinement.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/summary.h"
#include "native/words.h"

namespace batten::python {

namespace {

const Words<FitStart> kStarts{{"auto", FitStart::Auto}, {"sphere", FitStart::Sphere}};
const Words<FitMethod> kFitMethods{{"squared-distance", FitMethod::SquaredDistance}, {"dynamic", FitMethod::Dynamic}};
const Words<FitCreases> kFitCreases{{"auto", FitCreases::Auto}, {"none", FitCreases::None}, {"keep", FitCreases::Keep}};
const Words<FitEnd> kEnds{{"tolerance", FitEnd::Tolerance},
                          {"budget", FitEnd::Budget},
                          {"rounds", FitEnd::Rounds},
                          {"cancelled", FitEnd::Cancelled}};

/// initial: None, or a mesh. vertices, genus, bridge, creases, rounds: None where nothing is said.
py::tuple fitted(const Doubles& points, const Doubles& normals, const std::string& start, const py::object& initial,
                 const std::string& scheme, const std::optional<Index>& vertices, double tolerance,
                 const std::optional<Index>& genus, const std::optional<double>& bridge, const std::string& method,
                 const std::optional<std::string>& creases, const std::optional<int>& rounds,
                 const py::object& progress) {
  FitOptions options;
  options.start = choice_of(start, kStarts, "the start");
  if (!initial.is_none()) {
    options.initial = initial.cast<const Mesh&>();
    options.scheme = choose_scheme(*options.initial);
  }
  options.method = choice_of(method, kFitMethods, "the method");
  if (creases) options.creases = choice_of(*creases, kFitCreases, "creases");
  options.rounds = rounds.value_or(options.rounds);
  if (scheme != "auto") options.scheme.kind = choice_of(scheme, kSchemes, "the scheme");
  options.vertices = vertices;
  options.tolerance = tolerance;
  options.genus = genus;
  options.bridge = bridge;
  PointCloud cloud;
  cloud.points = points_of(points);
  cloud.normals = points_of(normals, "normals");
  FitResult result = run(progress, [&](const Progress& report) { return fit_surface(cloud, options, report); });
  py::dict report;
  report["end"] = word_of(result.report.end, kEnds);
  report["to_surface"] = dict_of(result.report.to_surface);
  report["to_points"] = dict_of(result.report.to_points);
  report["diameter"] = result.report.diameter;
  report["spacing"] = result.report.spacing;
  report["outliers"] = result.report.outliers;
  report["rounds"] = static_cast<Index>(result.report.rounds.size());
  report["seconds"] = result.report.seconds;
  return py::make_tuple(std::move(result.mesh), array_of(std::move(result.distances)), report);
}

}  // namespace

void bind_fit(py::module_& module) { module.def("fit", &fitted); }

}  // namespace batten::python
