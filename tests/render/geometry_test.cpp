#include "batten/render/geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "batten/render/view.h"
#include "render/pixels.h"

namespace batten::render_detail {
namespace {

Triangles triangles_of_mesh(const Mesh& mesh) {
  Scene scene;
  scene.surface = mesh;
  return triangles_of(scene, frame_of({&scene}));
}

Vec facet_normal(const Triangles& triangles, std::size_t t) {
  const Vec& a = triangles.points[triangles.vertices[3 * t]];
  const Vec& b = triangles.points[triangles.vertices[3 * t + 1]];
  const Vec& c = triangles.points[triangles.vertices[3 * t + 2]];
  return (b - a).cross(c - a).normalized();
}

TEST(RenderGeometry, CubeAndDodecahedronStayCrisp) {
  for (const Mesh& mesh : {cube(), dodecahedron()}) {
    const Triangles triangles = triangles_of_mesh(mesh);
    EXPECT_EQ(triangles.count(),
              static_cast<std::size_t>(mesh.face_vertices.size()) - 2 * static_cast<std::size_t>(mesh.face_count()));
    for (std::size_t corner = 0; corner < triangles.vertices.size(); ++corner)
      EXPECT_LT((triangles.normals[triangles.normal_row(corner)] - facet_normal(triangles, corner / 3)).norm(), 1e-6F);
  }
}

TEST(RenderGeometry, SphereIsSmooth) {
  const Triangles triangles = triangles_of_mesh(test::sphere(24, 12));
  EXPECT_TRUE(triangles.normal_rows.empty());
  for (std::size_t v = 0; v + 1 < triangles.points.size(); ++v)
    EXPECT_LT((triangles.normals[v] - triangles.points[v].normalized()).norm(), 0.02F);
}

TEST(RenderGeometry, CylinderIsSmoothAroundAndCrispAtItsLids) {
  const Index n = 24;  // 15 degrees a side
  Mesh mesh;
  mesh.points.resize(2 * n, 3);
  for (Index i = 0; i < n; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / n;
    mesh.points.row(i) << std::cos(turn), std::sin(turn), -1.0;
    mesh.points.row(n + i) << std::cos(turn), std::sin(turn), 1.0;
  }
  for (Index i = 0; i < n; ++i) mesh.add_face({i, (i + 1) % n, n + (i + 1) % n, n + i});
  for (Index i = 0; i < n; ++i) mesh.face_vertices.push_back(n + i);
  mesh.face_offsets.push_back(5 * n);
  const Triangles triangles = triangles_of_mesh(mesh);
  for (std::size_t corner = 0; corner < triangles.vertices.size(); ++corner) {
    const Vec point = triangles.points[triangles.vertices[corner]];
    const Vec wall = Vec(point.x(), point.y(), 0.0F).normalized();
    const Vec expected = corner / 3 < 2 * static_cast<std::size_t>(n) ? wall : Vec(Vec::UnitZ());
    EXPECT_LT((triangles.normals[triangles.normal_row(corner)] - expected).norm(), 1e-3F);
  }
}

TEST(RenderGeometry, HolesAndFacesWithoutAreaAreHandled) {
  Mesh mesh = cube();
  mesh.holes = {0, 3};
  EXPECT_EQ(triangles_of_mesh(mesh).count(), 8U);
  mesh = cube();
  mesh.add_face({0, 1});
  mesh.add_face({0, 0, 1});
  const Triangles triangles = triangles_of_mesh(mesh);
  EXPECT_EQ(triangles.count(), 13U);
  for (const std::uint32_t row : triangles.normal_rows) EXPECT_TRUE(triangles.normals[row].allFinite());
}

TEST(RenderGeometry, UpIsWhereTheShapeStands) {
  Mesh pyramid;
  pyramid.points.resize(5, 3);
  pyramid.points << -1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1, 0.1, 2, 0.2;
  pyramid.add_face({0, 1, 2, 3});
  for (Index i = 0; i < 4; ++i) pyramid.add_face({i, 4, (i + 1) % 4});
  Scene scene;
  scene.surface = pyramid;
  EXPECT_EQ(resolve_up({&scene}, UpAxis::Auto), UpAxis::Y);
  EXPECT_EQ(resolve_up({&scene}, UpAxis::Z), UpAxis::Z);
  scene.surface.points.col(1).swap(scene.surface.points.col(2));
  EXPECT_EQ(resolve_up({&scene}, UpAxis::Auto), UpAxis::Z);
  scene.surface = cube();
  EXPECT_EQ(resolve_up({&scene}, UpAxis::Auto), UpAxis::Z);
}

TEST(RenderGeometry, FlatMeshesAreSeenAlongTheirNormal) {
  Scene scene;
  scene.surface = grid(5, 3);
  const Eigen::Vector3d normal(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);
  const Eigen::AngleAxisd turn(std::acos(6.0 / 7.0), Eigen::Vector3d(3.0, 2.0, 0.0).normalized());  // of z onto it
  scene.surface.points = (scene.surface.points * turn.toRotationMatrix().transpose()).eval();
  const auto direction = [&] {
    const std::array<double, 3> view = fit_viewpoint({&scene}, {}).direction;
    return Eigen::Vector3d(view[0], view[1], view[2]);
  };
  EXPECT_LT((direction() - normal).norm(), 1e-12);
  scene.surface.points.row(0) += 0.2 * normal.transpose();
  EXPECT_GT((direction() - normal).norm(), 0.1);
  scene.surface = cube();
  scene.surface.points.col(2) *= 1e-4;  // a closed plate has no side that is the front
  EXPECT_NO_THROW(direction());
  scene.surface = grid(5, 3);
  EXPECT_EQ(turntable({&scene}, {}, 3).size(), 3U);  // not from straight above
}

TEST(RenderGeometry, TheDefaultViewIsFromTheFront) {
  Scene scene;
  scene.surface = cube();
  for (const double depth : {0.1, 1.0, 10.0}) {
    scene.surface.points = cube().points;
    scene.surface.points.col(1) *= depth;
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z, UpAxis::X, UpAxis::MinusY}) {
      RenderOptions options;
      options.up = up;
      const std::array<double, 3> view = fit_viewpoint({&scene}, options).direction;
      const Eigen::Vector3d direction(view[0], view[1], view[2]);
      EXPECT_GT(-direction.dot(up_frame(up).back), std::abs(direction.dot(up_frame(up).right)));
      EXPECT_GT(direction.dot(up_frame(up).up), 0.3);
    }
  }
}

TEST(RenderGeometry, NamedViewsStandOnTheirSide) {
  Scene scene;
  scene.surface = cube();
  RenderOptions options;
  options.up = UpAxis::Z;
  const auto towards = [&](View view) {
    options.view = view;
    return fit_viewpoint({&scene}, options).direction;
  };
  EXPECT_EQ(towards(View::Front), (std::array<double, 3>{0.0, -1.0, 0.0}));
  EXPECT_EQ(towards(View::Right), (std::array<double, 3>{1.0, 0.0, 0.0}));
  EXPECT_EQ(towards(View::Top), (std::array<double, 3>{0.0, 0.0, 1.0}));
  options.up = UpAxis::Y;
  EXPECT_EQ(towards(View::Front), (std::array<double, 3>{0.0, 0.0, 1.0}));
  EXPECT_EQ(towards(View::Top), (std::array<double, 3>{0.0, 1.0, 0.0}));
  EXPECT_EQ(towards(View::Left), (std::array<double, 3>{-1.0, 0.0, 0.0}));
}

TEST(RenderGeometry, TurntableKeepsItsDistanceAndShowsEverything) {
  Scene scene;
  scene.surface = torus(40, 20, 3.0, 0.5);
  scene.surface.points.col(0) *= 4.0;
  scene.surface.points.rowwise() += Eigen::RowVector3d(100, 200, 300);
  RenderOptions options;
  options.up = UpAxis::Z;
  const std::vector<Viewpoint> around = turntable({&scene}, options, 12);
  ASSERT_EQ(around.size(), 12U);
  const Frame frame = frame_of({&scene});
  float widest = 0.0F;
  for (const Viewpoint& viewpoint : around) {
    EXPECT_EQ(viewpoint.distance, around[0].distance);
    EXPECT_EQ(viewpoint.target, around[0].target);
    EXPECT_NEAR(viewpoint.direction[2], around[0].direction[2], 1e-12);
    options.viewpoint = viewpoint;
    const Camera camera = camera_of(scene, frame, options);
    for (Index v = 0; v < scene.surface.vertex_count(); ++v) {
      const Vec at = frame.apply(scene.surface.points.row(v)) - camera.eye;
      const float depth = at.dot(camera.forward);
      widest = std::max({widest, std::abs(at.dot(camera.right)) / depth / camera.tangent_x,
                         std::abs(at.dot(camera.up)) / depth / camera.tangent_y});
    }
  }
  EXPECT_NEAR(widest, 0.85F, 1e-4F);
  options.view = View::Top;
  EXPECT_EQ(test::code_of([&] { turntable({&scene}, options, 4); }), ErrorCode::BadArgument);
  EXPECT_EQ(test::code_of([&] { turntable({&scene}, RenderOptions(), 0); }), ErrorCode::BadArgument);
}

TEST(RenderGeometry, EveryPointFitsTheFrame) {
  Scene scene;
  scene.surface = torus(40, 20, 3.0, 0.5);
  scene.surface.points.col(0) *= 7.0;
  scene.surface.points.rowwise() += Eigen::RowVector3d(100, 200, 300);
  const Frame frame = frame_of({&scene});
  RenderOptions options;
  for (const std::array<double, 3>& view :
       {std::array<double, 3>{1, 2, 3}, {0, 0, 1}, {0, 0, -1}, {-1, 0, 0}, {3, -1, -2}}) {
    options.direction = view;
    const Camera camera = camera_of(scene, frame, options);
    float widest = 0.0F;
    for (Index v = 0; v < scene.surface.vertex_count(); ++v) {
      const Vec at = frame.apply(scene.surface.points.row(v)) - camera.eye;
      const float depth = at.dot(camera.forward);
      ASSERT_GT(depth, 0.0F);
      widest = std::max({widest, std::abs(at.dot(camera.right)) / depth / camera.tangent_x,
                         std::abs(at.dot(camera.up)) / depth / camera.tangent_y});
    }
    EXPECT_NEAR(widest, 0.85F, 1e-4F);
  }
}

}  // namespace
}  // namespace batten::render_detail
