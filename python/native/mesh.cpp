#include "batten/mesh/mesh.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <tuple>

#include "batten/io/io.h"
#include "batten/io/losses.h"
#include "batten/mesh/check.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/words.h"

namespace batten::python {

namespace {

using CreaseTuple = std::tuple<Index, Index, double>;
using CornerTuple = std::tuple<Index, double>;

Buffer<Index> indices_of(const Indices& array) { return Buffer<Index>(array.data(), array.data() + array.size()); }

Mesh make_mesh(const Doubles& points, const Indices& offsets, const Indices& vertices,
               const std::vector<CreaseTuple>& creases, const std::vector<CornerTuple>& corners,
               const std::vector<Index>& holes, const std::string& scheme, const std::string& boundary) {
  Mesh mesh;
  mesh.points = points_of(points);
  mesh.face_offsets = indices_of(offsets);
  mesh.face_vertices = indices_of(vertices);
  for (const auto& [a, b, sharpness] : creases) mesh.creases.push_back({a, b, sharpness});
  for (const auto& [vertex, sharpness] : corners) mesh.corners.push_back({vertex, sharpness});
  mesh.holes = holes;
  if (!scheme.empty()) mesh.scheme = choice_of(scheme, kSchemes, "the scheme");
  if (!boundary.empty()) mesh.boundary = choice_of(boundary, kBoundaries, "the boundary");
  return mesh;
}

/// corner_rows: empty for values at the vertices.
void add_attribute(Mesh& mesh, const std::string& name, const Doubles& values, const Indices& corner_rows) {
  mesh.attributes.push_back({name, rows_of(values, "an attribute's values"), indices_of(corner_rows)});
}

py::list attributes_of(const Mesh& mesh) {
  py::list result;
  for (const Attribute& attribute : mesh.attributes) {
    result.append(py::make_tuple(attribute.name, array_of(Values(attribute.values)),
                                 array_of(Buffer<Index>(attribute.corner_rows))));
  }
  return result;
}

/// The mesh's own choice of a surface, with what the words say instead, where they are not empty.
Scheme scheme_of(const Mesh& mesh, const std::string& kind, const std::string& boundary) {
  Scheme scheme = choose_scheme(mesh);
  if (kind != "auto") scheme.kind = choice_of(kind, kSchemes, "the scheme");
  if (!boundary.empty()) scheme.boundary = choice_of(boundary, kBoundaries, "the boundary");
  return scheme;
}

py::list problems_of(const Mesh& mesh, std::size_t limit, const py::object& progress) {
  const std::vector<MeshProblem> problems =
      run(progress, [&](const Progress& report) { return check(mesh, limit, report); });
  py::list result;
  for (const MeshProblem& problem : problems) {
    result.append(py::make_tuple(static_cast<int>(problem.kind), problem.count, problem.messages));
  }
  return result;
}

py::tuple repaired(const Mesh& mesh, double weld, const py::object& progress) {
  RepairResult result = run(progress, [&](const Progress& report) { return repair(mesh, {weld}, report); });
  py::list changes;
  for (const RepairChange& change : result.changes) {
    changes.append(py::make_tuple(repair_word(change.kind), change.count, change.text));
  }
  return py::make_tuple(std::move(result.mesh), changes, array_of(std::move(result.vertex_sources)),
                        array_of(std::move(result.face_sources)), array_of(std::move(result.vertex_targets)),
                        array_of(std::move(result.face_targets)));
}

py::tuple read(const std::string& path, const std::string& format, const py::object& progress) {
  std::vector<std::string> notes;
  Mesh mesh = run(progress, [&](const Progress& report) { return read_mesh(path, format, report, &notes); });
  return py::make_tuple(std::move(mesh), notes);
}

std::vector<std::string> write(const std::string& path, const Mesh& mesh, const std::string& format, bool binary,
                               const py::object& progress) {
  WriteOptions options;
  options.format = format;
  options.binary = binary;
  run(progress, [&](const Progress& report) {
    write_mesh(path, mesh, options, report);
    return 0;
  });
  return find_losses(path, mesh, options);
}

Mesh refined(const Mesh& mesh, const Topology& topology, const Scheme& scheme, int levels, const py::object& progress) {
  Mesh result =
      run(progress, [&](const Progress& report) { return refine_mesh(topology, scheme, mesh, levels, report).mesh; });
  state_scheme(scheme.after_first_step(), result);
  return result;
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::class_<Mesh>(module, "MeshData")
      .def(py::init(&make_mesh))
      .def("add_attribute", &add_attribute)
      .def("points", [](const Mesh& mesh) { return array_of(Points(mesh.points)); })
      .def("face_offsets", [](const Mesh& mesh) { return array_of(Buffer<Index>(mesh.face_offsets)); })
      .def("face_vertices", [](const Mesh& mesh) { return array_of(Buffer<Index>(mesh.face_vertices)); })
      .def("creases",
           [](const Mesh& mesh) {
             std::vector<CreaseTuple> result;
             for (const Crease& crease : mesh.creases) result.emplace_back(crease.a, crease.b, crease.sharpness);
             return result;
           })
      .def("corners",
           [](const Mesh& mesh) {
             std::vector<CornerTuple> result;
             for (const Corner& corner : mesh.corners) result.emplace_back(corner.vertex, corner.sharpness);
             return result;
           })
      .def("holes", [](const Mesh& mesh) { return mesh.holes; })
      .def("attributes", &attributes_of)
      .def("scheme", [](const Mesh& mesh) { return mesh.scheme ? word_of(*mesh.scheme, kSchemes) : ""; })
      .def("boundary", [](const Mesh& mesh) { return mesh.boundary ? word_of(*mesh.boundary, kBoundaries) : ""; });
  py::class_<Scheme>(module, "Scheme")
      .def("kind", [](const Scheme& scheme) { return word_of(scheme.kind, kSchemes); })
      .def("boundary", [](const Scheme& scheme) { return word_of(scheme.boundary, kBoundaries); });
  py::class_<Topology>(module, "Topology")
      .def(py::init([](const Mesh& mesh, const py::object& progress) {
        return run(progress, [&](const Progress& report) { return Topology(mesh, report); });
      }))
      .def("vertex_count", &Topology::vertex_count)
      .def("face_count", &Topology::face_count)
      .def("edge_count", &Topology::edge_count);
  py::class_<Refinement>(module, "Refinement")
      .def(py::init([](const Topology& topology, const Scheme& scheme, const py::object& progress) {
        return run(progress, [&](const Progress& report) { return Refinement(topology, scheme, {}, report); });
      }))
      .def("vertex_count", [](const Refinement& refinement) { return refinement.child().vertex_count(); })
      .def("apply",
           [](const Refinement& refinement, const Doubles& values, const py::object& progress) {
             const Eigen::Map<const Values> rows = rows_of(values);
             return array_of(run(progress, [&](const Progress& report) { return refinement.apply(rows, report); }));
           })
      .def("mesh", [](const Refinement& refinement, const Doubles& points) {
        Mesh mesh = mesh_from_topology(refinement.child());
        mesh.points = points_of(points);
        state_scheme(refinement.scheme().after_first_step(), mesh);
        return mesh;
      });
  module.def("scheme_of", &scheme_of);
  module.def("check", &problems_of);
  module.def("repair", &repaired);
  module.def("triangulate", &triangulated);
  module.def("read", &read);
  module.def("write", &write);
  module.def("refine", &refined);
  module.def("mesh_of", [](const Topology& topology, const Doubles& points, const Scheme& scheme) {
    Mesh mesh = mesh_from_topology(topology);
    mesh.points = points_of(points);
    state_scheme(scheme, mesh);
    return mesh;
  });
}

}  // namespace batten::python
