#include <cstdio>

#include "batten/batten.h"

/// Asks a surface for its area, its point nearest to the origin, and how it bends there.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const batten::Mesh control = batten::read_mesh(argv[1]);
  const batten::SurfacePatches patches(batten::Topology(control), batten::choose_scheme(control));
  const batten::LimitSurface surface(patches, control.points);
  const batten::NearestPoints points(patches, control.points);
  const double area = batten::area_weights(surface, batten::surface_quadrature(patches)).sum();
  const batten::NearestPoint nearest = points.nearest({0.0, 0.0, 0.0});
  const batten::PointCurvature curvature = batten::curvature_of(surface.jet(nearest.place));
  std::printf("area %.5g; %.5g from the origin, where the mean curvature is %.4g\n", area, nearest.distance,
              curvature.mean);
}
