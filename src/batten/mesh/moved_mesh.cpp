#include "batten/mesh/moved_mesh.h"

#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

Mesh with_points(const Mesh& mesh, ConstValuesRef points) {
  if (points.rows() != mesh.points.rows() || points.cols() != 3) {
    throw Error(ErrorCode::BadShape, "there must be one point of three coordinates for each of the mesh's " +
                                         std::to_string(mesh.points.rows()) + " vertices");
  }
  Mesh moved = mesh;
  moved.points = points;
  std::erase_if(moved.attributes, [](const Attribute& attribute) { return attribute.name == "normal"; });
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
