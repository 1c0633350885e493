#include "batten/mesh/moved_mesh.h"

#include <string>
#include <vector>

#include "batten/error.h"

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

}  // namespace batten
