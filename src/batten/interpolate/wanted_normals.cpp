#include "batten/interpolate/wanted_normals.h"

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/vertex_normals.h"

namespace batten {

Values wanted_normals(ConstValuesRef directions) {
  if (directions.cols() != 3) throw Error(ErrorCode::BadShape, "wanted normals must have three columns");
  require_finite(directions, "wanted normals");
  Values unit(directions.rows(), 3);
  for (Eigen::Index i = 0; i < unit.rows(); ++i) unit.row(i) = directions.row(i).stableNormalized();
  return unit;
}

Values stated_wanted_normals(const Mesh& mesh, const std::string& name) {
  if (!states_normals(mesh)) {
    throw Error(ErrorCode::BadArgument,
                name + ": has no normals; take a file that has (OBJ: vn, PLY: nx ny nz), or estimate them");
  }
  return wanted_normals(stated_normals(mesh));
}

Values estimated_wanted_normals(const Topology& topology, ConstValuesRef points) {
  return angle_weighted_normals(topology, points);
}

}  // namespace batten
