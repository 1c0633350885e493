#include <vector>

#include "shapes.h"

namespace batten::models {
namespace {

using Neighbours = std::vector<std::vector<Index>>;

/// The neighbours along the edges, each one twice, once from each face of the edge.
Neighbours neighbours_of(const Mesh& mesh) {
  Neighbours neighbours(static_cast<std::size_t>(mesh.vertex_count()));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index size = mesh.face_size(f);
    const Index* vertices = mesh.face_vertices.data() + mesh.face_offsets[f];
    for (Index i = 0; i < size; ++i) {
      const Index a = vertices[i];
      const Index b = vertices[(i + 1) % size];
      neighbours[static_cast<std::size_t>(a)].push_back(b);
      neighbours[static_cast<std::size_t>(b)].push_back(a);
    }
  }
  return neighbours;
}

Points averaged(const Points& points, const Neighbours& neighbours) {
  Points mean(points.rows(), 3);
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    const std::vector<Index>& around = neighbours[static_cast<std::size_t>(v)];
    for (const Index other : around) sum += points.row(other);
    mean.row(v) = 0.5 * points.row(v) + 0.5 / static_cast<double>(around.size()) * sum;
  }
  return mean;
}

void project(Points& points) {
  const Eigen::RowVector3d centre = points.colwise().mean();
  for (Eigen::Index v = 0; v < points.rows(); ++v) points.row(v) = (points.row(v) - centre).normalized();
}

}  // namespace

Mesh ball_of(const Mesh& mesh, double radius) {
  constexpr int kInSpace = 120;  // until legs and ears are gone and every vertex is visible from the centre
  constexpr int kOnSphere = 400;
  const Neighbours neighbours = neighbours_of(mesh);
  Mesh ball = mesh;
  const Eigen::RowVector3d centre = mesh.points.colwise().mean();
  for (int i = 0; i < kInSpace; ++i) ball.points = averaged(ball.points, neighbours);
  project(ball.points);
  for (int i = 0; i < kOnSphere; ++i) {
    ball.points = averaged(ball.points, neighbours);
    project(ball.points);
  }
  ball.points = (radius * ball.points).rowwise() + centre;
  return ball;
}

}  // namespace batten::models
