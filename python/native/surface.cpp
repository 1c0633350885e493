#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "batten/adaptive/adaptive.h"
#include "batten/limit/limit_matrix.h"
#include "batten/nearest/nearest_point.h"
#include "batten/nearest/surface_distances.h"
#include "batten/surface/limit_surface.h"
#include "batten/surface/surface_weights.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/tessellate/tessellator.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/places.h"
#include "native/sparse.h"
#include "native/summary.h"
#include "native/words.h"

namespace batten::python {

namespace {

std::vector<Jet> jets_of(const LimitSurface& surface, const Indices& faces, const Doubles& parameters) {
  const std::vector<SurfacePlace> places = places_of(faces, parameters);
  const py::gil_scoped_release unlocked;
  std::vector<Jet> jets(places.size());
  surface.jets(places, jets);
  return jets;
}

/// n-by-6-by-3: point, du, dv, duu, duv, dvv.
py::array_t<double> jet_rows(const LimitSurface& surface, const Indices& faces, const Doubles& parameters) {
  const std::vector<Jet> jets = jets_of(surface, faces, parameters);
  Buffer<double> rows;
  rows.reserve(18 * jets.size());
  for (const Jet& jet : jets) {
    for (const Eigen::Vector3d* row : {&jet.point, &jet.du, &jet.dv, &jet.duu, &jet.duv, &jet.dvv}) {
      rows.insert(rows.end(), row->data(), row->data() + 3);
    }
  }
  return array_over<double>(std::move(rows), {static_cast<py::ssize_t>(jets.size()), 6, 3});
}

/// Normals, n-by-3; mean, Gaussian, greatest and least curvature, n-by-4; directions of the last two, n-by-2-by-3.
py::tuple curvatures(const LimitSurface& surface, const Indices& faces, const Doubles& parameters) {
  const std::vector<Jet> jets = jets_of(surface, faces, parameters);
  const auto count = static_cast<Eigen::Index>(jets.size());
  Values normals(count, 3);
  Values numbers(count, 4);
  Values directions(count, 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PointCurvature at = curvature_of(jets[static_cast<std::size_t>(i)]);
    normals.row(i) = at.normal;
    numbers.row(i) << at.mean, at.gaussian, at.greatest, at.least;
    directions.row(i) << at.greatest_direction.transpose(), at.least_direction.transpose();
  }
  return py::make_tuple(array_of(std::move(normals)), array_of(std::move(numbers)),
                        array_over<double>(std::move(directions), {count, 2, 3}));
}

/// Points, distances, faces and (u, v) of the nearest places.
py::tuple nearest(const NearestPoints& search, const Doubles& queries, const py::object& progress) {
  const Eigen::Map<const Values> rows = points_of(queries, "queries");
  std::vector<NearestPoint> found(static_cast<std::size_t>(rows.rows()));
  run(progress, [&](const Progress& report) {
    search.nearest(rows, found, report);
    return 0;
  });
  Values points(rows.rows(), 3);
  Scalars distances(rows.rows());
  Buffer<Index> faces(found.size());
  Values parameters(rows.rows(), 2);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    points.row(row) = found[i].point;
    distances[row] = found[i].distance;
    faces[i] = found[i].place.face;
    parameters.row(row) << found[i].place.u, found[i].place.v;
  }
  return py::make_tuple(array_of(std::move(points)), array_of(std::move(distances)), array_of(std::move(faces)),
                        array_of(std::move(parameters)));
}

py::tuple weights(const Topology& topology, const Scheme& scheme, const Indices& faces, const Doubles& parameters,
                  int part, const py::object& progress) {
  const std::vector<SurfacePlace> places = places_of(faces, parameters);
  const SurfaceWeights::Matrix rows = run(progress, [&](const Progress& report) {
    return SurfaceWeights(topology, scheme).rows(places, kAllJetParts.at(static_cast<std::size_t>(part)), report);
  });
  return sparse_of(rows);
}

/// Fills arrays that the caller keeps from frame to frame. normals: without entries for none.
template <typename Number>
void tessellate_into(const Tessellator& tessellator, const Doubles& control, py::array_t<Number> points,
                     py::array_t<Number> normals, bool limit, const py::object& progress) {
  const Eigen::Map<const Values> rows = points_of(control, "control points");
  const std::span<Number> out(points.mutable_data(), static_cast<std::size_t>(points.size()));
  const std::span<Number> directions(normals.mutable_data(), static_cast<std::size_t>(normals.size()));
  run(progress, [&](const Progress& report) {
    if (limit || !directions.empty()) {
      tessellator.limit<Number>(rows, out, directions, report);
    } else {
      tessellator.refined<Number>(rows, out, report);
    }
    return 0;
  });
}

/// A triangle mesh, and its edges' and angles' greatest.
py::tuple adaptive(const Topology& topology, const Scheme& scheme, const Doubles& control, double chord,
                   double edge_length, double angle, const py::object& progress) {
  AdaptiveOptions options;
  options.chord = chord;
  options.edge_length = edge_length;
  options.angle = angle;
  const Eigen::Map<const Values> rows = points_of(control, "control points");
  AdaptiveMesh result = run(
      progress, [&](const Progress& report) { return tessellate_adaptively(topology, scheme, rows, options, report); });
  return py::make_tuple(std::move(result.mesh), result.unmet);
}

py::tuple distances(const Topology& topology, const Scheme& scheme, const Doubles& control, const Doubles& points,
                    const py::object& progress) {
  const Eigen::Map<const Values> rows = points_of(control, "control points");
  const Eigen::Map<const Values> queries = points_of(points);
  SurfaceDistances found =
      run(progress, [&](const Progress& report) { return measure_distances(topology, scheme, rows, queries, report); });
  return py::make_tuple(array_of(std::move(found.distances)), found.closed, found.diagonal, found.tolerance);
}

}  // namespace

void bind_surface(py::module_& module) {
  module.def("limit_positions", [](const Topology& topology, const Scheme& scheme, const Doubles& values,
                                   const py::object& progress) {
    const Eigen::Map<const Values> rows = rows_of(values);
    return array_of(
        run(progress, [&](const Progress& report) { return LimitMatrix(topology, scheme).apply(rows, report); }));
  });
  module.def("limit_normals",
             [](const Topology& topology, const Scheme& scheme, const Doubles& control, const py::object& progress) {
               const Eigen::Map<const Values> rows = points_of(control, "control points");
               return array_of(run(progress, [&](const Progress& report) {
                                 return limit_normals(topology, scheme, rows, LimitMasks::Exact, report);
                               }).vertices);
             });
  py::class_<LimitSurface>(module, "LimitSurface")
      .def(py::init(
          [](const Topology& topology, const Scheme& scheme, const Doubles& control, const py::object& progress) {
            const Eigen::Map<const Values> rows = points_of(control, "control points");
            return run(progress, [&](const Progress& report) { return LimitSurface(topology, scheme, rows, report); });
          }))
      .def("face_count", [](const LimitSurface& surface) { return surface.base().face_count(); })
      .def("jets", &jet_rows)
      .def("curvatures", &curvatures);
  py::class_<NearestPoints>(module, "NearestPoints")
      .def(py::init(
          [](const Topology& topology, const Scheme& scheme, const Doubles& control, const py::object& progress) {
            const Eigen::Map<const Values> rows = points_of(control, "control points");
            return run(progress, [&](const Progress& report) { return NearestPoints(topology, scheme, rows, report); });
          }))
      .def("set_control",
           [](NearestPoints& search, const Doubles& control, const py::object& progress) {
             const Eigen::Map<const Values> rows = points_of(control, "control points");
             run(progress, [&](const Progress& report) {
               search.set_control(rows, report);
               return 0;
             });
           })
      .def("tolerance", &NearestPoints::tolerance)
      .def("query", &nearest);
  module.def("surface_weights", &weights);
  py::class_<Tessellator>(module, "Tessellator")
      .def(py::init([](const Topology& topology, const Scheme& scheme, int levels) {
        const py::gil_scoped_release unlocked;
        return Tessellator(topology, scheme, levels);
      }))
      .def("vertex_count", &Tessellator::vertex_count)
      .def("face_count", &Tessellator::face_count)
      .def("face_size", &Tessellator::face_size)
      .def("into", &tessellate_into<float>)
      .def("into", &tessellate_into<double>)
      .def("faces", [](const Tessellator& tessellator) {
        Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) *
                            static_cast<std::size_t>(tessellator.face_size()));
        tessellator.faces(faces);
        const py::ssize_t rows = tessellator.face_count();
        const py::ssize_t cols = tessellator.face_size();
        return array_over<Index>(std::move(faces), {rows, cols});
      });
  module.def("tessellate_adaptively", &adaptive);
  module.def("distances", &distances);
  module.def("summarize", [](const Doubles& values) {
    const Eigen::Map<const Values> rows = rows_of(values);
    return dict_of(summarize_distances(Scalars(rows.col(0))));
  });
  module.def("surface_mesh", [](const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                                const py::object& progress) {
    return run(progress,
               [&](const Progress& report) { return surface_mesh(topology, scheme, control, levels, report); });
  });
}

}  // namespace batten::python
