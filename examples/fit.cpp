#include <cstdio>

#include "batten/batten.h"

/// Fits a control mesh of at most 400 points to a scan and says how exact its surface is.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::PointCloud cloud;
  cloud.points = batten::read_mesh(argv[1]).points;
  batten::FitOptions options;
  options.vertices = 400;
  const batten::FitResult fit = batten::fit_surface(cloud, options);
  std::printf("%d control points; points are at most %.3g %% of the diameter away\n", fit.topology.vertex_count(),
              100.0 * fit.report.to_surface.max / fit.report.diameter);
  batten::write_mesh(argv[2], fit.mesh);
}
