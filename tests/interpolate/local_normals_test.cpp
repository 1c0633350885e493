#include "batten/interpolate/local_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "batten/energy/surface_energy.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/parallel/threads.h"
#include "batten/refine/refined_mesh.h"
#include "batten/solve/solver.h"
#include "support/errors.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr TurnOptions kUnrelaxed{0.0, false};
constexpr double kRing = 1e-12;  ///< rounding of normals: rings are some hundredths of these meshes, and doubles 1e-16

/// Directions that have nothing to do with the mesh.
Values random_directions(Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Values directions(count, 3);
  for (double& number : directions.reshaped()) number = normal(random);
  return directions;
}

/// The limit normals nudged by some tenths.
Values nudged_normals(const Topology& topology, const Scheme& scheme, const Values& control, double amount) {
  return limit_normals(topology, scheme, control).vertices + amount * random_directions(topology.vertex_count(), 3);
}

/// The angles between wanted and limit normals by limit_normals(), which shares no code path with what turns.
Scalars angles_of(const TurnedSurface& surface, const Values& wanted) {
  const Values normals = limit_normals(surface.topology, surface.scheme, surface.control).vertices;
  Scalars angles(wanted.rows());
  for (Index v = 0; v < static_cast<Index>(wanted.rows()); ++v)
    angles(v) = angle_between(wanted.row(v), normals.row(v));
  return angles;
}

double greatest_shift(const TurnedSurface& surface, const Values& before) {
  const Values limits = LimitMatrix(surface.topology, surface.scheme).apply(surface.control);
  return (limits.topRows(before.rows()) - before).rowwise().norm().maxCoeff();
}

struct Solved {
  Topology topology;
  Scheme scheme;
  Values control;
};
/// The surface through the points of a mesh.
Solved through(const Mesh& mesh, const Scheme& scheme = {}) {
  const Interpolant solved = Interpolator(Topology(mesh), scheme).solve(mesh.points);
  return {solved.topology, solved.scheme, solved.control};
}

TurnedSurface turned(const Solved& solved, const Values& wanted, const TurnOptions& options = kUnrelaxed) {
  return turn_normals(solved.topology, solved.scheme, solved.control, wanted, options);
}

/// A sphere of quads through the refined cube's vertices.
Mesh quad_sphere(int levels) {
  const Mesh start = cube();
  const RefinedSurface fine = refine(Topology(start), {}, start.points, levels);
  Mesh mesh = mesh_from_topology(fine.topology);
  mesh.points = fine.values.rowwise().normalized();
  return mesh;
}

/// A cylinder around the z axis, open at both ends, with uneven rings so that its normals are not right by symmetry.
Mesh open_cylinder(Index around, Index rings) {
  Mesh mesh;
  mesh.points.resize(around * rings, 3);
  for (Index j = 0; j < rings; ++j) {
    for (Index i = 0; i < around; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.2 * std::sin(2.0 * i)) / around;
      mesh.points.row(j * around + i) << std::cos(angle), std::sin(angle), 0.4 * j + 0.05 * j * j;
      const Index next = (i + 1) % around;
      if (j > 0) mesh.add_face({(j - 1) * around + i, (j - 1) * around + next, j * around + next, j * around + i});
    }
  }
  return mesh;
}

Values radial_directions(const Mesh& mesh) {
  Values directions = mesh.points;
  directions.col(2).setZero();
  return directions;
}

TEST(TurnNormals, KeepsLimitPositionsAndReachesNormalsOnAnyMesh) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(mesh);
    const Values before = LimitMatrix(topology, scheme).apply(mesh.points);
    const Values wanted = random_directions(mesh.vertex_count(), 1);
    const TurnedSurface surface = turn_normals(topology, scheme, mesh.points, wanted);
    EXPECT_LT(greatest_shift(surface, before), 1e-13 * bounding_diagonal(mesh.points)) << name;
    const TurnCounts& counts = surface.report.counts;
    EXPECT_EQ(counts.turned + counts.skipped(), mesh.vertex_count()) << name;
    const Scalars angles = angles_of(surface, wanted);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (std::isnan(surface.report.after(v))) continue;
      EXPECT_LT(angles(v), kRing) << name << ", vertex " << v;
    }
  });
}

TEST(TurnNormals, MakesASpheresNormalsRadial) {
  const Mesh mesh = quad_sphere(2);
  const TurnedSurface surface = turned(through(mesh), mesh.points);
  EXPECT_GT(surface.report.before_angle.max, 1e-3);
  EXPECT_LT(angles_of(surface, mesh.points).maxCoeff(), 1e-13);
  EXPECT_LT(greatest_shift(surface, mesh.points), 1e-10 * bounding_diagonal(mesh.points));  // of the interpolation
}

TEST(TurnNormals, MakesATorusNormalsThoseOfItsTube) {
  const Mesh mesh = torus(7, 5);
  Values wanted = mesh.points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double distance = std::hypot(wanted(v, 0), wanted(v, 1));
    wanted.row(v).head(2) *= (distance - 1.0) / distance;
  }
  EXPECT_LT(angles_of(turned(through(mesh), wanted), wanted).maxCoeff(), 1e-13);
}

TEST(TurnNormals, TurnsAboutTheBoundaryCurveOfACylinder) {
  const Mesh mesh = open_cylinder(7, 4);
  const Solved solved = through(mesh);
  const Values wanted = radial_directions(mesh);
  const RefinedSurface plain = refine(solved.topology, solved.scheme, solved.control, 2);
  const TurnedSurface surface = turned(solved, wanted);
  EXPECT_LT(angles_of(surface, wanted).maxCoeff(), kRing);
  EXPECT_EQ(surface.report.counts.boundary, 14);
  // Interpolated rings of points are plane curves, so that at most the tilt out of their planes moves them.
  const LimitMatrix limit(surface.topology, surface.scheme);
  for (Index v = 0; v < 7; ++v) {
    const auto [a, b] = limit.curve_neighbours(v);
    const Eigen::RowVector3d before = plain.values.row(a) - plain.values.row(b);
    const Eigen::RowVector3d after = surface.control.row(a) - surface.control.row(b);
    const Eigen::RowVector3d radial = mesh.points.row(v).normalized();
    // What lies in the tangent plane wanted stays; only what points out of it has to turn.
    EXPECT_LT(std::abs(after.dot(radial)), kRing);
    EXPECT_LT(angle_between(before, after), 1.01 * std::abs(std::asin(before.normalized().dot(radial))) + kRing);
  }
}

TEST(TurnNormals, KeepsABoundaryTangentThatIsPerpendicularToTheWantedNormal) {
  const Mesh mesh = test::jittered(grid(4, 3), 0.05, 7);
  const Solved solved{Topology(mesh), {}, mesh.points};
  const RefinedSurface plain = refine(solved.topology, solved.scheme, solved.control, 2);
  const auto [a, b] = LimitMatrix(plain.topology, solved.scheme).curve_neighbours(2);
  const Eigen::RowVector3d tangent = plain.values.row(a) - plain.values.row(b);
  Values wanted = Values::Zero(mesh.vertex_count(), 3);
  wanted.row(2) = Eigen::RowVector3d(0.3, 0.6, 0.5).cross(tangent);
  const TurnedSurface surface = turned(solved, wanted);
  EXPECT_EQ(surface.report.counts.boundary, 1);
  EXPECT_LT(surface.report.after(2), kRing);
  EXPECT_LT(angle_between(tangent, surface.control.row(a) - surface.control.row(b)), kRing);
}

TEST(TurnNormals, ChangesNoBitWhereTheNormalsAreRight) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(mesh);
    const RefinedSurface plain = refine(topology, scheme, mesh.points, 2);
    const Values right = limit_normals(plain.topology, scheme, plain.values).vertices.topRows(mesh.vertex_count());
    const TurnedSurface surface = turn_normals(topology, scheme, mesh.points, right);
    EXPECT_EQ(surface.control, plain.values) << name;
    EXPECT_EQ(surface.report.counts.turned, 0) << name;
  });
}

TEST(TurnNormals, TurnsNoFartherThanToTheTolerance) {
  const Mesh mesh = torus(6, 5);
  const Solved solved = through(mesh);
  const Values wanted = nudged_normals(solved.topology, solved.scheme, solved.control, 0.2);
  const double tolerance = 0.15;
  const TurnedSurface surface = turned(solved, wanted, {tolerance, false});
  const Scalars angles = angles_of(surface, wanted);
  EXPECT_GT(surface.report.counts.kept, 0);
  EXPECT_GT(surface.report.counts.turned, 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_NEAR(angles(v), std::min(surface.report.before(v), tolerance), 1e-13);
}

TEST(TurnNormals, TurnsInThePlaneOfBothNormals) {
  const Mesh mesh = torus(6, 5);
  const Solved solved = through(mesh);
  const Values wanted = nudged_normals(solved.topology, solved.scheme, solved.control, 0.3);
  const RefinedSurface plain = refine(solved.topology, solved.scheme, solved.control, 2);
  const Values normals = limit_normals(plain.topology, solved.scheme, plain.values).vertices;
  const Values limits = LimitMatrix(plain.topology, solved.scheme).apply(plain.values);
  const TurnedSurface surface = turned(solved, wanted);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    // The smallest rotation leaves what lies along its axis.
    const Eigen::RowVector3d axis = Eigen::RowVector3d(normals.row(v)).cross(Eigen::RowVector3d(wanted.row(v)));
    surface.topology.for_each_outgoing(v, [&](Index h) {
      const Index w = surface.topology.destination(h);
      const Eigen::RowVector3d before = plain.values.row(w) - limits.row(v);
      const Eigen::RowVector3d after = surface.control.row(w) - limits.row(v);
      EXPECT_NEAR(before.norm(), after.norm(), 1e-14);
      EXPECT_NEAR(before.dot(axis), after.dot(axis), 1e-14);
    });
  }
}

TEST(TurnNormals, TurnsOppositeNormalsAboutATangent) {
  const Mesh mesh = torus(6, 5);
  const Topology topology(mesh);
  const RefinedSurface plain = refine(topology, {}, mesh.points, 2);
  const Values wanted = -limit_normals(plain.topology, {}, plain.values).vertices.topRows(mesh.vertex_count());
  const TurnedSurface surface = turn_normals(topology, {}, mesh.points, wanted, kUnrelaxed);
  EXPECT_EQ(surface.report.counts.antiparallel, mesh.vertex_count());
  EXPECT_EQ(surface.report.counts.opposed, mesh.vertex_count());
  EXPECT_LT(angles_of(surface, wanted).maxCoeff(), kRing);
  EXPECT_LT(greatest_shift(surface, LimitMatrix(topology, {}).apply(mesh.points)), 1e-13);
}

TEST(TurnNormals, LeavesVerticesWithoutAWantedNormal) {
  const Mesh mesh = torus(6, 5);
  Values wanted = Values::Zero(mesh.vertex_count(), 3);
  wanted.row(7) << 1.0, 2.0, 3.0;
  const TurnedSurface surface = turn_normals(Topology(mesh), {}, mesh.points, wanted, kUnrelaxed);
  const RefinedSurface plain = refine(Topology(mesh), {}, mesh.points, 2);
  EXPECT_EQ(surface.report.counts.unwanted, mesh.vertex_count() - 1);
  Index moved = 0;
  for (Index v = 0; v < surface.topology.vertex_count(); ++v) {
    if (surface.control.row(v) != plain.values.row(v)) ++moved;
  }
  EXPECT_EQ(moved, 9);  // a regular vertex and the eight around it
}

TEST(TurnNormals, SkipsInfiniteCreasesAndTurnsFadingOnes) {
  for (const double sharpness : {10.0, 2.5}) {
    Mesh mesh = torus(6, 5);
    for (Index i = 0; i < 6; ++i) mesh.creases.push_back({5 * i, 5 * ((i + 1) % 6), sharpness});
    const Topology topology(mesh);
    const Values wanted = random_directions(mesh.vertex_count(), 5);
    const Values before = LimitMatrix(topology, {}).apply(mesh.points);
    const TurnedSurface surface = turn_normals(topology, {}, mesh.points, wanted);
    EXPECT_EQ(surface.report.counts.crease, sharpness == 10.0 ? 6 : 0);
    EXPECT_LT(greatest_shift(surface, before), 1e-13);
    const Scalars angles = angles_of(surface, wanted);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (sharpness < 10.0 || v % 5 != 0) {
        EXPECT_LT(angles(v), kRing) << v;
      }
    }
  }
}

TEST(TurnNormals, KeepsLimitPositionsUnderRandomTags) {
  const Mesh mesh = test::with_random_tags(torus(7, 5), 11);
  for (const CreaseMethod method : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
    Scheme scheme;
    scheme.crease_method = method;
    const Topology topology(mesh);
    const Values before = LimitMatrix(topology, scheme).apply(mesh.points);
    const Values wanted = random_directions(mesh.vertex_count(), 5);
    const TurnedSurface surface = turn_normals(topology, scheme, mesh.points, wanted);
    EXPECT_LT(greatest_shift(surface, before), 1e-13);
    EXPECT_LT(surface.report.after_angle.max, kRing);
    EXPECT_GT(surface.report.counts.turned, 0);
  }
}

TEST(TurnNormals, CountsWhatHasNoNormal) {
  const Mesh two = test::dihedron(5);
  const Values up = Eigen::RowVector3d(0.0, 0.0, 1.0).replicate(20, 1);
  EXPECT_EQ(turn_normals(Topology(two), {}, two.points, up.topRows(5)).report.counts.valence_two, 5);
  const Mesh open = grid(4, 3);
  const auto counts_of = [&](BoundaryRule boundary) {
    const Scheme scheme = test::scheme_of(SchemeKind::CatmullClark, boundary);
    return turn_normals(Topology(open), scheme, test::jittered(open, 0.05, 3).points, up).report.counts;
  };
  EXPECT_EQ(counts_of(BoundaryRule::EdgeAndCorner).corner, 4);
  EXPECT_EQ(counts_of(BoundaryRule::EdgeOnly).turned, 20);
  EXPECT_EQ(counts_of(BoundaryRule::None).outside, 14);
  EXPECT_EQ(counts_of(BoundaryRule::None).turned, 6);
  const Mesh flat = torus(4, 4);
  const Values point = Values::Constant(16, 3, 0.5);
  EXPECT_EQ(turn_normals(Topology(flat), {}, point, up.topRows(16)).report.counts.degenerate, 16);
}

TEST(TurnNormals, RelaxingBendsLessAndTellsTheEnergies) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(mesh);
    const Values wanted = nudged_normals(topology, scheme, mesh.points, 0.2);
    const TurnedSurface plain = turn_normals(topology, scheme, mesh.points, wanted, kUnrelaxed);
    const TurnedSurface relaxed = turn_normals(topology, scheme, mesh.points, wanted);
    if (relaxed.report.counts.turned == 0) return;
    const Values before = refine(topology, scheme, mesh.points, 2).values;
    const SurfaceEnergy measured(relaxed.topology, relaxed.scheme);
    const auto bending = [&](const Values& values) { return measured.energy(EnergyKind::ThinPlate, values); };
    EXPECT_LT(bending(relaxed.control - before), bending(plain.control - before)) << name;
    const TurnEnergy& energy = relaxed.report.energy;
    // K's own rounding, of two ways to sum it.
    EXPECT_NEAR(bending(before), energy.before, 1e-9 * energy.turned) << name;
    EXPECT_NEAR(bending(plain.control), energy.turned, 1e-9 * energy.turned) << name;
    EXPECT_NEAR(bending(relaxed.control), energy.relaxed, 1e-9 * energy.turned) << name;
  });
}

TEST(TurnNormals, RelaxedDisplacementBendsLeast) {
  const Mesh mesh = torus(6, 5);
  const Topology topology(mesh);
  const Values wanted = nudged_normals(topology, {}, mesh.points, 0.2);
  const RefinedSurface before = refine(topology, {}, mesh.points, 2);
  const TurnedSurface plain = turn_normals(topology, {}, mesh.points, wanted, kUnrelaxed);
  const TurnedSurface relaxed = turn_normals(topology, {}, mesh.points, wanted);
  const SurfaceEnergy energy(before.topology, {});
  const auto gradient = [&](const TurnedSurface& surface) {
    Values result(before.values.rows(), 3);
    energy.apply(EnergyKind::ThinPlate, surface.control - before.values, result);
    return result;
  };
  const Values at_plain = gradient(plain);
  const Values at_relaxed = gradient(relaxed);
  Index free = 0;
  for (Index v = 0; v < before.topology.vertex_count(); ++v) {
    if (plain.control.row(v) != before.values.row(v)) continue;  // in a ring, where limits hold it
    ++free;
    EXPECT_LT(at_relaxed.row(v).norm(), 1e-3 * max_row_norm(at_plain)) << v;  // iterated to 1e-4
  }
  EXPECT_EQ(free, before.topology.vertex_count() - 9 * mesh.vertex_count());
  // Between the two displacements lie others that are allowed.
  const double slope = at_relaxed.cwiseProduct(plain.control - relaxed.control).sum();
  const double start = at_plain.cwiseProduct(plain.control - relaxed.control).sum();
  EXPECT_LT(std::abs(slope), 1e-3 * start);
}

TEST(TurnNormals, RelaxingDiesAwayOverTwoFaces) {
  const Mesh mesh = torus(16, 12);
  Values wanted = Values::Zero(mesh.vertex_count(), 3);
  wanted.row(0) << 1.0, 0.5, 0.3;
  const TurnedSurface surface = turn_normals(Topology(mesh), {}, mesh.points, wanted);
  const RefinedSurface plain = refine(Topology(mesh), {}, mesh.points, 2);
  const Scalars moved = (surface.control - plain.values).rowwise().norm();
  const double face = (mesh.points.row(16) - mesh.points.row(0)).norm();
  for (Index v = 0; v < surface.topology.vertex_count(); ++v) {
    if ((plain.values.row(v) - mesh.points.row(0)).norm() > 3.0 * face) {
      EXPECT_LT(moved(v), 1e-3 * moved.maxCoeff());
    }
  }
}

TEST(TurnNormals, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Mesh mesh = torus(40, 30);
  const Topology topology(mesh);
  const Values wanted = nudged_normals(topology, {}, mesh.points, 0.2);
  const auto control = [&](int threads) {
    const ThreadLimit limit(threads);
    return turn_normals(topology, {}, mesh.points, wanted).control;
  };
  EXPECT_EQ(control(1), control(2));
}

TEST(TurnNormals, CarriesTheAttributesOfAMesh) {
  Mesh mesh = torus(6, 5);
  const Values colors = 0.5 + 0.3 * mesh.points.array().sin();
  mesh.attributes.push_back({"color", colors, {}});
  const Values wanted = random_directions(mesh.vertex_count(), 2);
  InterpolatedMesh surface = interpolate(mesh);
  const TurnReport report = turn_normals(surface, wanted);
  EXPECT_EQ(report.counts.turned, mesh.vertex_count());
  const LimitMatrix limit(surface.topology, surface.scheme);
  const Index count = mesh.vertex_count();
  EXPECT_LT((limit.apply(surface.mesh.points).topRows(count) - mesh.points).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((limit.apply(surface.mesh.attributes[0].values).topRows(count) - colors).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(surface.mesh.face_count(), 16 * mesh.face_count());
}

TEST(TurnNormals, LeavesAMeshAloneWhoseNormalsAreWithinTheTolerance) {
  const Mesh mesh = torus(6, 5);
  InterpolatedMesh surface = interpolate(mesh);
  const Values control = surface.mesh.points;
  const TurnReport report = turn_normals(surface, random_directions(mesh.vertex_count(), 2), {std::numbers::pi, true});
  EXPECT_EQ(Values(surface.mesh.points), control);
  EXPECT_EQ(report.counts.kept, mesh.vertex_count());
}

TEST(TurnNormals, ReachesTheNormalsOfACubeThatAlphaRefines) {
  Mesh mesh = cube();
  mesh.points(0, 0) += 0.3;
  InterpolatedMesh surface = interpolate(mesh);
  ASSERT_TRUE(surface.is_refined);
  const TurnReport report = turn_normals(surface, mesh.points);
  EXPECT_EQ(report.counts.turned + report.counts.kept, 8);
  const Values normals = limit_normals(surface.topology, surface.scheme, surface.mesh.points).vertices;
  for (Index v = 0; v < 8; ++v) EXPECT_LT(angle_between(normals.row(v), mesh.points.row(v)), kRing);
}

TEST(TurnNormals, RefusesWhatItCannotDo) {
  const Mesh mesh = octahedron();
  const Topology topology(mesh);
  const auto code = [&](const Scheme& scheme, const Values& wanted, const TurnOptions& options) {
    return test::error_of([&] { turn_normals(topology, scheme, mesh.points, wanted, options); })->code();
  };
  const Values fine = mesh.points;
  Values broken = fine;
  broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(test::scheme_of(SchemeKind::ModifiedButterfly), fine, {}), ErrorCode::BadArgument);
  EXPECT_EQ(code({}, fine, {-0.1, true}), ErrorCode::BadArgument);
  EXPECT_EQ(code({}, fine, {std::numeric_limits<double>::quiet_NaN(), true}), ErrorCode::BadArgument);
  EXPECT_EQ(code({}, Values::Ones(7, 3), {}), ErrorCode::BadShape);
  EXPECT_EQ(code({}, Values::Ones(6, 2), {}), ErrorCode::BadShape);
  EXPECT_EQ(code({}, broken, {}), ErrorCode::NotFinite);
}

}  // namespace
}  // namespace batten
