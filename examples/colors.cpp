#include <cstdio>

#include "batten/batten.h"

/// Colours are just more columns: the surface has exactly these colours at exactly these points.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Topology topology(mesh);
  const batten::Interpolator interpolator(topology, batten::choose_scheme(mesh));
  const batten::Points low = mesh.points.colwise().minCoeff().replicate(mesh.vertex_count(), 1);
  batten::Values targets(mesh.vertex_count(), 6);
  targets << mesh.points, (mesh.points - low) / batten::bounding_diagonal(mesh.points);
  const batten::Values control = interpolator.solve(targets).control;
  mesh.points = control.leftCols(3);
  mesh.attributes.push_back({"color", control.rightCols(3), {}});
  batten::write_mesh(argv[2], mesh);
  const batten::Values limit = interpolator.limit_matrix().apply(control);
  std::printf("colours hold to %.1e\n", (limit - targets).rightCols(3).cwiseAbs().maxCoeff());
}
