/// Vertices where thousands of faces meet: of fans, and in the middle of large polygons.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "batten/surface/limit_surface.h"
#include "batten/surface/surface_weights.h"
#include "batten/tessellate/tessellator.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr Index kValence = 5000;

/// Two polygons with quads between them: after one step of Catmull-Clark each has a vertex of its valence.
Mesh prism(Index sides) {
  test::Faces faces(2);
  for (Index v = 0; v < sides; ++v) {
    faces[0].push_back(sides - 1 - v);
    faces[1].push_back(sides + v);
    faces.push_back({v, (v + 1) % sides, sides + (v + 1) % sides, sides + v});
  }
  Mesh mesh = test::mesh_of_faces(2 * sides, faces);
  for (Index v = 0; v < sides; ++v) {
    const double angle = 2.0 * std::numbers::pi * v / sides;
    const double radius = 1.0 + 0.2 * std::cos(3.0 * angle);
    mesh.points.row(v) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
    mesh.points.row(sides + v) << radius * std::cos(angle), radius * std::sin(angle), 1.0;
  }
  return mesh;
}

struct Case {
  Mesh mesh;
  Scheme scheme;
};
std::vector<Case> cases() {
  Mesh fan = test::bipyramid(kValence);
  for (Index v = 0; v < kValence; ++v) fan.points.row(v) *= 1.0 + 0.2 * std::cos(6.0 * std::numbers::pi * v / kValence);
  return {{prism(kValence), Scheme{}}, {fan, Scheme{}}, {fan, Scheme{SchemeKind::Loop}}};
}

/// Faces of the base around its first vertex of such a valence.
std::vector<Index> faces_at_pole(const Topology& base) {
  Index pole = 0;
  while (base.vertex_face_count(pole) < kValence) ++pole;
  std::vector<Index> faces;
  base.for_each_outgoing(pole, [&](Index h) { faces.push_back(base.face(h)); });
  return faces;
}

/// A place near the corner of a face that its pole is, and halfway out.
std::vector<SurfacePlace> places_of(const Topology& base, Index face) {
  std::vector<SurfacePlace> places;
  for (const double t : {0.5, 0.01, 1e-6}) {
    places.push_back({face, t, t / 3.0});
    places.push_back({face, 1.0 - t, base.uniform_face_size() == 4 ? t / 2.0 : t / 3.0});
  }
  return places;
}

TEST(HighValence, WeightsGiveWhatTheSurfaceGives) {
  for (const Case& tested : cases()) {
    const Mesh& mesh = tested.mesh;
    const Scheme& scheme = tested.scheme;
    const SurfacePatches patches(Topology(mesh), scheme);
    const LimitSurface surface(patches, mesh.points);
    const SurfaceWeights weights(patches);
    const std::vector<Index> faces = faces_at_pole(patches.base());
    for (const std::size_t i : {std::size_t{0}, faces.size() / 2}) {
      const std::vector<SurfacePlace> places = places_of(patches.base(), faces[i]);
      const auto rows = weights.rows(places, std::array{JetPart::Point, JetPart::Du, JetPart::Dv});
      std::vector<Jet> jets(places.size());
      surface.jets(places, jets);
      for (std::size_t p = 0; p < places.size(); ++p) {
        const auto difference = [&](std::size_t part, const Eigen::Vector3d& jet) {
          return (Eigen::RowVector3d(rows[part].row(static_cast<Eigen::Index>(p)) * mesh.points).transpose() - jet)
              .norm();
        };
        // Sums of 10,000 numbers, those of derivatives 10^6 times as large as their result.
        EXPECT_LT(difference(0, jets[p].point), 1e-11);
        EXPECT_LT(difference(1, jets[p].du), 1e-9);
        EXPECT_LT(difference(2, jets[p].dv), 1e-9);
      }
    }
  }
}

TEST(HighValence, TessellationsAndJetsMeetTheLimitOfRefinedPoints) {
  constexpr int kLevels = 2;
  for (const auto& [mesh, scheme] : cases()) {
    const SurfacePatches patches(Topology(mesh), scheme);
    const RefinedSurface refined = refine(patches.topology(), scheme, mesh.points, kLevels);
    const Values limits = LimitMatrix(refined.topology, scheme).apply(refined.values);
    const Tessellator tessellator(patches, kLevels);
    std::vector<double> points(3 * static_cast<std::size_t>(tessellator.vertex_count()));
    tessellator.limit<double>(mesh.points, points);
    // The control mesh's vertices come first in both orders.
    const Eigen::Map<const Points> tessellated(points.data(), tessellator.vertex_count(), 3);
    EXPECT_LT((tessellated.topRows(mesh.vertex_count()) - limits.topRows(mesh.vertex_count())).cwiseAbs().maxCoeff(),
              1e-12);
    const LimitSurface surface(patches, mesh.points);
    const std::vector<Index> faces = faces_at_pole(patches.base());
    const Index steps = tessellator.steps();
    for (Index i = 0; i <= steps; ++i) {
      const double u = static_cast<double>(i) / steps;
      const Eigen::Vector3d expected = tessellated.row(tessellator.vertex(faces[7], i, 0));
      EXPECT_LT((surface.jet({faces[7], u, 0.0}).point - expected).norm(), 1e-12) << i;
    }
  }
}

}  // namespace
}  // namespace batten
