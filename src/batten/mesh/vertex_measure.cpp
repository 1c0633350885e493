#include "batten/mesh/vertex_measure.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace batten {

VertexMeasure measure_numbers(const Scalars& numbers) {
  VertexMeasure measure;
  double squares = 0.0;
  double sum = 0.0;
  Index count = 0;
  for (Index vertex = 0; vertex < static_cast<Index>(numbers.size()); ++vertex) {
    const double number = numbers(vertex);
    if (std::isnan(number)) continue;
    sum += number;
    squares += number * number;
    ++count;
    if (measure.worst_vertex >= 0 && number <= measure.max) continue;
    measure.max = number;
    measure.worst_vertex = vertex;
  }
  if (count == 0) return measure;
  measure.mean = sum / count;
  measure.rms = std::sqrt(squares / count);
  return measure;
}

double angle_between(const Eigen::RowVector3d& first, const Eigen::RowVector3d& second) {
  if (!(first.squaredNorm() > 0.0 && second.squaredNorm() > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(first.cross(second).norm(), first.dot(second));
}

}  // namespace batten
