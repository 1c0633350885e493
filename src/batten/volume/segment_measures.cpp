#include "batten/volume/segment_measures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "batten/fit/point_tree.h"
#include "batten/mesh/component_volumes.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/self_intersections.h"
#include "batten/mesh/triangulate.h"
#include "batten/mesh/vertex_normals.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/volume/inside_volume.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/recursive_filter.h"

namespace batten {

Mesh surface_of_faces(const Topology& topology, const Scheme& scheme, const Mesh& control, std::int64_t least) {
  int levels = 1;
  for (std::int64_t faces = 4 * std::int64_t{topology.face_count()}; faces < least; faces *= 4) ++levels;
  return surface_mesh(topology, scheme, control, levels);
}

SurfaceMeasures measure_surface(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                const Progress& progress) {
  SurfaceMeasures measures;
  measures.fine = triangulated(surface_of_faces(topology, scheme, control, kMeasuredFaces));
  report_progress(progress, 0.3);
  const Topology fine(measures.fine, progress_within(progress, 0.3, 0.5));
  measures.area = surface_area(fine, measures.fine.points);
  measures.volume = component_volumes(fine, measures.fine.points).sum();
  measures.self_intersections =
      find_self_intersections(fine, measures.fine.points, progress_within(progress, 0.5, 1.0)).count;
  return measures;
}

namespace {

/// Outward normals of length 1 at the vertices.
Points normals_of(const Mesh& fine) { return angle_weighted_normals(Topology(fine), fine.points); }

/// From each point to the nearest vertex of a fine mesh, along its normal.
Scalars plane_distances(const Points& points, const Points& onto, const Points& normals) {
  const PointTree tree(onto);
  Scalars distances(points.rows());
  parallel_for(points.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      Index near = 0;
      double square = 0.0;
      tree.nearest(points.row(row), 1, &near, &square);
      distances[row] = std::abs((points.row(row) - onto.row(near)).dot(normals.row(near)));
    }
  });
  return distances;
}

}  // namespace

MaskAgreement compare_with_mask(const Mesh& fine, const Volume& mask) {
  MaskAgreement agreement;
  agreement.dice = dice(inside_volume(fine, mask.grid, VoxelRule::Centre), mask);
  for (const float value : mask.values) agreement.mask_volume += value;
  agreement.mask_volume *= mask.grid.voxel_volume();
  const PointCloud border = mask_border(mask);
  agreement.to_surface = summarize_distances(plane_distances(border.points, fine.points, normals_of(fine)));
  agreement.to_border = summarize_distances(plane_distances(fine.points, border.points, border.normals));
  return agreement;
}

EdgeStrength edge_strength(const Mesh& fine, const Volume& image, double alpha) {
  constexpr int kSteps = 8;  // within two voxels
  // Farther voxels count less than 1e-6 of the nearest where the smoothing is of a few voxels.
  constexpr Index kMargin = 16;
  const Gradient slope = gradient(cropped_around(image, fine.points, kMargin), alpha);
  const Points normals = normals_of(fine);
  const Eigen::Matrix3d to_index = slope.grid.axes.inverse();
  const double voxel = std::cbrt(image.grid.voxel_volume());
  const auto strengths = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      const Eigen::Vector3d normal = normals.row(row).transpose();
      double here = 0.0;
      double best = 0.0;
      for (int step = -kSteps; step <= kSteps; ++step) {
        const Eigen::Vector3d place = fine.points.row(row).transpose() + 2.0 * voxel * step / kSteps * normal;
        const double strength = std::abs(world_gradient(slope, to_index * (place - slope.grid.origin)).dot(normal));
        best = std::max(best, strength);
        if (step == 0) here = strength;
      }
      sum += Eigen::Vector2d(here, best);
    }
    return sum;
  };
  const Eigen::Vector2d sum =
      parallel_reduce(fine.points.rows(), Eigen::Vector2d(0.0, 0.0), strengths,
                      [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return Eigen::Vector2d(a + b); }) /
      static_cast<double>(std::max<Eigen::Index>(1, fine.points.rows()));
  return {sum[0], sum[1]};
}

}  // namespace batten
