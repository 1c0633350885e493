#include "batten/energy/surface_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "batten/parallel/threads.h"
#include "support/dense.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/values.h"

namespace batten {
namespace {

using Matrix = SurfaceEnergy::Matrix;

constexpr EnergyKind kForms[] = {EnergyKind::Mass, EnergyKind::Membrane, EnergyKind::ThinPlate};

/// No constant has membrane or thin-plate energy, and none has a negative energy of any kind.
TEST(SurfaceEnergy, MatricesAreSymmetricAndPositiveSemidefinite) {
  const auto check = [](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const SurfaceEnergy energy(Topology(mesh), scheme);
    for (const EnergyKind kind :
         {EnergyKind::Mass, EnergyKind::Membrane, EnergyKind::ThinPlate, EnergyKind::Stiffness}) {
      const Eigen::MatrixXd matrix = energy.matrix(kind);
      EXPECT_EQ(matrix, matrix.transpose()) << name;
      const Eigen::VectorXd eigenvalues = test::symmetric_modes(matrix).values;
      const double most = eigenvalues.cwiseAbs().maxCoeff();
      EXPECT_GE(eigenvalues.minCoeff(), -1e-14 * most) << name << ", energy " << static_cast<int>(kind);
      if (kind == EnergyKind::Mass) continue;
      EXPECT_LE(matrix.rowwise().sum().cwiseAbs().maxCoeff(), 1e-13 * most) << name;
    }
  };
  test::for_each_sample([&](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    check(mesh, scheme, name);
    check(test::with_random_tags(mesh, 3), scheme, name + ", tagged");
  });
}

TEST(SurfaceEnergy, FlatGridsHaveNoThinPlateEnergy) {
  Mesh triangles = grid(5, 5);
  test::Faces halves;
  for (const auto& face : test::faces_of(triangles)) {
    halves.push_back({face[0], face[1], face[2]});
    halves.push_back({face[0], face[2], face[3]});
  }
  triangles = test::with_faces(triangles, halves);
  const Scheme corners{SchemeKind::CatmullClark, BoundaryRule::EdgeAndCorner};
  const SurfaceEnergy quads(Topology(grid(5, 5)), corners);
  EXPECT_LT(quads.energy(EnergyKind::ThinPlate, grid(5, 5).points), 1e-26);
  const Scheme loop{SchemeKind::Loop, BoundaryRule::None};
  EXPECT_LT(SurfaceEnergy(Topology(triangles), loop).energy(EnergyKind::ThinPlate, triangles.points), 1e-26);
}

TEST(SurfaceEnergy, MassIsTheAreaOfTheParameters) {
  test::for_each_sample([](Mesh mesh, const Scheme& scheme, const std::string& name) {
    mesh.holes.push_back(0);
    const SurfaceEnergy energy(Topology(mesh), scheme);
    const SurfacePatches& patches = energy.patches();
    Index faces = 0;
    for (Index f = 0; f < patches.base().face_count(); ++f) faces += patches.holes()[f] == 0 ? 1 : 0;
    const Eigen::MatrixXd mass = energy.matrix(EnergyKind::Mass);
    EXPECT_NEAR(mass.sum(), patches.quads() ? faces : 0.5 * faces, 1e-13 * (faces + 1)) << name;
  });
}

TEST(SurfaceEnergy, ApplyAndEnergyAreTheMatrix) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    EnergyOptions options;
    options.tension.clear();
    for (Index f = 0; f < mesh.face_count(); ++f) options.tension.push_back(0.5 * f);
    options.rigidity = {0.25};
    const SurfaceEnergy energy(Topology(mesh), scheme, options);
    for (const Index columns : {1, 3, 5}) {
      for (const EnergyKind kind : {EnergyKind::Mass, EnergyKind::Stiffness}) {
        const Values values = test::random_values(mesh.vertex_count(), columns);
        const Values expected = energy.matrix(kind) * values;
        Values result(values.rows(), columns);
        energy.apply(kind, values, result);
        EXPECT_LE((result - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff()) << name;
        EXPECT_NEAR(energy.energy(kind, values), 0.5 * values.cwiseProduct(expected).sum(), 1e-12 * expected.norm());
      }
    }
  });
}

TEST(SurfaceEnergy, CoefficientsOfFacesAddUp) {
  for (const Mesh& mesh : {dodecahedron(), grid(3, 3)}) {
    const Topology topology(mesh);
    const Values control = test::random_values(mesh.vertex_count(), 3);
    double sum = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      EnergyOptions options;
      options.rigidity.assign(static_cast<std::size_t>(mesh.face_count()), 0.0);
      options.rigidity[f] = 1.0;
      sum += SurfaceEnergy(topology, {}, options).energy(EnergyKind::ThinPlate, control);
    }
    EXPECT_NEAR(sum, SurfaceEnergy(topology, {}).energy(EnergyKind::ThinPlate, control), 1e-12 * sum);
  }
}

/// Other numbers of vertices and faces, and other first corners.
TEST(SurfaceEnergy, NumbersOfVerticesAndFacesDoNotMatter) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Index count = mesh.vertex_count();
    const auto renamed = [&](Index v) { return count - 1 - v; };
    test::Faces faces = test::faces_of(mesh);
    std::reverse(faces.begin(), faces.end());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (Index& v : faces[f]) v = renamed(v);
      std::rotate(faces[f].begin(), faces[f].begin() + 1 + static_cast<std::ptrdiff_t>(f % 2), faces[f].end());
    }
    const SurfaceEnergy energy(Topology(mesh), scheme);
    const SurfaceEnergy other(Topology(test::with_faces(mesh, faces)), scheme);
    const Values control = test::random_values(count, 3);
    const Values reversed = control.colwise().reverse();
    for (const EnergyKind kind : kForms) {
      const double expected = energy.energy(kind, control);
      EXPECT_NEAR(other.energy(kind, reversed), expected, 1e-11 * expected) << name << static_cast<int>(kind);
    }
  });
}

TEST(SurfaceEnergy, ResultsDoNotDependOnTheNumberOfThreads) {
  for (const Mesh& mesh : {test::random_hull(800, 2), test::jittered(torus(40, 30), 0.01, 1)}) {
    const auto results = [&](int threads) {
      const ThreadLimit limit(threads);
      const SurfaceEnergy energy(Topology(mesh), {});
      Values applied(mesh.vertex_count(), 3);
      energy.apply(EnergyKind::Stiffness, mesh.points, applied);
      return std::tuple{Eigen::MatrixXd(energy.matrix(EnergyKind::Stiffness)), applied,
                        energy.energy(EnergyKind::Mass, mesh.points)};
    };
    EXPECT_EQ(results(1), results(2));
  }
}

TEST(SurfaceEnergy, VerticesWithoutFacesHaveEmptyRows) {
  const Mesh mesh = test::mesh_of_faces(6, {{0, 1, 2, 3}});
  const Matrix matrix = SurfaceEnergy(Topology(mesh), {}).matrix(EnergyKind::Mass);
  EXPECT_EQ(matrix.rows(), 6);
  EXPECT_EQ(matrix.row(5).nonZeros(), 0);
}

TEST(SurfaceEnergy, TooManyFacesAroundAVertexAreNamed) {
  const Mesh fan = test::bipyramid(600);
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const SurfacePatches patches(Topology(fan), Scheme{kind});
    test::expect_error([&] { SurfaceEnergy{patches}; }, ErrorCode::TooLarge, "face 0");
  }
  const SurfacePatches accepted(Topology(test::bipyramid(40)), Scheme{SchemeKind::Loop});
  EXPECT_GT(SurfaceEnergy(accepted).energy(EnergyKind::Membrane, test::bipyramid(40).points), 0.0);
}

TEST(SurfaceEnergy, BadCoefficientsAreErrors) {
  const Topology topology(cube());
  const auto build = [&](const std::vector<double>& tension) {
    return [&topology, tension] {
      EnergyOptions options;
      options.tension = tension;
      SurfaceEnergy(topology, {}, options);
    };
  };
  test::expect_error(build({1.0, 2.0}), ErrorCode::BadShape, "6 faces");
  test::expect_error(build({}), ErrorCode::BadShape, "tension");
  test::expect_error(build({1.0, 1.0, -1.0, 1.0, 1.0, 1.0}), ErrorCode::BadArgument, "face 2 is negative");
  test::expect_error(build({std::nan("")}), ErrorCode::NotFinite, "tension");
  EnergyOptions options;
  options.cutoff_levels = 0;
  test::expect_error([&] { SurfaceEnergy(topology, {}, options); }, ErrorCode::BadArgument, "cut-off");
  test::expect_error([&] { SurfaceEnergy(Topology(icosahedron()), {SchemeKind::Butterfly}); }, ErrorCode::BadArgument,
                     "Butterfly");
  const SurfaceEnergy energy(topology, {});
  Values result(8, 3);
  test::expect_error([&] { energy.energy(EnergyKind::Mass, Values::Zero(7, 3)); }, ErrorCode::BadShape, "7 rows");
  test::expect_error([&] { energy.apply(EnergyKind::Mass, Values::Zero(8, 2), result); }, ErrorCode::BadShape, "");
  test::expect_error([&] { energy.energy(EnergyKind::Mass, Values::Constant(8, 1, std::nan(""))); },
                     ErrorCode::NotFinite, "row 0");
}

}  // namespace
}  // namespace batten
