#include <gtest/gtest.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "batten/patch/pieces.h"
#include "batten/surface/limit_surface.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"
#include "support/shapes.h"

namespace batten::test {
namespace {

namespace Bfr = OpenSubdiv::Bfr;

/// Bfr halves a face so many times towards what is irregular, and has an approximation in the last, smallest piece.
constexpr int kHalvings = 8;
/// Places keep so far from the sides of a face: outside of those pieces, 1/256 of a side.
constexpr double kMargin = 1.0 / 64.0;

/// Over the greatest coordinate of a face's control points, and their number where it is more than a patch's 16.
constexpr double kJetTolerance = 5e-15;
/// Of derivatives up to the second, of regular faces.
constexpr double kRegularTolerance = 2e-14;
/// In halved faces the rounding of some units grows by 2 (first derivatives) and 4 (second) with each of the six
/// halvings that kMargin stands for.
constexpr double kFirstTolerance = 64 * 1e-15;
constexpr double kSecondTolerance = 64 * 64 * 1e-15;

/// Bfr's surface of one face of the control mesh.
class FaceOfBfr {
 public:
  /// False where the face is no part of the surface.
  bool start(const Bfr::RefinerSurfaceFactory<>& factory, const Mesh& mesh, Index face) {
    if (!factory.InitVertexSurface(face, &surface_)) return false;
    patch_points_.resize(3 * static_cast<std::size_t>(surface_.GetNumPatchPoints()));
    surface_.PreparePatchPoints(mesh.points.data(), 3, patch_points_.data(), 3);
    size_ = 0.0;
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(surface_.GetNumControlPoints()); ++i) {
      size_ = std::max(size_, std::abs(patch_points_[i]));
    }
    size_ *= std::max(1.0, surface_.GetNumControlPoints() / 16.0);
    return true;
  }

  bool is_regular() const { return surface_.IsRegular(); }
  double size() const { return size_; }  ///< that tolerances are relative to

  Jet jet(double u, double v) const {
    const double uv[2] = {u, v};
    Jet jet;
    surface_.Evaluate(uv, patch_points_.data(), 3, jet.point.data(), jet.du.data(), jet.dv.data(), jet.duu.data(),
                      jet.duv.data(), jet.dvv.data());
    return jet;
  }

  /// In the parameters of the quarter at a corner (a quad of our first refinement): half the length, turned.
  Jet quarter_jet(int corner, double u, double v) const {
    const Bfr::Parameterization domain = surface_.GetParameterization();
    if (domain.HasSubFaces()) {
      const double in_quarter[2] = {u, v};
      double uv[2];
      domain.ConvertNormalizedSubFaceToCoord(corner, in_quarter, uv);
      return changed(jet(uv[0], uv[1]), 0.5, 0.0);
    }
    static constexpr double kCosine[4] = {0.5, 0.0, -0.5, 0.0};
    const double c = kCosine[corner];
    const double s = kCosine[(corner + 3) % 4];
    const double x = corner == 1 || corner == 2 ? 1.0 : 0.0;
    const double y = corner >= 2 ? 1.0 : 0.0;
    return changed(jet(x + c * u - s * v, y + s * u + c * v), c, s);
  }

 private:
  /// By (a, b), where (u, v) = (c a - s b, s a + c b).
  static Jet changed(const Jet& jet, double c, double s) {
    Jet result = jet;
    result.du = c * jet.du + s * jet.dv;
    result.dv = -s * jet.du + c * jet.dv;
    result.duu = c * c * jet.duu + 2 * c * s * jet.duv + s * s * jet.dvv;
    result.duv = -c * s * jet.duu + (c * c - s * s) * jet.duv + c * s * jet.dvv;
    result.dvv = s * s * jet.duu - 2 * c * s * jet.duv + c * c * jet.dvv;
    return result;
  }

  Bfr::Surface<double> surface_;
  std::vector<double> patch_points_;
  double size_ = 0.0;
};

/// Bfr turns the sign of all second derivatives in the triangles that its halving turns (OpenSubdiv 3.5's patch basis
/// scales them by the cube of -2^halvings, not by its square).
enum class SecondSign { Same, MayBeTurned };

/// The worst of the differences over the sizes, of each order of derivative.
struct Difference {
  double point = 0.0;
  double first = 0.0;
  double second = 0.0;
  Index compared = 0;

  void add(const Jet& ours, const Jet& theirs, double size, SecondSign sign) {
    const auto grow = [size](double& worst, double difference) {
      if (!(difference / size <= worst)) worst = difference / size;  // NaN is no small difference
    };
    grow(point, (ours.point - theirs.point).norm());
    grow(first, (ours.du - theirs.du).norm());
    grow(first, (ours.dv - theirs.dv).norm());
    const auto seconds = [&](double factor) {
      return std::max({(ours.duu - factor * theirs.duu).norm(), (ours.duv - factor * theirs.duv).norm(),
                       (ours.dvv - factor * theirs.dvv).norm()});
    };
    grow(second, sign == SecondSign::Same ? seconds(1.0) : std::min(seconds(1.0), seconds(-1.0)));
    ++compared;
  }
};

SurfacePlace random_place(std::mt19937& random, bool quads, Index face) {
  std::uniform_real_distribution<double> inside(kMargin, 1.0 - kMargin);
  while (true) {
    const SurfacePlace place{face, inside(random), inside(random)};
    if (quads || place.u + place.v < 1.0 - kMargin) return place;
  }
}

/// Regular faces, and all others.
struct Differences {
  Difference regular;
  Difference irregular;
};

/// Faces that Bfr takes for another surface. At interior vertices of valence 2 it joins what is apart, with a warning
/// about edges that do not exist; and of Chaikin's rule, which looks at both ends of an edge, it sees one end where the
/// other is outside of the face. (There the tests of tessellation and refinement stand for it.)
bool is_another_surface(const Topology& topology, const Scheme& scheme, Index face) {
  if (scheme.crease_method == CreaseMethod::Chaikin && topology.has_creases()) return true;
  for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h) {
    const Index v = topology.origin(h);
    if (!topology.is_boundary_vertex(v) && topology.vertex_face_count(v) == 2) return true;
  }
  return false;
}

Differences compare(const Mesh& mesh, const Scheme& scheme, Index most_faces) {
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  const auto refiner = oracle_refiner(mesh, scheme);
  Bfr::SurfaceFactory::Options options;
  options.SetApproxLevelSmooth(kHalvings).SetApproxLevelSharp(kHalvings);
  const Bfr::RefinerSurfaceFactory<> factory(*refiner, options);
  const bool quads = scheme.kind == SchemeKind::CatmullClark;
  const bool is_control = !needs_first_step(topology, scheme);
  FaceOfBfr theirs;
  std::mt19937 random(17);
  Differences result;
  const Index stride = 1 + topology.face_count() / most_faces;
  for (Index f = 0; f < topology.face_count(); f += stride) {
    if (is_another_surface(topology, scheme, f) || !theirs.start(factory, mesh, f)) continue;
    const bool regular = theirs.is_regular();
    Difference& difference = regular ? result.regular : result.irregular;
    const SecondSign sign = quads || regular ? SecondSign::Same : SecondSign::MayBeTurned;
    for (int i = 0; i < 4 * topology.face_size(f); ++i) {
      const int corner = i / 4;
      const SurfacePlace place = random_place(random, quads, is_control ? f : topology.face_begin(f) + corner);
      const Jet expected = is_control ? theirs.jet(place.u, place.v) : theirs.quarter_jet(corner, place.u, place.v);
      difference.add(surface.jet(place), expected, theirs.size(), sign);
    }
  }
  return result;
}

/// Returns how many places were compared.
Index expect_the_jets_of_bfr(const Mesh& mesh, const Scheme& scheme, Index most_faces) {
  const Differences worst = compare(mesh, scheme, most_faces);
  EXPECT_LE(worst.regular.point, kJetTolerance);
  EXPECT_LE(worst.regular.first, kRegularTolerance);
  EXPECT_LE(worst.regular.second, kRegularTolerance);
  EXPECT_LE(worst.irregular.point, kJetTolerance);
  EXPECT_LE(worst.irregular.first, kFirstTolerance);
  EXPECT_LE(worst.irregular.second, kSecondTolerance);
  return worst.regular.compared + worst.irregular.compared;
}

/// Bfr sums fading sharpness in floats from another edge on; of multiples of 1/64 every sum is exact.
Mesh with_exact_random_tags(const Mesh& mesh, unsigned seed) {
  Mesh tagged = with_random_tags(mesh, seed);
  for (Crease& crease : tagged.creases) crease.sharpness = std::round(64 * crease.sharpness) / 64;
  for (Corner& corner : tagged.corners) corner.sharpness = std::round(64 * corner.sharpness) / 64;
  return tagged;
}

/// Shapes of which nothing can be compared.
const std::set<std::string> kNoSurfaceOfBfr{"loop_chaikin1", "catmark_val2_back2back"};

class LimitSurfaceShapes : public ShapeTest {};
INSTANTIATE_TEST_SUITE_P(Conformance, LimitSurfaceShapes, ::testing::ValuesIn(shape_names()), test_name);

TEST_P(LimitSurfaceShapes, HaveTheJetsOfBfr) {
  const Index compared = expect_the_jets_of_bfr(mesh, scheme, 200);
  EXPECT_EQ(compared == 0, kNoSurfaceOfBfr.count(GetParam()) > 0);
}

TEST_P(LimitSurfaceShapes, HaveTheJetsOfBfrUnderEveryBoundaryRule) {
  for_each_boundary_rule([&](const Scheme& each) { expect_the_jets_of_bfr(mesh, each, 50); });
}

/// The smooth triangle rule is Catmull-Clark's alone.
std::vector<std::string> catmull_clark_shapes() {
  std::vector<std::string> names;
  for (const std::string& name : shape_names()) {
    if (name.rfind("loop_", 0) != 0) names.push_back(name);
  }
  return names;
}

class CatmullClarkSurfaces : public ShapeTest {};
INSTANTIATE_TEST_SUITE_P(Conformance, CatmullClarkSurfaces, ::testing::ValuesIn(catmull_clark_shapes()), test_name);

TEST_P(CatmullClarkSurfaces, HaveTheJetsOfBfrWithTheSmoothTriangleRule) {
  scheme.triangle_rule = TriangleRule::Smooth;
  expect_the_jets_of_bfr(mesh, scheme, 50);
}

TEST_P(LimitSurfaceShapes, HaveTheJetsOfBfrWithRandomTags) {
  scheme.crease_method = CreaseMethod::Uniform;
  expect_the_jets_of_bfr(with_exact_random_tags(mesh, 1), scheme, 50);
}

class LimitSurfaceModels : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Conformance, LimitSurfaceModels, ::testing::ValuesIn(model_names()), test_name);

TEST_P(LimitSurfaceModels, HaveTheJetsOfBfr) {
  BATTEN_REQUIRE_DATA();
  const Mesh mesh = load_model(GetParam());
  Scheme scheme;
  scheme.boundary = mesh.boundary.value_or(scheme.boundary);
  EXPECT_GT(expect_the_jets_of_bfr(mesh, scheme, 200), 0);
  if (!all_triangles(mesh)) return;
  scheme.kind = SchemeKind::Loop;
  EXPECT_GT(expect_the_jets_of_bfr(mesh, scheme, 200), 0);
}

}  // namespace
}  // namespace batten::test
