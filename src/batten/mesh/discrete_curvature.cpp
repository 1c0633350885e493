#include "batten/mesh/discrete_curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/mesh/face_triangles.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Sums over the triangles around a vertex.
struct RingSums {
  Eigen::Vector3d laplacian = Eigen::Vector3d::Zero();  ///< sum_j (cot + cot) / 2 (x - x_j): 2 H n times the area
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double voronoi = 0.0;
  double mixed = 0.0;

  void add(const Eigen::Vector3d& to_b, const Eigen::Vector3d& to_c) {
    const TriangleCotangents cot = triangle_cotangents(to_b, to_c);
    const double largest = std::abs(cot.origin) + std::abs(cot.b) + std::abs(cot.c);
    if (!(cot.twice_area > 0.0) || !std::isfinite(largest)) return;
    laplacian -= 0.5 * (cot.c * to_b + cot.b * to_c);
    normal += to_b.cross(to_c);
    const double share = (cot.c * to_b.squaredNorm() + cot.b * to_c.squaredNorm()) / 8.0;
    voronoi += share;
    if (cot.origin < 0.0) {
      mixed += cot.twice_area / 4.0;
    } else if (cot.b < 0.0 || cot.c < 0.0) {
      mixed += cot.twice_area / 8.0;
    } else {
      mixed += share;
    }
  }

  /// NaN if there is no area or no normal.
  double mean_curvature() const {
    const double length = normal.norm();
    if (!(mixed > 0.0 && length > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    return laplacian.dot(normal) / (2.0 * length * std::max(voronoi, 0.5 * mixed));
  }
};

/// True on a boundary, at a hole, and where the surface is not smooth.
bool is_left_out(const Topology& topology, Index v) {
  if (topology.is_boundary_vertex(v) || topology.vertex_sharpness(v) > 0.0F) return true;
  bool sharp = false;
  if (!topology.has_creases() && !topology.has_holes()) return sharp;
  topology.for_each_outgoing(v, [&](Index h) {
    sharp = sharp || topology.is_hole(topology.face(h)) || topology.edge_sharpness(topology.edge(h)) > 0.0F;
  });
  return sharp;
}

Eigen::Vector3d row_of(ConstValuesRef points, Index v) { return {points(v, 0), points(v, 1), points(v, 2)}; }

void require_points(const Topology& topology, ConstValuesRef points) {
  require_vertex_rows(topology, points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "curvature needs points of three columns");
}

/// The integral of the squared gradient over a triangle: half of the sum of cotangents times squared differences.
double squared_gradient(const TriangleCotangents& cot, double at_origin, double at_b, double at_c) {
  const double from_origin = at_b - at_c;
  const double from_b = at_c - at_origin;
  const double from_c = at_origin - at_b;
  return 0.5 * (cot.origin * from_origin * from_origin + cot.b * from_b * from_b + cot.c * from_c * from_c);
}

}  // namespace

DiscreteCurvature discrete_curvature(const Topology& topology, ConstValuesRef points, const Progress& progress) {
  require_points(topology, points);
  if (!points.allFinite()) throw Error(ErrorCode::NotFinite, "the points hold a number that is not finite");
  const FaceTriangles triangles(topology, points);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  DiscreteCurvature curvature{Scalars::Constant(topology.vertex_count(), nothing),
                              Scalars::Zero(topology.vertex_count())};
  parallel_for(
      topology.vertex_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          if (topology.is_isolated(v)) continue;
          const Eigen::Vector3d here = row_of(points, v);
          RingSums sums;
          topology.for_each_outgoing(v, [&](Index h) {
            if (topology.is_hole(topology.face(h))) return;
            triangles.at_corner(
                h, [&](Index b, Index c) { sums.add(row_of(points, b) - here, row_of(points, c) - here); });
          });
          curvature.area[v] = sums.mixed;
          if (!is_left_out(topology, v)) curvature.mean[v] = sums.mean_curvature();
        }
      },
      kDefaultBlock, progress);
  return curvature;
}

Fairness fairness(const Topology& topology, ConstValuesRef points, const DiscreteCurvature& curvature,
                  const Progress& progress) {
  require_points(topology, points);
  require_vertex_rows(topology, curvature.mean);
  require_vertex_rows(topology, curvature.area);
  const FaceTriangles triangles(topology, points);
  const auto add = [](const Fairness& a, const Fairness& b) {
    return Fairness{a.bending + b.bending, a.variation + b.variation, a.area + b.area, a.left_out + b.left_out};
  };
  const Fairness bent = parallel_reduce(
      topology.vertex_count(), Fairness{},
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Fairness sum;
        for (std::ptrdiff_t v = begin; v < end; ++v) {
          const double mean = curvature.mean[v];
          if (std::isnan(mean)) {
            ++sum.left_out;
          } else {
            sum.bending += mean * mean * curvature.area[v];
          }
        }
        return sum;
      },
      add, kDefaultBlock, progress_within(progress, 0.0, 0.5));
  const Fairness varied = parallel_reduce(
      topology.face_count(), Fairness{},
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Fairness sum;
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          if (topology.is_hole(f)) continue;
          for (Index k = 0; k + 2 < topology.face_size(f); ++k) {
            const std::array<Index, 3> corners = triangles.vertices(f, k);
            const Eigen::Vector3d origin = row_of(points, corners[0]);
            const TriangleCotangents cot =
                triangle_cotangents(row_of(points, corners[1]) - origin, row_of(points, corners[2]) - origin);
            sum.area += 0.5 * cot.twice_area;
            const double energy = squared_gradient(cot, curvature.mean[corners[0]], curvature.mean[corners[1]],
                                                   curvature.mean[corners[2]]);
            if (std::isfinite(energy)) sum.variation += energy;
          }
        }
        return sum;
      },
      add, kDefaultBlock, progress_within(progress, 0.5, 1.0));
  Fairness all = add(bent, varied);
  all.variation *= all.area;
  return all;
}

}  // namespace batten
