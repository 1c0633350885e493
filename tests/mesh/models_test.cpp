/// The sample models: the generator's meshes are sound, and the files in models/ are its output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/interpolate/interpolated_mesh.h"
#include "batten/io/io.h"
#include "batten/medial/medial_boundary.h"
#include "batten/medial/medial_check.h"
#include "batten/medial/medial_io.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/summary.h"
#include "batten/mesh/topology.h"
#include "mesh/manifold.h"
#include "shapes.h"
#include "support/source_folder.h"

namespace batten {
namespace {

struct Expectation {
  const char* name;
  Index boundary_loops;
  Index euler;  ///< V - E + F: 2 - 2 handles - boundary loops
  bool quads;
};

const std::vector<Expectation>& expectations() {
  static const std::vector<Expectation> list = {
      {"pipe-joint", 4, -2, true},  {"coarse-joint", 4, -2, false}, {"pyramid", 0, 2, false},
      {"lifted-grid", 1, 1, true},  {"tripod", 0, 2, true},         {"torus-knot", 0, 0, true},
      {"bracket", 0, -6, true},     {"creature", 0, 2, true},       {"bracket-scan", 0, -6, true},
      {"tetrahedron", 0, 2, false}, {"cube", 0, 2, true},           {"dented-cube", 0, 2, true},
      {"octahedron", 0, 2, false},  {"dodecahedron", 0, 2, false},  {"icosahedron", 0, 2, false},
      {"ring", 0, 0, true}};
  return list;
}

const std::vector<models::Model>& made() {
  static const std::vector<models::Model> list = models::all_models();
  return list;
}

TEST(Models, AreOrientedManifoldsOfTheIntendedShape) {
  ASSERT_EQ(made().size(), expectations().size());
  for (std::size_t i = 0; i < made().size(); ++i) {
    const Mesh& mesh = made()[i].mesh;
    const Expectation& expected = expectations()[i];
    EXPECT_EQ(made()[i].name, expected.name);
    const test::ManifoldReport report = test::examine(mesh);
    ASSERT_TRUE(report.valid) << expected.name << ": " << report.reason;
    EXPECT_EQ(report.boundary_loop_count, expected.boundary_loops) << expected.name;
    EXPECT_EQ(report.component_count, 1) << expected.name;
    EXPECT_EQ(report.euler, expected.euler) << expected.name;
    EXPECT_GT(report.volume, 0.0) << expected.name;
    if (expected.quads) {
      for (Index f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(mesh.face_size(f), 4) << expected.name;
    }
    EXPECT_NO_THROW(Topology{mesh}) << expected.name;
  }
}

TEST(Models, HaveNoTinyAndNoHugeEdges) {
  for (const models::Model& model : made()) {
    if (model.name == "bracket-scan") continue;  // its noise makes edges of any length
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    for (Index f = 0; f < model.mesh.face_count(); ++f) {
      const Index size = model.mesh.face_size(f);
      for (Index c = 0; c < size; ++c) {
        const Index a = model.mesh.face_vertices[model.mesh.face_offsets[f] + c];
        const Index b = model.mesh.face_vertices[model.mesh.face_offsets[f] + (c + 1) % size];
        const double length = (model.mesh.points.row(a) - model.mesh.points.row(b)).norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      }
    }
    EXPECT_LT(longest, 5.0 * shortest) << model.name << ": " << shortest << " to " << longest;
  }
}

const Mesh& model(const std::string& name) {
  const auto at = std::find_if(made().begin(), made().end(), [&](const models::Model& m) { return m.name == name; });
  return at->mesh;
}

TEST(Models, PipesAreRound) {
  const Mesh& mesh = model("pipe-joint");
  Index on_circles = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::RowVector3d p = mesh.points.row(v);
    const double reach = std::max(std::abs(p.x()), std::abs(p.y()));
    if (reach < 2.2) continue;
    ++on_circles;
    const double side = std::abs(p.x()) > std::abs(p.y()) ? p.y() : p.x();
    EXPECT_NEAR(std::hypot(side, p.z()), 1.0, 1e-4);
  }
  EXPECT_GT(on_circles, 100);
}

TEST(Models, BracketHasSharpAndSemiSharpCreases) {
  const Mesh& mesh = model("bracket");
  const auto count = [&](double sharpness) {
    return std::count_if(mesh.creases.begin(), mesh.creases.end(),
                         [&](const Crease& c) { return c.sharpness == sharpness; });
  };
  EXPECT_GT(count(10.0), 100);
  EXPECT_GT(count(2.5), 10);
  EXPECT_EQ(count(10.0) + count(2.5), static_cast<std::ptrdiff_t>(mesh.creases.size()));
}

TEST(Models, CreatureIsMirrored) {
  const Mesh& mesh = model("creature");
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::RowVector3d twin(-mesh.points(v, 0), mesh.points(v, 1), mesh.points(v, 2));
    EXPECT_LT((mesh.points.rowwise() - twin).rowwise().norm().minCoeff(), 1e-9);
  }
}

TEST(Models, TheBallHasTheCreaturesFacesAndNoneIsTurnedOver) {
  const Mesh ball = models::morph_models().at(0).mesh;
  const Mesh& creature = model("creature");
  EXPECT_EQ(ball.face_vertices, creature.face_vertices);
  const Eigen::RowVector3d centre = creature.points.colwise().mean();
  const auto at = [&](Index corner) {
    return Eigen::RowVector3d(ball.points.row(ball.face_vertices[corner]) - centre);
  };
  for (Index f = 0; f < ball.face_count(); ++f) {
    for (Index k = 0; k < 4; ++k) EXPECT_NEAR(at(4 * f + k).norm(), 3.0, 2e-4);
    const Eigen::RowVector3d across = at(4 * f + 2) - at(4 * f);
    EXPECT_GT(across.cross(Eigen::RowVector3d(at(4 * f + 3) - at(4 * f + 1))).dot(at(4 * f)), 0.0);
  }
}

TEST(Models, TheHornIsOnePointOfTheCreature) {
  const Mesh horned = models::morph_models().at(1).mesh;
  const Mesh& creature = model("creature");
  EXPECT_EQ(horned.face_vertices, creature.face_vertices);
  EXPECT_EQ(((horned.points - creature.points).rowwise().norm().array() > 0.0).count(), 1);
}

TEST(Models, TheBrokenTripodIsMendedIntoTheTripod) {
  const Mesh broken = models::broken_models().at(0).mesh;
  const RepairResult result = repair(broken);
  std::vector<RepairKind> kinds;
  for (const RepairChange& change : result.changes) kinds.push_back(change.kind);
  EXPECT_EQ(kinds,
            (std::vector<RepairKind>{RepairKind::DegenerateFaces, RepairKind::RepeatedFaces, RepairKind::SplitEdges,
                                     RepairKind::ReversedFaces, RepairKind::SplitVertices, RepairKind::WeldedVertices,
                                     RepairKind::IsolatedVertices}));
  const MeshSummary summary = summarize(Topology(result.mesh));
  ASSERT_EQ(summary.components.size(), 2U);  // and the fin
  const Mesh& tripod = model("tripod");
  EXPECT_EQ(summary.components[0].vertices, tripod.vertex_count());
  EXPECT_EQ(summary.components[0].faces, tripod.face_count());
  EXPECT_TRUE(summary.components[0].closed());
}

TEST(Models, TheTripodsScanIsMendedIntoOneClosedSurface) {
  const models::Model scan = models::broken_models().at(1);
  EXPECT_EQ(scan.name, "tripod-scan");
  const RepairResult result = repair(scan.mesh);
  const MeshSummary summary = summarize(Topology(result.mesh));
  ASSERT_EQ(summary.components.size(), 1U);
  EXPECT_TRUE(summary.components[0].closed());
  EXPECT_EQ(summary.components[0].faces, 16 * model("tripod").face_count());
}

/// A cube's points have a surface where their alternating sum vanishes: a corner pushed in by d misses by d/8.
TEST(Models, TheDentedCubeHasNoSurface) {
  const Mesh& mesh = model("dented-cube");
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Index v = 0; v < 8; ++v) {
    const bool is_odd = ((v % 4) + (v / 4)) % 2 != 0;
    sum += (is_odd ? -1.0 : 1.0) * mesh.points.row(v);
  }
  EXPECT_NEAR(sum.norm() / 8.0, 0.1 * std::sqrt(3.0), 1e-12);
  InterpolateOptions options;
  options.on_singular = OnSingular::LeastSquares;
  const InterpolatedMesh result = interpolate(mesh, options);
  EXPECT_NEAR(result.reports.front().max_error, 0.1 * std::sqrt(3.0), 1e-9);
}

TEST(Models, FilesAreWhatTheGeneratorMakes) {
  std::vector<models::Model> all = made();
  for (const models::Model& broken : models::broken_models()) all.push_back(broken);
  for (const models::Model& morphed : models::morph_models()) all.push_back(morphed);
  for (const models::Model& elastic : models::elastic_models()) all.push_back(elastic);
  for (const models::Model& expected : all) {
    const Mesh file = read_mesh(test::source_folder() + "/models/" + expected.name + ".obj");
    ASSERT_EQ(file.vertex_count(), expected.mesh.vertex_count()) << expected.name;
    // A sine's last bit may round to the next grain on another machine.
    EXPECT_LT((file.points - expected.mesh.points).cwiseAbs().maxCoeff(), 2e-4) << expected.name;
    EXPECT_EQ(file.face_offsets, expected.mesh.face_offsets) << expected.name;
    EXPECT_EQ(file.face_vertices, expected.mesh.face_vertices) << expected.name;
    ASSERT_EQ(file.creases.size(), expected.mesh.creases.size()) << expected.name;
    for (std::size_t i = 0; i < file.creases.size(); ++i) {
      EXPECT_EQ(file.creases[i].a, expected.mesh.creases[i].a);
      EXPECT_EQ(file.creases[i].b, expected.mesh.creases[i].b);
      EXPECT_EQ(file.creases[i].sharpness, expected.mesh.creases[i].sharpness);
    }
  }
}

/// Their spokes are Blum's, do not pass each other, and the files hold them.
TEST(Models, MedialModelsAreSound) {
  for (const models::MedialSample& sample : models::medial_models()) {
    const MedialModel file = read_medial(test::source_folder() + "/models/" + sample.file);
    ASSERT_EQ(file.figures.size(), sample.model.figures.size()) << sample.file;
    for (std::size_t i = 0; i < file.figures.size(); ++i) {
      EXPECT_LT((file.figures[i].sheet.points - sample.model.figures[i].sheet.points).cwiseAbs().maxCoeff(), 2e-4);
      EXPECT_LT((file.figures[i].up - sample.model.figures[i].up).cwiseAbs().maxCoeff(), 2e-4);
      EXPECT_LT((file.figures[i].down - sample.model.figures[i].down).cwiseAbs().maxCoeff(), 2e-4);
    }
    const MedialBoundary boundary = medial_boundary(file);
    const test::ManifoldReport report = test::examine(boundary.mesh);
    ASSERT_TRUE(report.valid) << sample.file << ": " << report.reason;
    EXPECT_EQ(report.boundary_loop_count, 0) << sample.file;
    EXPECT_EQ(report.euler, 2) << sample.file;
    EXPECT_GT(report.volume, 0.0) << sample.file;
    const SpokeCheck check = check_spokes(boundary);
    EXPECT_TRUE(check.crossings.empty()) << sample.file;
    EXPECT_LT(check.max_length_difference, 1e-3) << sample.file;
  }
}

}  // namespace
}  // namespace batten
