#include "batten/patch/poles.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "batten/patch/pieces.h"
#include "batten/patch/surface_patches.h"
#include "batten/surface/limit_surface.h"
#include "batten/surface/surface_weights.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr Index kValence = Poles::kFewestFaces;

Mesh wavy_bipyramid(Index valence) {
  Mesh mesh = test::bipyramid(valence);
  for (Index v = 0; v < valence; ++v) mesh.points.row(v) *= 1.0 + 0.2 * std::cos(6.0 * std::numbers::pi * v / valence);
  return mesh;
}

/// A crease along a part of the rim, whose sharpness fades.
Mesh creased_bipyramid(Index valence) {
  Mesh mesh = wavy_bipyramid(valence);
  for (Index v = 0; v < 10; ++v) mesh.creases.push_back({v, v + 1, 2.5});
  return mesh;
}

TEST(Poles, AreVerticesOfManyFacesWithoutSharpEdges) {
  const Scheme loop{SchemeKind::Loop};
  Mesh mesh = test::bipyramid(kValence);
  const Poles poles(Topology(mesh), loop);
  EXPECT_TRUE(poles.is_pole(kValence));
  EXPECT_TRUE(poles.is_pole(kValence + 1));
  EXPECT_FALSE(poles.is_pole(0));
  EXPECT_EQ(poles.most_faces(), kValence);
  EXPECT_TRUE(Poles(Topology(test::bipyramid(kValence - 1)), loop).empty());
  mesh.creases = {{0, kValence, 1.0F}};
  mesh.corners = {{kValence + 1, 0.5F}};
  EXPECT_TRUE(Poles(Topology(mesh), loop).empty());
  const Mesh open = test::without_face(test::bipyramid(kValence), 0);
  EXPECT_FALSE(Poles(Topology(open), loop).is_pole(kValence));
}

TEST(Poles, HaveTheMeansOfTheirNeighbours) {
  const Mesh mesh = wavy_bipyramid(kValence);
  const Topology topology(mesh);
  const Poles poles(topology, Scheme{SchemeKind::Loop});
  const Values all = poles.with_means(topology, mesh.points);
  ASSERT_EQ(all.rows(), mesh.vertex_count() + 2);
  EXPECT_EQ(all.topRows(mesh.vertex_count()), Values(mesh.points));
  const Eigen::RowVector3d mean = mesh.points.topRows(kValence).colwise().mean();
  for (const Index pole : {kValence, kValence + 1}) {
    EXPECT_LT((all.row(poles.first_mean(pole)) - mean).norm(), 1e-14);
  }
}

/// Of the surface, whose rings at poles have a part of the faces, against weights from whole rings.
void expect_jets_of_whole_rings(const Mesh& mesh, const Scheme& scheme) {
  const SurfacePatches patches(Topology(mesh), scheme);
  const LimitSurface surface(patches, mesh.points);
  constexpr std::array kParts{JetPart::Point, JetPart::Du, JetPart::Dv, JetPart::Duu, JetPart::Duv, JetPart::Dvv};
  const Topology& base = patches.base();
  for (Index f = 0; f < base.face_count(); f += base.face_count() / 12) {
    std::vector<SurfacePlace> places;
    for (const double t : {0.4, 0.06, 0.004}) {
      for (const std::array<double, 2>& at : {std::array{t, t / 3.0}, {1.0 - t, t / 2.0}, {t / 3.0, 1.0 - t}}) {
        places.push_back({f, at[0], at[1]});
      }
    }
    const auto rows = SurfaceWeights(patches).rows(places, kParts);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Jet jet = surface.jet(places[i]);
      const std::array expected{jet.point, jet.du, jet.dv, jet.duu, jet.duv, jet.dvv};
      // Rounding, as much larger as the smallest halved ring's parameters run faster: 2^8 times, and its square.
      constexpr std::array kTolerances{1e-13, 1e-11, 1e-11, 1e-8, 1e-8, 1e-8};
      for (std::size_t part = 0; part < kParts.size(); ++part) {
        const Eigen::RowVector3d found = rows[part].row(static_cast<Eigen::Index>(i)) * mesh.points;
        EXPECT_LT((found.transpose() - expected[part]).norm(), kTolerances[part]) << f << ' ' << i << ' ' << part;
      }
    }
  }
}

TEST(Poles, HaveTheJetsOfWholeRings) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    expect_jets_of_whole_rings(wavy_bipyramid(kValence + 8), Scheme{kind});
  }
}

TEST(Poles, HaveTheJetsOfWholeRingsBesideCreases) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    expect_jets_of_whole_rings(creased_bipyramid(kValence + 8), Scheme{kind});
  }
}

/// A crease through a pole, that fades before rings begin or after.
Mesh creased_pole(float sharpness) {
  Mesh mesh = wavy_bipyramid(kMostSharpFaces + 2);
  const Index pole = kMostSharpFaces + 2;
  mesh.creases = {{0, pole, sharpness}, {kMostSharpFaces / 2, pole, sharpness}};
  return mesh;
}

TEST(Poles, OfTooManyFacesAreErrorsAtBoundariesAndCreasesOnly) {
  const std::string pole = "vertex " + std::to_string(kMostSharpFaces + 2) + " has ";
  const Mesh open = test::without_face(wavy_bipyramid(kMostSharpFaces + 2), 0);
  for (const Mesh& mesh : {open, creased_pole(2.5F)}) {
    const SurfacePatches patches(Topology(mesh), Scheme{SchemeKind::Loop});
    test::expect_error([&] { (void)patches.pieces(); }, ErrorCode::TooLarge, pole);
    test::expect_error([&] { (void)patches.face_types(); }, ErrorCode::TooLarge, pole);
    test::expect_error([&] { LimitSurface(patches, mesh.points); }, ErrorCode::TooLarge, pole);
  }
  const Mesh fading = creased_pole(2.0F);
  const SurfacePatches patches(Topology(fading), Scheme{SchemeKind::Loop});
  EXPECT_EQ(patches.pieces().poles().most_faces(), kMostSharpFaces + 2);
  test::expect_error([&] { (void)patches.face_types(); }, ErrorCode::TooLarge, pole);
}

}  // namespace
}  // namespace batten
