#include "batten/mesh/mesh.h"

#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

double bounding_diagonal(ConstValuesRef points) {
  if (points.rows() == 0) return 0.0;
  struct Box {
    Eigen::RowVectorXd low;
    Eigen::RowVectorXd high;
  };
  const Box box = parallel_reduce(
      points.rows(), Box{points.row(0), points.row(0)},
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Box part{points.row(begin), points.row(begin)};
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          for (std::ptrdiff_t c = 0; c < points.cols(); ++c) {
            part.low[c] = std::min(part.low[c], points(i, c));
            part.high[c] = std::max(part.high[c], points(i, c));
          }
        }
        return part;
      },
      [](const Box& a, const Box& b) {
        return Box{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
      });
  const double diagonal = (box.high - box.low).norm();
  if (diagonal > 0.0 && std::isfinite(diagonal)) return diagonal;
  return (box.high - box.low).stableNorm();  // where squares leave the doubles
}

bool all_triangles(const Mesh& mesh) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_size(f) != 3) return false;
  }
  return mesh.face_count() > 0;
}

}  // namespace batten
