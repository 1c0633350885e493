#include "batten/energy/surface_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "batten/refine/refinement.h"
#include "batten/surface/limit_surface.h"
#include "batten/surface/quadrature.h"
#include "support/shapes.h"
#include "support/values.h"

namespace batten {
namespace {

constexpr EnergyKind kKinds[] = {EnergyKind::Mass, EnergyKind::Membrane, EnergyKind::ThinPlate};

/// The integrand's value for jets of a surface over quads or over triangles. On triangles g is the inverse metric of
/// the equilateral triangle of area 1/2, and the derivatives' length is |H|^2 = trace(g H g H).
double integrand(EnergyKind kind, bool quads, const Jet& jet) {
  Eigen::Matrix2d metric = Eigen::Matrix2d::Identity();
  if (!quads) metric << 1.0, -0.5, -0.5, 1.0;
  if (!quads) metric *= 2.0 / std::sqrt(3.0);
  if (kind == EnergyKind::Mass) return jet.point.squaredNorm();
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector2d gradient(jet.du[c], jet.dv[c]);
    Eigen::Matrix2d second;
    second << jet.duu[c], jet.duv[c], jet.duv[c], jet.dvv[c];
    sum += kind == EnergyKind::Membrane ? gradient.dot(metric * gradient) : (metric * second * metric * second).trace();
  }
  return sum;
}

/// Mass, Membrane, ThinPlate: half the integrals, by Gauss's rule on the exact jets.
std::array<double, 3> integrals(const SurfacePatches& patches, const Values& control, int levels) {
  const LimitSurface surface(patches, control);
  const SurfaceQuadrature quadrature = surface_quadrature(patches, {5, levels});
  std::vector<Jet> jets(quadrature.places.size());
  surface.jets(quadrature.places, jets);
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i < jets.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sums[k] += 0.5 * quadrature.weights[i] * integrand(kKinds[k], patches.quads(), jets[i]);
    }
  }
  return sums;
}

/// Valence n in the middle, every other vertex regular in the rings that matter: a fan of n grids of quads.
Mesh quad_fan(Index n, Index rings) {
  test::Faces faces;
  // Sector k has points (k, i, j) with i > 0, j >= 0; those with i = 0 belong to sector k + 1.
  const auto vertex = [&](Index k, Index i, Index j) -> Index {
    if (i == 0 && j == 0) return 0;
    if (i == 0) return 1 + ((k + 1) % n) * rings * (rings + 1) + (j - 1) * (rings + 1);
    return 1 + k * rings * (rings + 1) + (i - 1) * (rings + 1) + j;
  };
  for (Index k = 0; k < n; ++k) {
    for (Index i = 0; i < rings; ++i) {
      for (Index j = 0; j < rings; ++j) {
        faces.push_back({vertex(k, i, j), vertex(k, i + 1, j), vertex(k, i + 1, j + 1), vertex(k, i, j + 1)});
      }
    }
  }
  return test::mesh_of_faces(1 + n * rings * (rings + 1), faces);
}

/// The same of triangles.
Mesh triangle_fan(Index n, Index rings) {
  test::Faces faces;
  const auto first = [&](Index ring) { return ring == 0 ? 0 : 1 + n * ring * (ring - 1) / 2; };
  const auto vertex = [&](Index ring, Index place) {
    return ring == 0 ? 0 : first(ring) + (place + n * ring) % (n * ring);
  };
  for (Index ring = 0; ring < rings; ++ring) {
    for (Index k = 0; k < n; ++k) {
      for (Index j = 0; j <= ring; ++j) {
        const Index inner = k * ring + j;
        const Index outer = k * (ring + 1) + j;
        faces.push_back({vertex(ring, inner), vertex(ring + 1, outer), vertex(ring + 1, outer + 1)});
        if (j < ring) faces.push_back({vertex(ring, inner), vertex(ring + 1, outer + 1), vertex(ring, inner + 1)});
      }
    }
  }
  return test::mesh_of_faces(first(rings + 1), faces);
}

Mesh fan(bool quads, Index n) { return quads ? quad_fan(n, 3) : triangle_fan(n, 3); }
Scheme scheme_of(bool quads) { return Scheme{quads ? SchemeKind::CatmullClark : SchemeKind::Loop}; }

/// The faces at the middle of a fan(), whose first corner it is.
std::vector<double> middle_faces(bool quads, Index n) {
  const Mesh mesh = fan(quads, n);
  std::vector<double> flags(static_cast<std::size_t>(mesh.face_count()), 0.0);
  for (Index f = 0; f < mesh.face_count(); ++f) flags[f] = mesh.face_vertices[mesh.face_offsets[f]] == 0 ? 1.0 : 0.0;
  return flags;
}

enum class Expected { WithoutThinPlate, All };

/// Gauss's rule leaves lambda^2 of the membrane's error at a level, no more than 0.43, and 4 lambda^2 of the thin
/// plate's.
void expect_the_integrals(const Mesh& mesh, const Scheme& scheme, const std::string& name,
                          Expected expected = Expected::WithoutThinPlate) {
  const SurfacePatches patches(Topology(mesh), scheme);
  const Values control = test::random_values(mesh.vertex_count(), 3);
  const bool plate = expected == Expected::All;
  const std::array<double, 3> sums = integrals(patches, control, plate ? 40 : 28);
  const SurfaceEnergy energy(patches);
  for (std::size_t k = 0; k < (plate ? 3 : 2); ++k) {
    EXPECT_NEAR(energy.energy(kKinds[k], control), sums[k], (k == 2 ? 1e-9 : 1e-10) * sums[k]) << name << ", " << k;
  }
}

TEST(EnergyIntegrals, MassAndMembraneAreTheIntegralsAtEveryValence) {
  for (const bool quads : {true, false}) {
    for (Index n = 3; n <= 12; ++n) {
      expect_the_integrals(fan(quads, n), scheme_of(quads), "valence " + std::to_string(n));
    }
  }
}

/// Where 4 lambda^2 < 1, and at regular vertices.
TEST(EnergyIntegrals, ThinPlateIsTheIntegralWhereThatExists) {
  for (const Index n : {3, 4}) expect_the_integrals(fan(true, n), scheme_of(true), "quads", Expected::All);
  for (const Index n : {3, 4, 6}) expect_the_integrals(fan(false, n), scheme_of(false), "triangles", Expected::All);
}

TEST(EnergyIntegrals, MassAndMembraneAreTheIntegralsOnEverySample) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    expect_the_integrals(mesh, scheme, name);
  });
}

/// Semi-sharp creases, darts, corners, and several of them at a face.
TEST(EnergyIntegrals, MassAndMembraneAreTheIntegralsBesideCreases) {
  for (const Mesh& mesh : {cube(), dodecahedron(), icosahedron(), grid(4, 3)}) {
    const Mesh tagged = test::with_random_tags(mesh, 5);
    expect_the_integrals(tagged, {}, "quads");
    if (all_triangles(mesh)) expect_the_integrals(tagged, {SchemeKind::Loop}, "triangles");
  }
}

TEST(EnergyIntegrals, EveryRuleOfTheSchemeCounts) {
  const Mesh mesh = test::with_random_tags(test::jittered(grid(3, 2), 0.1, 2), 11);
  for (const BoundaryRule boundary : {BoundaryRule::None, BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly}) {
    for (const CreaseMethod creases : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
      Scheme scheme{SchemeKind::CatmullClark, boundary, creases};
      expect_the_integrals(mesh, scheme, "grid");
      scheme.alpha = 0.4;
      expect_the_integrals(mesh, scheme, "grid with alpha");
    }
  }
}

/// All corners and boundaries of a grid are regular patches.
TEST(EnergyIntegrals, ThinPlateIsTheIntegralAtRegularBoundariesAndCreases) {
  Mesh mesh = grid(5, 4);
  const Scheme scheme{SchemeKind::CatmullClark, BoundaryRule::EdgeAndCorner};
  expect_the_integrals(mesh, scheme, "grid", Expected::All);
  for (Index i = 0; i < 5; ++i) mesh.creases.push_back({2 * 6 + i, 2 * 6 + i + 1, 10.0});
  expect_the_integrals(mesh, scheme, "grid with a crease", Expected::All);
}

/// Where the vertices of a fan lie when its sectors are parallelograms around the origin.
Points fan_places(bool quads, Index n) {
  const Mesh mesh = fan(quads, n);
  Points places = Points::Zero(mesh.vertex_count(), 3);
  const auto direction = [&](Index k) {
    const double angle = 2.0 * std::numbers::pi * k / n;
    return Eigen::RowVector3d(std::cos(angle), std::sin(angle), 0.0);
  };
  Index v = 1;
  for (Index k = 0; quads && k < n; ++k) {
    for (Index i = 1; i <= 3; ++i) {
      for (Index j = 0; j <= 3; ++j) places.row(v++) = i * direction(k) + j * direction(k + 1);
    }
  }
  for (Index ring = 1; !quads && ring <= 3; ++ring) {
    for (Index k = 0; k < n; ++k) {
      for (Index j = 0; j < ring; ++j) places.row(v++) = (ring - j) * direction(k) + j * direction(k + 1);
    }
  }
  return places;
}

/// C: the points of the refined fan around the middle by those of the fan. A vertex of the refined fan lies between
/// those that it comes from; drawn out by two it lies where the one of the fan does.
Eigen::MatrixXd fan_step(bool quads, Index n) {
  const Topology topology(fan(quads, n));
  const Index count = topology.vertex_count();
  const Points places = fan_places(quads, n);
  Points between = Points::Zero(count + topology.edge_count() + (quads ? topology.face_count() : 0), 3);
  between.topRows(count) = 2.0 * places;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    between.row(count + e) = places.row(topology.origin(h)) + places.row(topology.destination(h));
  }
  for (Index f = 0; quads && f < topology.face_count(); ++f) {
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      between.row(count + topology.edge_count() + f) += 0.5 * places.row(topology.origin(h));
    }
  }
  const Values refined = refine(topology, scheme_of(quads), Values::Identity(count, count), 1).values;
  Eigen::MatrixXd step(count, count);
  for (Index v = 0; v < count; ++v) {
    Eigen::Index same = 0;
    EXPECT_LT((between.rowwise() - places.row(v)).rowwise().norm().minCoeff(&same), 1e-12);
    step.row(v) = refined.row(same);
  }
  return step;
}

/// The second largest eigenvalue of a smooth interior vertex.
double subdominant(bool quads, Index n) {
  const double c = std::cos(2.0 * std::numbers::pi / n);
  return quads ? (5.0 + c + std::sqrt(2.0 * (9.0 + c)) * std::cos(std::numbers::pi / n)) / 16.0 : 0.375 + 0.25 * c;
}

/// Columns span the null space of a matrix.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& matrix, Index dimension) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullV);
  EXPECT_LT(svd.singularValues().tail(dimension).maxCoeff(), 1e-13);
  return svd.matrixV().rightCols(dimension);
}

/// A frame of eigenvectors around the middle: R of C, L of its transpose.
struct TangentPlane {
  Eigen::MatrixXd right, left;

  TangentPlane(bool quads, Index n) {
    const Eigen::MatrixXd step = fan_step(quads, n);
    const Eigen::MatrixXd shifted = step - subdominant(quads, n) * Eigen::MatrixXd::Identity(step.rows(), step.cols());
    right = null_space(shifted, 2);
    left = null_space(shifted.transpose(), 2);
  }
  Values without(const Values& control) const {
    return control - right * (left.transpose() * right).inverse() * (left.transpose() * control);
  }
};

/// Half the sum over levels k around the middle of `level_factor`^k times what Gauss's rule gives on them, with the
/// exact jets; after each level.
std::vector<double> level_integrals(bool quads, Index n, const Values& control, double level_factor, int levels) {
  const SurfacePatches patches(Topology(fan(quads, n)), scheme_of(quads));
  const LimitSurface surface(patches, control);
  const SurfaceQuadrature quadrature = surface_quadrature(patches, {5, levels});
  const std::vector<double> counted = middle_faces(quads, n);
  std::vector<double> sums(static_cast<std::size_t>(levels) + 1, 0.0);
  for (std::size_t i = 0; i < quadrature.places.size(); ++i) {
    const SurfacePlace& place = quadrature.places[i];
    const int level = -std::ilogb(quads ? std::max(place.u, place.v) : place.u + place.v);
    if (level > levels || counted[place.face] == 0.0) continue;
    sums[level] += 0.5 * std::pow(level_factor, level) * quadrature.weights[i] *
                   integrand(EnergyKind::ThinPlate, quads, surface.jet(place));
  }
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  return sums;
}

/// The limit of a sum whose terms fall by the same factor in the end (Aitken).
double limit_of(const std::vector<double>& sums) {
  const double last = sums[sums.size() - 1] - sums[sums.size() - 2];
  const double before = sums[sums.size() - 2] - sums[sums.size() - 3];
  return std::abs(last) < 1e-14 * sums.back() ? sums.back() : sums.back() - last * last / (last - before);
}

EnergyOptions middle_only(bool quads, Index n) {
  EnergyOptions options;
  options.rigidity = middle_faces(quads, n);
  return options;
}

/// By its definition: the tangent plane's part is taken out of the points, and level k counts (1 / lambda^2 / 4)^k.
TEST(EnergyIntegrals, ThinPlateWithoutAnIntegralIsTheSumOfProjectedLevels) {
  for (const bool quads : {true, false}) {
    for (Index n = quads ? 5 : 7; n <= 12; ++n) {
      const Topology topology(fan(quads, n));
      const SurfaceEnergy energy(topology, scheme_of(quads), middle_only(quads, n));
      const TangentPlane tangents(quads, n);
      const double lambda = subdominant(quads, n);
      const Values control = test::random_values(topology.vertex_count(), 3);
      const Values projected = tangents.without(control);
      const double expected = limit_of(level_integrals(quads, n, projected, 0.25 / (lambda * lambda), 40));
      EXPECT_NEAR(energy.energy(EnergyKind::ThinPlate, control), expected, 1e-7 * expected) << n << quads;
      const Values tangent = control - projected;
      EXPECT_LT(energy.energy(EnergyKind::ThinPlate, tangent), 1e-16 * tangent.squaredNorm()) << n << quads;
    }
  }
}

/// Frobenius norms after 40 levels, as an independent program in another language summed them from the refinement
/// rules.
TEST(EnergyIntegrals, ThinPlateNormsAreThoseOfAnIndependentSum) {
  for (const auto& [n, norm] : {std::pair{5, 4.6400}, std::pair{8, 6.695}, std::pair{12, 11.94}}) {
    const SurfaceEnergy energy(Topology(fan(true, n)), scheme_of(true), middle_only(true, n));
    EXPECT_NEAR(energy.matrix(EnergyKind::ThinPlate).norm(), norm, 1e-3 * norm) << n;
  }
}

TEST(EnergyIntegrals, CutOffThinPlateIsTheIntegralOverSoManyLevels) {
  for (const bool quads : {true, false}) {
    for (const int levels : {1, 5, 9}) {
      const Index n = 8;
      EnergyOptions options = middle_only(quads, n);
      options.cutoff_levels = levels;
      const Topology topology(fan(quads, n));
      const Values control = test::random_values(topology.vertex_count(), 3);
      const double expected = level_integrals(quads, n, control, 1.0, levels).back();
      EXPECT_NEAR(SurfaceEnergy(topology, scheme_of(quads), options).energy(EnergyKind::ThinPlate, control), expected,
                  1e-10 * expected);
    }
  }
}

}  // namespace
}  // namespace batten
