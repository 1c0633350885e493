#include "batten/mesh/mesh.h"

namespace batten {

double bounding_diagonal(ConstValuesRef points) {
  if (points.rows() == 0) return 0.0;
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

bool all_triangles(const Mesh& mesh) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_size(f) != 3) return false;
  }
  return mesh.face_count() > 0;
}

}  // namespace batten
