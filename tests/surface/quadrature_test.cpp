#include "batten/surface/quadrature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

#include "batten/error.h"
#include "batten/tessellate/tessellator.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Six times the volume of the tetrahedra between the origin and the faces' triangles, over six.
double volume_of(const Tessellation<double>& mesh) {
  const auto point = [&](Index v) { return Eigen::Vector3d(&mesh.points[3 * static_cast<std::size_t>(v)]); };
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.faces.size(); f += static_cast<std::size_t>(mesh.face_size)) {
    for (Index k = 2; k < mesh.face_size; ++k) {
      sum += point(mesh.faces[f]).dot(point(mesh.faces[f + k - 1]).cross(point(mesh.faces[f + k]))) / 6.0;
    }
  }
  return sum;
}

/// By the divergence theorem: a third of the integral of the point times the normal.
double volume_by(const LimitSurface& surface, const SurfaceQuadrature& quadrature) {
  std::vector<Jet> jets(quadrature.places.size());
  surface.jets(quadrature.places, jets);
  double sum = 0.0;
  for (std::size_t i = 0; i < jets.size(); ++i) {
    sum += quadrature.weights[i] * jets[i].point.dot(jets[i].du.cross(jets[i].dv)) / 3.0;
  }
  return sum;
}

TEST(Quadrature, WeightsOfAFaceSumToItsParameters) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const SurfacePatches patches(Topology(mesh), scheme);
    const SurfaceQuadrature quadrature = surface_quadrature(patches, {3, 5});
    ASSERT_EQ(quadrature.starts.size(), static_cast<std::size_t>(patches.base().face_count()) + 1) << name;
    for (Index f = 0; f < patches.base().face_count(); ++f) {
      const auto begin = quadrature.weights.begin() + static_cast<std::ptrdiff_t>(quadrature.starts[f]);
      const auto end = quadrature.weights.begin() + static_cast<std::ptrdiff_t>(quadrature.starts[f + 1]);
      EXPECT_NEAR(std::accumulate(begin, end, 0.0), patches.quads() ? 1.0 : 0.5, 1e-14) << name;
      for (std::size_t i = quadrature.starts[f]; i < quadrature.starts[f + 1]; ++i) {
        EXPECT_EQ(quadrature.places[i].face, f);
        EXPECT_NO_THROW(require_place(patches.base(), quadrature.places[i])) << name;
      }
    }
  });
}

/// A polynomial of degree 8 in u and in v on quads, of degree 10 in both on triangles.
TEST(Quadrature, VolumesOfRegularSurfacesAreExact) {
  for (const auto& [mesh, scheme, points] :
       {std::tuple{test::jittered(torus(8, 6), 0.1, 3), Scheme{}, 5},
        std::tuple{test::jittered(test::triangle_torus(8, 6), 0.1, 3), Scheme{SchemeKind::Loop}, 6}}) {
    const SurfacePatches patches(Topology(mesh), scheme);
    const LimitSurface surface(patches, mesh.points);
    const double exact = volume_by(surface, surface_quadrature(patches, {16, 0}));
    EXPECT_NEAR(volume_by(surface, surface_quadrature(patches, {points, 0})), exact, 1e-13 * std::abs(exact));
    EXPECT_GT(std::abs(volume_by(surface, surface_quadrature(patches, {2, 0})) - exact), 1e-9 * std::abs(exact));
  }
}

TEST(Quadrature, VolumesOfIrregularSurfacesAreThoseOfFineMeshes) {
  for (const auto& [mesh, scheme] : {std::pair{cube(), Scheme{}}, std::pair{dodecahedron(), Scheme{}},
                                     std::pair{icosahedron(), Scheme{SchemeKind::Loop}}}) {
    const Topology topology(mesh);
    const SurfacePatches patches(topology, scheme);
    const double volume = volume_by(LimitSurface(patches, mesh.points), surface_quadrature(patches));
    // The volume of a mesh on the surface is too small by O(4^-levels): two of them leave O(16^-levels).
    const double fine = volume_of(tessellate<double>(topology, scheme, mesh.points, 6, {true}));
    const double coarse = volume_of(tessellate<double>(topology, scheme, mesh.points, 5, {true}));
    EXPECT_NEAR(volume, fine + (fine - coarse) / 3.0, 2e-6 * volume);
  }
}

TEST(Quadrature, AreasConvergeWithTheLevels) {
  const Mesh mesh = cube();
  const SurfacePatches patches(Topology(mesh), Scheme{});
  const LimitSurface surface(patches, mesh.points);
  const auto area = [&](int levels) { return area_weights(surface, surface_quadrature(patches, {6, levels})).sum(); };
  const double best = area(16);
  EXPECT_LT(std::abs(area(8) - best), 0.3 * std::abs(area(6) - best));
  EXPECT_LT(std::abs(area(10) - best), 1e-7 * best);
}

TEST(Quadrature, RefusesOptionsOutOfRange) {
  const SurfacePatches patches(Topology(cube()), Scheme{});
  EXPECT_THROW(surface_quadrature(patches, {0, 6}), Error);
  EXPECT_THROW(surface_quadrature(patches, {4, 41}), Error);
}

}  // namespace
}  // namespace batten
