#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "batten/error.h"
#include "batten/refine/vertex_blend.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"
#include "support/shapes.h"

namespace batten::test {
namespace {

/// Both sides sum the same weights in double, in another order: a dozen roundings a level, 1e-15 of the diagonal each.
constexpr double kRefinedTolerance = 1e-12;

double worst_row(ConstValuesRef a, ConstValuesRef b) {
  const Eigen::VectorXd distances = (a - b).rowwise().norm();
  return distances.allFinite() ? distances.maxCoeff() : std::numeric_limits<double>::infinity();
}

/// Bit for bit: sharpness decides which rule holds, and when.
void expect_same_tags(const Oracle& oracle, const Scheme& scheme, int level) {
  const Topology& topology = oracle.topology(level);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    const float sharpness = vertex_sharpness(topology, scheme, v);
    ASSERT_EQ(sharpness, oracle.vertex_sharpness(level, v)) << "vertex " << v << " of level " << level;
  }
  for (Index e = 0; e < topology.edge_count(); ++e) {
    ASSERT_EQ(topology.edge_sharpness(e), oracle.edge_sharpness(level, e)) << "edge " << e << " of level " << level;
  }
  if (scheme.boundary == BoundaryRule::None) return;  // there OpenSubdiv counts the faces at the boundary as holes
  for (Index f = 0; f < topology.face_count(); ++f) {
    ASSERT_EQ(topology.is_hole(f), oracle.is_hole(level, f)) << "face " << f << " of level " << level;
  }
}

void expect_same_levels(const Mesh& mesh, const Scheme& scheme, int levels) {
  const Oracle oracle(mesh, scheme, levels);
  const double diagonal = bounding_diagonal(mesh.points);
  Values values = mesh.points;
  for (int level = 1; level <= levels; ++level) {
    values = Refinement(oracle.topology(level - 1), scheme).apply(values);
    const double worst = worst_row(values, oracle.positions(level)) / diagonal;
    EXPECT_LE(worst, kRefinedTolerance) << "level " << level;
    expect_same_tags(oracle, scheme, level);
  }
}

// Each shape with the scheme, boundary, crease and triangle rule that its file asks for.

class Shapes : public ShapeTest {};
INSTANTIATE_TEST_SUITE_P(Conformance, Shapes, ::testing::ValuesIn(shape_names()), test_name);

TEST_P(Shapes, RefineAsOpenSubdivDoes) { expect_same_levels(mesh, scheme, 3); }

TEST_P(Shapes, RefineAsOpenSubdivDoesUnderEveryBoundaryRule) {
  for_each_boundary_rule([&](const Scheme& each) { expect_same_levels(mesh, each, 2); });
}

TEST_P(Shapes, HaveTheFacesThatOpenSubdivHidesWithoutABoundary) {
  scheme.boundary = BoundaryRule::None;
  const Oracle oracle(mesh, scheme, 0);
  const Buffer<std::uint8_t> holes = surface_holes(oracle.topology(0), scheme);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    EXPECT_EQ(!holes.empty() && holes[f] != 0, oracle.is_hole(0, f)) << "face " << f;
  }
}

TEST_P(Shapes, RefineAsOpenSubdivDoesWithTheSmoothTriangleRule) {
  take_smooth_triangles();
  expect_same_levels(mesh, scheme, 2);
}

TEST_P(Shapes, RefineAsOpenSubdivDoesWithChaikinsCreases) {
  scheme.crease_method = CreaseMethod::Chaikin;
  expect_same_levels(mesh, scheme, 3);
}

// Chance tags: every mixture of sharpness that a vertex can meet, fading at different levels.

TEST_P(Shapes, RefineAsOpenSubdivDoesWithRandomTags) {
  scheme.crease_method = CreaseMethod::Uniform;
  for (unsigned seed = 0; seed < 4; ++seed) expect_same_levels(with_random_tags(mesh, seed), scheme, 3);
}

/// Chaikin's rule can end a sharpness above 1 in one step, beside edges that are hardly sharp. Then the edge point is
/// the midpoint here; OpenSubdiv, which does not clamp the weight w there (its own note in sdc/scheme.h says that it
/// should), extrapolates to w midpoint + (1 - w) smooth.
bool ends_above_one(const Topology& parent, const Topology& child, Index e) {
  if (parent.is_boundary_edge(e) || parent.edge_sharpness(e) <= 1.0F) return false;
  return !is_sharp(child.edge_sharpness(2 * e)) || !is_sharp(child.edge_sharpness(2 * e + 1));
}

/// One step from OpenSubdiv's own values, so that a deviation shows only where it arises.
void expect_same_steps(const Oracle& oracle, const Scheme& scheme, double diagonal) {
  for (int level = 1; level <= oracle.max_level(); ++level) {
    const Topology& parent = oracle.topology(level - 1);
    const Values before = oracle.positions(level - 1);
    const Values after = oracle.positions(level);
    Values ours = Refinement(parent, scheme).apply(before);
    TopologyTables tables = parent.tables();
    tables.edge_sharpness.clear();
    const Topology untagged = Topology::from_tables(std::move(tables));
    const Values smooth = Refinement(untagged, scheme).apply(before);
    for (Index e = 0; e < parent.edge_count(); ++e) {
      if (!ends_above_one(parent, oracle.topology(level), e)) continue;
      const Index row = parent.vertex_count() + e;
      const double weight = parent.edge_sharpness(e);
      ours.row(row) = weight * ours.row(row) + (1.0 - weight) * smooth.row(row);
    }
    EXPECT_LE(worst_row(ours, after), kRefinedTolerance * diagonal) << "level " << level;
  }
}

TEST_P(Shapes, RefineAsOpenSubdivDoesWithRandomTagsAndChaikinsCreases) {
  scheme.crease_method = CreaseMethod::Chaikin;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Oracle oracle(with_random_tags(mesh, seed), scheme, 3);
    expect_same_steps(oracle, scheme, bounding_diagonal(mesh.points));
    for (int level = 0; level <= 3; ++level) expect_same_tags(oracle, scheme, level);
  }
}

TEST(Conformance, OpenSubdivExtrapolatesWhereChaikinEndsASharpnessAboveOne) {
  Mesh mesh = cube();
  mesh.creases = {{0, 1, 1.25}, {0, 3, 0.125}, {1, 2, 0.125}};
  Scheme scheme;
  scheme.crease_method = CreaseMethod::Chaikin;
  const Oracle oracle(mesh, scheme, 1);
  Index ended = 0;
  for (Index e = 0; e < 12; ++e) ended += ends_above_one(oracle.topology(0), oracle.topology(1), e) ? 1 : 0;
  EXPECT_EQ(ended, 1);  // 3/4 1.25 + 1/4 0.125 - 1 < 0
  expect_same_steps(oracle, scheme, bounding_diagonal(mesh.points));
}

// Real models, triangles under both schemes.

class Models : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Conformance, Models, ::testing::ValuesIn(model_names()), test_name);

TEST_P(Models, RefineAsOpenSubdivDoes) {
  BATTEN_REQUIRE_DATA();
  const Mesh mesh = load_model(GetParam());
  Scheme scheme;
  scheme.boundary = mesh.boundary.value_or(scheme.boundary);
  const int levels = mesh.face_count() > 40000 ? 1 : 2;
  expect_same_levels(mesh, scheme, levels);
  if (!all_triangles(mesh)) return;
  scheme.kind = SchemeKind::Loop;
  expect_same_levels(mesh, scheme, levels);
}

// Every file of the data is either compared above or refused here.

TEST(Conformance, FilesThatAreNoManifoldAreRefusedWithTheReason) {
  BATTEN_REQUIRE_DATA();
  for (const RefusedFile& file : refused_files()) {
    const Mesh mesh = read_mesh(data_folder() + "/" + file.path + ".obj");
    try {
      const Topology topology(mesh);
      ADD_FAILURE() << file.path << " is accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), file.code) << file.path << ": " << error.what();
      EXPECT_NE(std::string(error.what()).find(file.reason), std::string::npos) << file.path << ": " << error.what();
    }
  }
}

TEST(Conformance, EveryFileIsComparedOrRefused) {
  BATTEN_REQUIRE_DATA();
  std::set<std::string> known;
  for (const std::string& name : shape_names()) known.insert("osd-shapes/" + name);
  for (const std::string& name : model_names()) known.insert("meshes/" + name);
  for (const RefusedFile& file : refused_files()) known.insert(file.path);
  std::set<std::string> found;
  for (const char* folder : {"osd-shapes", "meshes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(data_folder() + "/" + folder)) {
      if (entry.path().extension() == ".obj") found.insert(std::string(folder) + "/" + entry.path().stem().string());
    }
  }
  EXPECT_EQ(found, known);
}

}  // namespace
}  // namespace batten::test
