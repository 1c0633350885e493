#include <cstdio>

#include "batten/batten.h"

/// Colours are interpolated like points: the surface has exactly these colours at exactly these points.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Points low = mesh.points.colwise().minCoeff().replicate(mesh.vertex_count(), 1);
  const batten::Values colors = (mesh.points - low) / batten::bounding_diagonal(mesh.points);
  mesh.attributes.push_back({"color", colors, {}});
  const batten::InterpolatedMesh result = batten::interpolate(mesh);
  batten::write_mesh(argv[2], result.mesh);
  const batten::LimitMatrix matrix(result.topology, result.scheme);
  const batten::Values limit = matrix.apply(result.mesh.attributes.back().values).topRows(mesh.vertex_count());
  std::printf("colours hold to %.1e\n", (limit - colors).cwiseAbs().maxCoeff());
}
