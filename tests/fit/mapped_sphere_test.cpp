#include "batten/fit/mapped_sphere.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/fit/fit_surface.h"
#include "batten/fit/sphere_map.h"
#include "batten/fit/start_sphere.h"
#include "batten/mesh/primitives.h"
#include "batten/nearest/nearest_point.h"
#include "batten/refine/refinement.h"
#include "fit/clouds.h"

namespace batten {
namespace {

using test::CloudMaker;

Mesh fine_octahedron(int levels) {
  const Mesh solid = octahedron();
  Scheme loop;
  loop.kind = SchemeKind::Loop;
  const RefinedSurface fine = refine(Topology(solid), loop, solid.points, levels);
  Mesh mesh = mesh_from_topology(fine.topology);
  mesh.points = fine.values;
  mesh.points.rowwise().normalize();
  return mesh;
}

/// The unit sphere with an ear: a cone that is as long as it is wide, with a round tip.
Eigen::RowVector3d with_ear(Eigen::RowVector3d place) {
  constexpr double kBase = 0.8;
  constexpr double kLength = 1.2;
  const double share = (place(2) - kBase) / (1.0 - kBase);
  if (share < 0.0) return place;
  const double narrow = 0.5 + 0.5 * (1.0 - share) * (1.0 - share);
  return {narrow * place(0), narrow * place(1), kBase + kLength * share};
}

double determinant(const Mesh& mesh, const Points& points, Index face) {
  const Index* const corners = mesh.face_vertices.data() + mesh.face_offsets[face];
  const Eigen::RowVector3d a = points.row(corners[0]);
  const Eigen::RowVector3d b = points.row(corners[1]);
  const Eigen::RowVector3d c = points.row(corners[2]);
  return a.dot(b.cross(c));
}

double area(const Mesh& mesh, const Points& points, Index face) {
  const Index* const corners = mesh.face_vertices.data() + mesh.face_offsets[face];
  const Eigen::RowVector3d a = points.row(corners[0]);
  return 0.5 * (points.row(corners[1]) - a).cross(points.row(corners[2]) - a).norm();
}

TEST(SphereMap, TurnsNoTriangleOver) {
  Mesh mesh = fine_octahedron(4);
  for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.points.row(v) = with_ear(mesh.points.row(v));
  const SphereMap map(mesh);
  EXPECT_EQ(map.turned_triangles(), 0);
  for (Index f = 0; f < mesh.face_count(); ++f) EXPECT_GT(determinant(mesh, map.directions(), f), 0.0) << f;
  EXPECT_NEAR(map.directions().rowwise().norm().minCoeff(), 1.0, 1e-12);
}

/// Without stretch, up to the finite size of triangles and where relaxation ends.
TEST(SphereMap, LaysASphereOnItselfEvenly) {
  const Mesh mesh = fine_octahedron(3);
  SphereMap map(mesh);
  map.relax(Scalars::Ones(mesh.vertex_count()), 60);
  for (Index f = 0; f < mesh.face_count(); ++f)
    EXPECT_NEAR(area(mesh, map.directions(), f) / area(mesh, mesh.points, f), 1.0, 0.25) << f;
}

TEST(SphereMap, GivesAnEarItsPartOfTheSphere) {
  Mesh mesh = fine_octahedron(4);
  const Points before = mesh.points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.points.row(v) = with_ear(mesh.points.row(v));
  SphereMap map(mesh);
  map.relax(Scalars::Ones(mesh.vertex_count()), 20);
  double of_surface = 0.0;
  double of_sphere = 0.0;
  double surface = 0.0;
  double sphere = 0.0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    surface += area(mesh, mesh.points, f);
    sphere += area(mesh, map.directions(), f);
    if (mesh.points(mesh.face_vertices[mesh.face_offsets[f]], 2) <= 1.0) continue;
    of_surface += area(mesh, mesh.points, f);
    of_sphere += area(mesh, map.directions(), f);
  }
  ASSERT_GT(of_surface, 0.04 * surface) << "the ear";
  EXPECT_GT(of_sphere / sphere, 0.5 * of_surface / surface);
  EXPECT_LT(of_sphere / sphere, 2.0 * of_surface / surface);
}

TEST(SphereMap, GivesDenserPlacesALargerPart) {
  const Mesh mesh = fine_octahedron(3);
  Scalars density = Scalars::Ones(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) density[v] = mesh.points(v, 2) > 0.0 ? 3.0 : 1.0;
  SphereMap map(mesh);
  map.relax(density, 60);
  double upper = 0.0;
  double all = 0.0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    double height = 0.0;
    for (int c = 0; c < 3; ++c) height += mesh.points(mesh.face_vertices[mesh.face_offsets[f] + c], 2);
    all += area(mesh, map.directions(), f);
    if (height > 0.0) upper += area(mesh, map.directions(), f);
  }
  EXPECT_GT(upper / all, 0.6) << "three quarters where triangles were small and relaxation without end";
}

PointCloud eared_cloud() {
  Points points = CloudMaker().sphere(3000);
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = with_ear(points.row(i));
  return {points, estimate_normals(points)};
}

TEST(MappedSphere, ReachesIntoAnEar) {
  const PointCloud cloud = eared_cloud();
  const std::optional<Mesh> mesh = mapped_sphere(cloud, SchemeKind::CatmullClark, 386);
  ASSERT_TRUE(mesh.has_value());
  EXPECT_EQ(mesh->face_vertices, unit_sphere(SchemeKind::CatmullClark, 386).face_vertices) << "the sphere's order";
  EXPECT_EQ(mesh->vertex_count(), 386);
  const NearestPoints nearest(Topology(*mesh), Scheme(), mesh->points);
  std::vector<NearestPoint> found(static_cast<std::size_t>(cloud.points.rows()));
  nearest.nearest(cloud.points, found);
  double greatest = 0.0;
  for (const NearestPoint& point : found) greatest = std::max(greatest, point.distance);
  EXPECT_LT(greatest, 0.1) << "the ear is 1.2 long";
}

TEST(MappedSphere, TakesOnlyWhatIsLikeASphere) {
  const Points torus = CloudMaker().torus(1500);
  EXPECT_FALSE(mapped_sphere({torus, estimate_normals(torus)}, SchemeKind::CatmullClark, 386).has_value());
  PointCloud few;
  few.points = cube().points;
  few.normals = cube().points.rowwise().normalized();
  EXPECT_FALSE(mapped_sphere(few, SchemeKind::CatmullClark, 386).has_value()) << "too few points for a surface";
}

TEST(MappedSphere, LetsAFitReachAnEar) {
  FitOptions options;
  options.vertices = 386;
  options.start = FitStart::Sphere;
  const FitResult fit = fit_surface({eared_cloud().points, Points(0, 3)}, options);
  EXPECT_EQ(fit.topology.vertex_count(), 386);
  EXPECT_EQ(fit.report.unsound, 0);
  EXPECT_LT(fit.report.to_surface.max, 0.02 * fit.report.diameter);
}

}  // namespace
}  // namespace batten
