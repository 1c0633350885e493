#include "batten/mesh/moved_mesh.h"

#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

Mesh with_points(const Mesh& mesh, ConstValuesRef points) {
  if (points.rows() != mesh.points.rows() || points.cols() != 3) {
    throw Error(ErrorCode::BadShape, "there must be one point of three coordinates for each of the mesh's " +
                                         std::to_string(mesh.points.rows()) + " vertices");
  }
  Mesh moved;
  moved.points = points;
  moved.face_offsets = mesh.face_offsets;
  moved.face_vertices = mesh.face_vertices;
  moved.creases = mesh.creases;
  moved.corners = mesh.corners;
  moved.holes = mesh.holes;
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name != "normal") moved.attributes.push_back(attribute);
  }
  moved.groups = mesh.groups;
  moved.material_libraries = mesh.material_libraries;
  moved.scheme = mesh.scheme;
  moved.boundary = mesh.boundary;
  moved.crease_method = mesh.crease_method;
  moved.triangle_rule = mesh.triangle_rule;
  return moved;
}

double mean_edge_length(const Topology& topology, ConstValuesRef points) {
  const auto lengths = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0.0;
    for (auto e = static_cast<Index>(begin); e < end; ++e) {
      const Index h = topology.edge_half_edge(e);
      sum += (points.row(topology.origin(h)) - points.row(topology.destination(h))).norm();
    }
    return sum;
  };
  const double sum = parallel_reduce(topology.edge_count(), 0.0, lengths, [](double a, double b) { return a + b; });
  return topology.edge_count() > 0 ? sum / topology.edge_count() : 0.0;
}

}  // namespace batten
