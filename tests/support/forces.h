/// \file What a force does to the control points, and whether it is minus the gradient of its energy.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "batten/dynamics/force.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"
#include "support/values.h"

namespace batten::test {

inline ElasticSurface body_of(const Mesh& mesh, const Scheme& scheme = {}) {
  return ElasticSurface(Topology(mesh), scheme, mesh.points);
}

/// A flat square of area 4: its boundary curve has the corners of the grid.
inline ElasticSurface square_of(const Mesh& mesh) {
  Scheme scheme;
  scheme.boundary = BoundaryRule::EdgeAndCorner;
  return body_of(mesh, scheme);
}

/// A ball of quads: its control points, 98 of them, on the unit sphere.
inline Mesh quad_ball() {
  Mesh mesh = cube();
  for (int level = 0; level < 2; ++level) {
    const Topology topology(mesh);
    const Refinement refinement(topology, Scheme{});
    const Points points = refinement.apply(mesh.points);
    mesh = mesh_from_topology(refinement.child());
    mesh.points = points;
  }
  mesh.points.rowwise().normalize();
  return mesh;
}

/// How a force sees a motion without changes of its own.
struct Motion {
  Points start;
  Points positions;
  Points velocities;
  double time = 0.0;
  double step = 0.0;

  ForceInput input() const { return {time, step, start, positions, velocities}; }
};
inline Motion still_at(const Points& positions) { return {positions, positions, Points::Zero(positions.rows(), 3)}; }
/// The motion of a step that ends at `positions`.
inline Motion moving(const Points& positions, const Points& velocities, double step) {
  return {positions - step * velocities, positions, velocities, step, step};
}

inline ForceSum sum_of(const Force& force, const Motion& motion) {
  ForceSum sum;
  sum.force = Points::Zero(motion.positions.rows(), 3);
  force.add(motion.input(), sum);
  return sum;
}

/// What acts on the control points, springs included.
inline Points force_of(const Force& force, const Motion& motion) {
  ForceSum sum = sum_of(force, motion);
  for (const PlaceSprings& springs : sum.springs) {
    Values stretch = springs.targets - Points(springs.rows->rows * motion.positions);
    turn_into_forces(springs, stretch);
    sum.force += springs.rows->transposed * stretch;
  }
  return sum.force;
}

inline Eigen::Vector3d total(const Points& forces) { return forces.colwise().sum().transpose(); }
inline Eigen::Vector3d torque(const Points& positions, const Points& forces) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    sum += Eigen::Vector3d(positions.row(v)).cross(Eigen::Vector3d(forces.row(v)));
  }
  return sum;
}

/// Central differences of h = 1e-4 leave h^2 of the third derivative, and rounding of 1e-16 / h.
inline void expect_minus_gradient(const Force& force, const Points& positions, double tolerance = 1e-6) {
  constexpr double kStep = 1e-4;
  const Points forces = force_of(force, still_at(positions));
  for (const double sign : {1.0, -1.0}) {
    Points way = random_values(static_cast<Index>(positions.rows()), 3);
    if (sign < 0.0) way = way.colwise().reverse().eval();
    const double ahead = sum_of(force, still_at(positions + kStep * way)).energy;
    const double behind = sum_of(force, still_at(positions - kStep * way)).energy;
    EXPECT_NEAR((ahead - behind) / (2.0 * kStep), -forces.cwiseProduct(way).sum(),
                tolerance * (1.0 + forces.norm() * way.norm()))
        << force.name();
  }
}

/// The body's refinement has a force with the same sum and the same torque.
inline void expect_same_when_refined(const Force& force, const ElasticSurface& body, const Motion& motion,
                                     double tolerance) {
  const ElasticSurface child = body.refined();
  const Refinement refinement(body.topology(), body.patches().scheme());
  const Motion finer{refinement.apply(motion.start), refinement.apply(motion.positions),
                     refinement.apply(motion.velocities), motion.time, motion.step};
  const std::shared_ptr<const Force> refined = force.refined(body, child);
  const Points coarse_forces = force_of(force, motion);
  const Points fine_forces = force_of(*refined, finer);
  const double scale = tolerance * coarse_forces.cwiseAbs().sum();
  EXPECT_GT(coarse_forces.norm(), 0.0) << force.name();
  EXPECT_NEAR((total(fine_forces) - total(coarse_forces)).norm(), 0.0, scale) << force.name();
  EXPECT_NEAR((torque(finer.positions, fine_forces) - torque(motion.positions, coarse_forces)).norm(), 0.0, scale)
      << force.name();
}

}  // namespace batten::test
