#include "batten/limit/curvature.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Least squares for S = (a b; b c) in the plane across `normal`, each neighbour weighted by its distance to the -2.
class ShapeFit {
 public:
  explicit ShapeFit(const Vector3d& normal) : side_(normal.unitOrthogonal()), rise_(normal.cross(side_)) {}

  void add(const Vector3d& step, const Vector3d& turn) {
    const Vector2d d(side_.dot(step), rise_.dot(step));
    const Vector2d t(side_.dot(turn), rise_.dot(turn));
    const double square = d.squaredNorm();
    if (!(square > 0.0)) return;
    // S d = (a x + b y, b x + c y) = t
    const Vector3d first(d.x(), d.y(), 0.0);
    const Vector3d second(0.0, d.x(), d.y());
    products_ += (first * first.transpose() + second * second.transpose()) / square;
    right_ += (first * t.x() + second * t.y()) / square;
  }

  /// False where the neighbours lie along one line.
  bool solve(double& mean, double& gaussian) const {
    constexpr double kSmallest = 1e-6;
    const double scale = products_.trace();
    if (!(products_.determinant() > kSmallest * scale * scale * scale)) return false;
    const Vector3d s = products_.inverse() * right_;
    mean = 0.5 * (s[0] + s[2]);
    gaussian = s[0] * s[2] - s[1] * s[1];
    return true;
  }

 private:
  Vector3d side_;
  Vector3d rise_;
  Matrix3d products_ = Matrix3d::Zero();
  Vector3d right_ = Vector3d::Zero();
};

}  // namespace

Curvature estimate_curvature(const Topology& topology, ConstValuesRef points, ConstValuesRef corner_normals) {
  require_vertex_rows(topology, points);
  if (points.cols() != 3 || corner_normals.cols() != 3 || corner_normals.rows() != topology.half_edge_count())
    throw Error(ErrorCode::BadShape, "curvature needs V-by-3 points and one normal of 3 numbers for each half-edge");
  constexpr double kSameSide = 0.999;  // cosine between the normals at a vertex that count as one
  const double none = std::numeric_limits<double>::quiet_NaN();
  Curvature curvature{Eigen::VectorXd::Constant(points.rows(), none), Eigen::VectorXd::Constant(points.rows(), none)};
  const auto point = [&](Index v) { return Vector3d(points.row(v).transpose()); };
  const auto normal = [&](Index h) { return Vector3d(corner_normals.row(h).transpose()); };
  parallel_for(topology.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      Index start = -1;
      if (!topology.is_isolated(v)) {
        topology.for_each_outgoing(
            v, [&](Index h) { start = start < 0 && !topology.is_hole(topology.face(h)) ? h : start; });
      }
      if (start < 0 || normal(start).squaredNorm() < 0.5) continue;
      const Vector3d here = normal(start);
      ShapeFit fit(here);
      topology.for_each_outgoing(v, [&](Index h) {
        if (topology.is_hole(topology.face(h)) || normal(h).dot(here) < kSameSide) return;
        for (Index i = topology.next(h); i != h; i = topology.next(i)) {
          if (normal(i).squaredNorm() > 0.5) fit.add(point(topology.origin(i)) - point(v), normal(i) - here);
        }
      });
      fit.solve(curvature.mean[v], curvature.gaussian[v]);
    }
  });
  return curvature;
}

}  // namespace batten
