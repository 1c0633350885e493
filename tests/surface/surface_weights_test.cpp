#include "batten/surface/surface_weights.h"

#include <gtest/gtest.h>

#include <random>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/parallel.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr JetPart kParts[] = {JetPart::Point, JetPart::Du, JetPart::Dv, JetPart::Duu, JetPart::Duv, JetPart::Dvv};

const Eigen::Vector3d& part_of(const Jet& jet, JetPart part) {
  const Eigen::Vector3d* parts[] = {&jet.point, &jet.du, &jet.dv, &jet.duu, &jet.duv, &jet.dvv};
  return *parts[static_cast<int>(part)];
}

/// Random places of every face, some next to its corners, and the corners.
std::vector<SurfacePlace> places_of(const Topology& base, bool quads) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<SurfacePlace> places;
  for (Index f = 0; f < base.face_count(); ++f) {
    for (const double nearness : {1.0, 0.001}) {
      double u = unit(random);
      double v = unit(random);
      if (!quads && u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      places.push_back({f, nearness * u, nearness * v});
    }
    places.push_back({f, 0.0, 0.0});
    places.push_back({f, 1.0, 0.0});
    places.push_back({f, 0.0, 1.0});
  }
  return places;
}

/// In parameters, from the nearest corner.
double corner_distance(const SurfacePlace& place, bool quads) {
  double least = std::max(place.u, place.v);
  least = std::min(least, std::max(1.0 - place.u, place.v));
  least = std::min(least, std::max(place.u, 1.0 - place.v));
  return quads ? std::min(least, std::max(1.0 - place.u, 1.0 - place.v)) : least;
}

void expect_the_jets(const Mesh& mesh, const Scheme& scheme) {
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  const SurfaceWeights weights(topology, scheme);
  const auto places = places_of(weights.base(), scheme.kind != SchemeKind::Loop);
  std::vector<Jet> jets(places.size());
  surface.jets(places, jets);
  const Eigen::MatrixXd control = mesh.points;
  for (const JetPart part : kParts) {
    const auto rows = weights.rows(places, part);
    ASSERT_EQ(rows.rows(), static_cast<Eigen::Index>(places.size()));
    ASSERT_EQ(rows.cols(), topology.vertex_count());
    const Eigen::MatrixXd found = rows * control;
    const Eigen::VectorXd sums = rows * Eigen::VectorXd::Ones(control.rows());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      // Next to a corner the patch's parameters run faster than the face's, and rounding of second derivatives with
      // them.
      const double speed = 1.0 / std::max(corner_distance(places[i], scheme.kind != SchemeKind::Loop), 1e-9);
      const bool is_second = part == JetPart::Duu || part == JetPart::Duv || part == JetPart::Dvv;
      const double size = 1.0 + rows.row(row).cwiseAbs().sum() + (is_second && speed < 1e9 ? speed : 0.0);
      EXPECT_NEAR(sums[row], part == JetPart::Point ? 1.0 : 0.0, 1e-14 * size);
      if (!jets[i].regular && part != JetPart::Point) continue;
      EXPECT_LE((found.row(row).transpose() - part_of(jets[i], part)).norm(), 1e-14 * size)
          << "face " << places[i].face << " at " << places[i].u << ", " << places[i].v << ", part "
          << static_cast<int>(part);
    }
  }
  if (topology.has_corners()) return;  // a corner between smooth edges is the tip of a cone, without a tangent plane
  // At an extraordinary vertex the tangents may be others, but the plane is the same.
  const Eigen::MatrixXd du = weights.rows(places, JetPart::Du) * control;
  const Eigen::MatrixXd dv = weights.rows(places, JetPart::Dv) * control;
  const auto bends = weights.rows(places, JetPart::Duu);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (jets[i].regular) continue;
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d normal = du.row(row).head<3>().cross(dv.row(row).head<3>()).normalized();
    EXPECT_LE((normal - jets[i].du.cross(jets[i].dv).normalized()).norm(), 1e-9) << "place " << i;
    EXPECT_EQ(bends.row(row).nonZeros(), 0);
  }
}

TEST(SurfaceWeights, AreThoseOfTheJets) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name.find("dihedron") != std::string::npos) continue;
    for (const unsigned seed : {0U, 1U}) {
      Mesh mesh = test::jittered(sample.mesh, 0.05, 11);
      if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
      for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
        if (kind == SchemeKind::Loop && !all_triangles(mesh)) continue;
        for (const CreaseMethod method : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
          if (method == CreaseMethod::Chaikin && seed == 0) continue;
          SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
          Scheme scheme;
          scheme.kind = kind;
          scheme.crease_method = method;
          expect_the_jets(mesh, scheme);
        }
      }
    }
  }
}

TEST(SurfaceWeights, KnowEveryBoundaryRuleAndAlpha) {
  const Mesh mesh = test::jittered(grid(5, 4), 0.1, 2);
  for (const BoundaryRule rule : {BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner}) {
    Scheme scheme;
    scheme.boundary = rule;
    expect_the_jets(mesh, scheme);
  }
  Scheme scheme;
  scheme.alpha = 0.5;
  expect_the_jets(test::jittered(cube(), 0.1, 3), scheme);
  scheme.alpha = 0.0;
  scheme.triangle_rule = TriangleRule::Smooth;
  expect_the_jets(test::jittered(test::bipyramid(7), 0.02, 3), scheme);
}

TEST(SurfaceWeights, AreRowsOfTheLimitMatrixAtVertices) {
  const Mesh mesh = test::jittered(torus(7, 5), 0.02, 4);
  const Topology topology(mesh);
  const SurfaceWeights weights(topology, {});
  std::vector<SurfacePlace> places;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    const Index h = topology.vertex_half_edge(v);
    const double us[4] = {0.0, 1.0, 1.0, 0.0};
    const double vs[4] = {0.0, 0.0, 1.0, 1.0};
    places.push_back({h / 4, us[h % 4], vs[h % 4]});
  }
  const Eigen::MatrixXd difference =
      Eigen::MatrixXd(weights.rows(places)) - Eigen::MatrixXd(LimitMatrix(topology, {}).matrix());
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SurfaceWeights, DoNotDependOnThreadsAndRefuseWhatIsNotThere) {
  const Mesh mesh = test::random_hull(100, 3);
  const Topology topology(mesh);
  const SurfaceWeights weights(topology, {});
  const auto places = places_of(weights.base(), true);
  const auto many = weights.rows(places);
  const ThreadLimit one(1);
  const auto single = weights.rows(places);
  ASSERT_EQ(many.nonZeros(), single.nonZeros());
  EXPECT_TRUE(std::equal(many.valuePtr(), many.valuePtr() + many.nonZeros(), single.valuePtr()));
  const std::vector<SurfacePlace> wrong{{weights.base().face_count(), 0.5, 0.5}};
  EXPECT_THROW(weights.rows(wrong), Error);
  const std::vector<SurfacePlace> outside{{0, 1.5, 0.5}};
  EXPECT_THROW(weights.rows(outside), Error);
  EXPECT_EQ(weights.rows({}).rows(), 0);
}

TEST(SurfaceWeights, AreTheSameForAllPartsAtOnce) {
  const Mesh mesh = test::with_random_tags(dodecahedron(), 4);
  const SurfaceWeights weights(Topology(mesh), Scheme{});
  const std::vector<SurfacePlace> places = places_of(weights.base(), true);
  const auto all = weights.rows(places, kAllJetParts);
  for (std::size_t p = 0; p < kAllJetParts.size(); ++p) {
    EXPECT_EQ(Eigen::MatrixXd(all[p]), Eigen::MatrixXd(weights.rows(places, kAllJetParts[p])));
  }
}

}  // namespace
}  // namespace batten
