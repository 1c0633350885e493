#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "batten/expand/bands.h"
#include "batten/expand/denoise.h"
#include "batten/expand/mesh_series.h"
#include "batten/expand/morph.h"
#include "batten/expand/sharpen.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/words.h"

namespace batten::python {

namespace {

MeshSeries make_series(const Topology& topology, const Scheme& scheme, const std::string& matrix, const Doubles& shape,
                       const py::array_t<bool, py::array::c_style | py::array::forcecast>& kept,
                       const py::object& progress) {
  SeriesOptions options;
  options.matrix = choice_of(matrix, kMatrices, "the matrix");
  if (shape.size() > 0) options.shape = points_of(shape, "the shape");
  options.kept.assign(kept.data(), kept.data() + kept.size());
  return run(progress, [&](const Progress& report) { return MeshSeries(topology, scheme, options, report); });
}

py::tuple denoised(const Topology& topology, const Scheme& scheme, const Doubles& points, const std::string& matrix,
                   int m, int passes, double features, bool keep_boundary, bool keep_volume,
                   const py::object& progress) {
  DenoiseOptions options;
  options.matrix = choice_of(matrix, kMatrices, "the matrix");
  options.m = m;
  options.automatic = passes < 0;
  if (!options.automatic) options.passes = passes;
  options.features = features > 0.0;
  if (options.features) options.feature_options.degrees = features;
  options.keep_boundary = keep_boundary;
  options.keep_volume = keep_volume;
  const Eigen::Map<const Values> rows = points_of(points);
  DenoiseResult result =
      run(progress, [&](const Progress& report) { return denoise(topology, scheme, rows, options, report); });
  py::dict report;
  report["noise"] = result.noise.deviation;
  report["m"] = result.smoothing.m;
  report["passes"] = result.smoothing.passes;
  report["removed"] = result.removed;
  report["moved"] = result.moved;
  report["most_moved"] = result.most_moved;
  report["most_moved_vertex"] = result.most_moved_vertex;
  report["volume_before"] = result.volume_before;
  report["volume_after"] = result.volume_after;
  py::list creases;
  for (const Crease& crease : result.features) creases.append(py::make_tuple(crease.a, crease.b, crease.sharpness));
  return py::make_tuple(array_of(std::move(result.points)), report, creases);
}

py::tuple sharpened(const Topology& topology, const Scheme& scheme, const Doubles& points, int m, int n, int passes,
                    double amount, const py::object& progress) {
  SharpenOptions options;
  options.m = m;
  options.n = n;
  options.passes = passes;
  options.amount = amount;
  const Eigen::Map<const Values> rows = points_of(points);
  SharpenResult result =
      run(progress, [&](const Progress& report) { return sharpen(topology, scheme, rows, options, report); });
  py::dict report;
  report["amount"] = result.amount;
  report["growth"] = result.growth;
  report["moved"] = result.moved;
  report["most_moved"] = result.most_moved;
  report["most_moved_vertex"] = result.most_moved_vertex;
  report["turned_faces"] = result.turned_faces;
  return py::make_tuple(array_of(std::move(result.points)), report);
}

/// The values with each octave's bumps times its gain, and what each had.
py::tuple equalized(const MeshSeries& series, const Scheme& scheme, const std::string& matrix, const Doubles& values,
                    const std::vector<double>& gains, const py::object& progress) {
  const std::vector<Band> bands =
      octave_bands(scheme.kind, choice_of(matrix, kMatrices, "the matrix"), static_cast<int>(gains.size()));
  const Eigen::Map<const Values> rows = rows_of(values);
  Equalized result =
      run(progress, [&](const Progress& report) { return equalize(series, rows, bands, gains, report); });
  py::list lengths;
  for (const Band& band : bands) lengths.append(py::make_tuple(band.shortest, band.longest));
  return py::make_tuple(array_of(std::move(result.values)), result.energies, lengths);
}

}  // namespace

void bind_series(py::module_& module) {
  py::class_<MeshSeries>(module, "MeshSeries")
      .def(py::init(&make_series))
      .def("smooth",
           [](const MeshSeries& series, const Doubles& values, int m, int passes, const py::object& progress) {
             const Eigen::Map<const Values> rows = rows_of(values);
             return array_of(
                 run(progress, [&](const Progress& report) { return series.smooth(rows, m, passes, report); }));
           })
      .def("term",
           [](const MeshSeries& series, const Doubles& values, int index, const py::object& progress) {
             const Eigen::Map<const Values> rows = rows_of(values);
             return array_of(run(progress, [&](const Progress& report) { return series.term(rows, index, report); }));
           })
      .def("partial_sum",
           [](const MeshSeries& series, const Doubles& values, int last, const py::object& progress) {
             const Eigen::Map<const Values> rows = rows_of(values);
             return array_of(
                 run(progress, [&](const Progress& report) { return series.partial_sum(rows, last, report); }));
           })
      .def("equalize", &equalized);
  py::class_<Morph>(module, "Morph")
      .def(py::init([](const MeshSeries& series, const Doubles& from, const Doubles& to, int m, int stages,
                       bool low_first, const py::object& progress) {
        const Eigen::Map<const Values> begin = rows_of(from);
        const Eigen::Map<const Values> end = rows_of(to);
        const MorphOptions options{m, stages, low_first ? MorphOrder::LowFirst : MorphOrder::LowLast};
        return run(progress, [&](const Progress& report) { return Morph(series, begin, end, options, report); });
      }))
      .def("at", [](const Morph& morph, double t) { return array_of(morph.at(t)); });
  module.def("denoise", &denoised);
  module.def("sharpen", &sharpened);
}

}  // namespace batten::python
