#include "batten/mesh/up_axis.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "batten/mesh/primitives.h"

namespace batten {
namespace {

constexpr UpAxis kAllAxes[] = {UpAxis::X, UpAxis::Y, UpAxis::Z, UpAxis::MinusX, UpAxis::MinusY, UpAxis::MinusZ};

TEST(UpAxisFrame, IsRightHandedAndTurnsToYUp) {
  for (const UpAxis up : kAllAxes) {
    const UpFrame frame = up_frame(up);
    EXPECT_EQ(frame.right.cross(frame.back), frame.up);
    const Eigen::Matrix3d turned = to_y_up(up);
    EXPECT_EQ(turned.determinant(), 1.0);
    EXPECT_EQ(turned * frame.up, Eigen::Vector3d::UnitY());
    EXPECT_EQ(turned * frame.right, Eigen::Vector3d::UnitX());
    EXPECT_EQ(turned * -frame.back, Eigen::Vector3d::UnitZ());
  }
  EXPECT_TRUE(to_y_up(UpAxis::Y).isIdentity(0.0));
  EXPECT_EQ(up_frame(UpAxis::Z).back, Eigen::Vector3d::UnitY());
}

/// A pyramid of height 2 on the square of side 2, its tip near the middle; with z up.
Mesh pyramid() {
  Mesh mesh;
  mesh.points.resize(5, 3);
  mesh.points << -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0.1, 0.2, 2;
  mesh.add_face({0, 3, 2, 1});
  for (Index i = 0; i < 4; ++i) mesh.add_face({i, (i + 1) % 4, 4});
  return mesh;
}

TEST(UpAxisGuess, StandsAShapeOnItsFoot) {
  Mesh mesh = pyramid();
  EXPECT_EQ(steadiness(mesh.points, UpAxis::Z), 1.0);
  EXPECT_EQ(steadiness(mesh.points, UpAxis::MinusZ), 0.0);
  for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) EXPECT_EQ(guess_up_axis(mesh, usual), UpAxis::Z);
  mesh.points.col(1).swap(mesh.points.col(2));
  for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) EXPECT_EQ(guess_up_axis(mesh, usual), UpAxis::Y);
}

TEST(UpAxisGuess, KeepsTheUsualAxisOfWhatStandsOnBothOrOnNeither) {
  for (const Mesh& mesh : {cube(), dodecahedron(), Mesh()}) {
    for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) EXPECT_EQ(guess_up_axis(mesh, usual), usual);
  }
}

TEST(UpAxisGuess, TakesPointsWithoutFacesAnySizeAndNoNumber) {
  Mesh mesh = pyramid();
  mesh.face_offsets = {0};
  mesh.face_vertices.clear();
  mesh.points *= 1e300;
  EXPECT_EQ(guess_up_axis(mesh, UpAxis::Y), UpAxis::Z);
  mesh.points(4, 0) = std::nan("");
  mesh.points(3, 0) = std::nan("");
  EXPECT_NO_THROW(guess_up_axis(mesh));
}

}  // namespace
}  // namespace batten
