#include "batten/interpolate/wanted_normals.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/mesh/vertex_measure.h"
#include "batten/mesh/vertex_normals.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace batten {
namespace {

TEST(WantedNormals, AreUnitVectorsOrZero) {
  Values given(4, 3);
  given << 3.0, 0.0, 4.0, 0.0, 0.0, 0.0, 1e200, 1e200, 0.0, -1e-200, 0.0, 0.0;
  const Values unit = wanted_normals(given);
  Values expected(4, 3);
  expected << 0.6, 0.0, 0.8, 0.0, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5), 0.0, -1.0, 0.0, 0.0;
  EXPECT_LT((unit - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(WantedNormals, AreTheMeansOfTheCornersNormals) {
  Mesh mesh = cube();
  Attribute normals{"normal", Values(6, 3), Buffer<Index>(24)};
  normals.values << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  for (Index f = 0; f < 6; ++f) {
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (Index c = 4 * f; c < 4 * f + 4; ++c) middle += mesh.points.row(mesh.face_vertices[c]);
    for (Index c = 4 * f; c < 4 * f + 4; ++c) {
      for (Index row = 0; row < 6; ++row) {
        if (normals.values.row(row).dot(middle) > 3.0) normals.corner_rows[c] = row;
      }
    }
  }
  mesh.attributes.push_back(normals);
  const Values wanted = stated_wanted_normals(mesh);
  for (Index v = 0; v < 8; ++v) EXPECT_LT(angle_between(wanted.row(v), mesh.points.row(v)), 1e-15);
}

TEST(WantedNormals, OfACornerWithoutARowAreThoseOfTheOthers) {
  Mesh mesh = cube();
  mesh.attributes.push_back({"normal", Values::Ones(1, 3), Buffer<Index>(24, -1)});
  mesh.attributes[0].corner_rows[0] = 0;
  const Values wanted = stated_wanted_normals(mesh);
  EXPECT_NEAR(wanted.row(mesh.face_vertices[0]).norm(), 1.0, 1e-15);
  EXPECT_NEAR(wanted.norm(), 1.0, 1e-15);
}

TEST(WantedNormals, MustBeStatedAndFinite) {
  Mesh mesh = cube();
  const std::optional<Error> none = test::error_of([&] { stated_wanted_normals(mesh, "bare.obj"); });
  EXPECT_EQ(none->code(), ErrorCode::BadArgument);
  EXPECT_NE(std::string(none->what()).find("bare.obj"), std::string::npos);
  mesh.attributes.push_back({"normal", mesh.points, {}});
  mesh.attributes[0].values(5, 2) = std::numeric_limits<double>::infinity();
  const std::optional<Error> infinite = test::error_of([&] { stated_wanted_normals(mesh); });
  EXPECT_EQ(infinite->code(), ErrorCode::NotFinite);
  EXPECT_NE(std::string(infinite->what()).find('5'), std::string::npos);
}

TEST(AngleWeightedNormals, DoNotDependOnHowFlatFacesAreCut) {
  const Mesh quads = cube();
  std::vector<std::vector<Index>> triangles;
  for (const std::vector<Index>& face : test::faces_of(quads)) {
    triangles.push_back({face[0], face[1], face[2]});
    triangles.push_back({face[0], face[2], face[3]});
  }
  const Mesh cut = test::with_faces(quads, triangles);
  const Points normals = angle_weighted_normals(Topology(cut), cut.points);
  for (Index v = 0; v < 8; ++v) EXPECT_LT(angle_between(normals.row(v), quads.points.row(v)), 1e-15);
}

TEST(AngleWeightedNormals, ComeNearATorusNormalsAsItsMeshIsRefined) {
  double last = 0.0;
  for (const Index n : {10, 20, 40}) {
    const Mesh mesh = torus(2 * n, n);
    const Points normals = angle_weighted_normals(Topology(mesh), mesh.points);
    double worst = 0.0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      Eigen::RowVector3d exact = mesh.points.row(v);
      const double distance = exact.head(2).norm();
      exact.head(2) *= (distance - 1.0) / distance;
      worst = std::max(worst, angle_between(normals.row(v), exact));
    }
    if (last > 0.0) {  // second order
      EXPECT_NEAR(last / worst, 4.0, 0.6);
    }
    last = worst;
  }
}

TEST(AngleWeightedNormals, AreZeroWithoutAFace) {
  const Mesh mesh = test::mesh_of_faces(4, {{0, 1, 2}});
  EXPECT_TRUE(angle_weighted_normals(Topology(mesh), mesh.points).row(3).isZero(0.0));
}

}  // namespace
}  // namespace batten
