#include "batten/fit/first_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "batten/error.h"
#include "batten/fit/cloud_field.h"
#include "batten/fit/contour_parts.h"
#include "batten/fit/contour_search.h"

namespace batten {

Index FirstMesh::genus() const {
  Index sum = 0;
  for (const FirstMeshPart& part : parts) sum += part.genus;
  return sum;
}

FirstMesh first_mesh(const PointCloud& cloud, const FirstMeshOptions& options, const Progress& progress) {
  if (options.vertices < 8 || options.vertices > 1000000)
    throw Error(ErrorCode::BadArgument, "a first mesh has 8 to 1,000,000 vertices");
  const CloudField field(prepare_cloud(cloud, progress_within(progress, 0.0, 0.6)), progress_within(progress, 0.6, 0.8));
  FoundContour found = find_contour(field, options);
  FirstMesh result;
  result.parts = mesh_parts(found.mesh);
  result.mesh = std::move(found.mesh);
  result.mesh.points *= field.samples.size;
  result.mesh.points.rowwise() += field.samples.centre;
  result.simplified = found.simplified;
  result.spacing = found.spacing * field.samples.size;
  result.point_spacing = field.samples.typical * field.samples.size;
  result.repeated_points = field.samples.repeated;
  result.outliers = field.samples.outliers;
  result.dropped_parts = found.dropped;
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
