#include "batten/interpolate/interpolated_mesh.h"

#include <gtest/gtest.h>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/face_varying_limit.h"
#include "io/io_test_tools.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// A cube that no Catmull-Clark surface passes through as it is, with all that can hang on a mesh.
Mesh dressed_cube() {
  Mesh mesh = cube();
  mesh.points(0, 0) += 0.3;
  mesh.points(5, 1) -= 0.2;
  const Values color = 0.5 + 0.3 * mesh.points.array().sin();
  Attribute uv{"uv", Values(24, 2), Buffer<Index>(24)};
  for (Index i = 0; i < 24; ++i) {
    uv.values.row(i) << (i % 4 == 1 || i % 4 == 2 ? 1.0 : 0.0), (i % 4 > 1 ? 1.0 : 0.0);
    uv.corner_rows[i] = i;
  }
  mesh.attributes = {{"color", color, {}}, uv, {"normal", mesh.points, {}}};
  mesh.groups = {{"g", "front", 0}, {"usemtl", "red", 2}, {"usemtl", "blue", 5}};
  mesh.material_libraries = {"paints.mtl"};
  return mesh;
}

/// Another mesh beside the first one; its tags are dropped.
Mesh beside(Mesh mesh, const Mesh& other, const Eigen::RowVector3d& shift, double scale = 1.0) {
  const Index first = mesh.vertex_count();
  mesh.points.conservativeResize(first + other.vertex_count(), 3);
  mesh.points.bottomRows(other.vertex_count()) = (scale * other.points).rowwise() + shift;
  for (Index f = 0; f < other.face_count(); ++f) {
    for (Index i = other.face_offsets[f]; i < other.face_offsets[f + 1]; ++i) {
      mesh.face_vertices.push_back(first + other.face_vertices[i]);
    }
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  return mesh;
}

const Attribute& attribute_of(const Mesh& mesh, const std::string& name) {
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name == name) return attribute;
  }
  throw Error(ErrorCode::BadArgument, "no " + name);
}

/// How far the surface that a program makes of the mesh is from these values at the first vertices.
double missed(const Mesh& control, ConstValuesRef values, ConstValuesRef targets) {
  const Topology topology(control);
  const Values limit = LimitMatrix(topology, choose_scheme(control)).apply(values);
  return (limit.topRows(targets.rows()) - targets).rowwise().norm().maxCoeff();
}

TEST(InterpolatedMesh, AWrittenCubeHasItsPointsAndColoursOnItsSurface) {
  const Mesh given = dressed_cube();
  const InterpolatedMesh result = interpolate(given);
  EXPECT_TRUE(result.converged());
  EXPECT_TRUE(result.is_refined);
  const io_tests::TemporaryFolder folder;
  write_mesh(folder.path("cube.ply"), result.mesh);
  const Mesh read = read_mesh(folder.path("cube.ply"));
  ASSERT_EQ(read.vertex_count(), 8 + 12 + 6);
  EXPECT_LE(missed(read, read.points, given.points), 1e-10 * bounding_diagonal(given.points));
  const Values& color = attribute_of(given, "color").values;
  EXPECT_LE(missed(read, attribute_of(read, "color").values, color), 1e-10 * bounding_diagonal(color));
}

TEST(InterpolatedMesh, GroupsMaterialsAndTextureFollowTheFacesOfACubeThatIsRefined) {
  const Mesh given = dressed_cube();
  const Mesh control = interpolate(given).mesh;
  ASSERT_EQ(control.groups.size(), 3U);
  EXPECT_EQ(control.groups[1].first_face, 8);  // four children a face
  EXPECT_EQ(control.groups[2].first_face, 20);
  EXPECT_EQ(control.groups[2].name, "blue");
  EXPECT_EQ(control.material_libraries, given.material_libraries);
  const Attribute& uv = attribute_of(control, "uv");
  ASSERT_EQ(uv.corner_rows.size(), control.face_vertices.size());
  for (Index f = 0; f < 24; ++f) {
    // Of each child the first corner is the parent's, the third its centre.
    EXPECT_EQ(uv.values.row(uv.corner_rows[4 * f]), attribute_of(given, "uv").values.row(f));
    EXPECT_EQ(uv.values.row(uv.corner_rows[4 * f + 2]), Eigen::RowVector2d(0.5, 0.5));
  }
  for (const Attribute& attribute : control.attributes) EXPECT_NE(attribute.name, "normal");
}

TEST(InterpolatedMesh, AnotherComponentStaysAsItIsBesideTheCubeThatIsRefined) {
  Mesh given = beside(dressed_cube(), grid(5, 4), {6, 0, 0});
  given.attributes.clear();
  given.creases = {{given.face_vertices[24 + 1], given.face_vertices[24 + 2], 1.5}};
  given.corners = {{given.face_vertices[24 + 2], kInfiniteSharpness}};
  given.holes = {9};
  const InterpolatedMesh result = interpolate(given);
  ASSERT_TRUE(result.is_refined);
  EXPECT_EQ(result.mesh.vertex_count(), given.vertex_count() + 12 + 6);
  EXPECT_EQ(result.mesh.face_count(), 24 + 20);
  ASSERT_EQ(result.mesh.creases.size(), 1U);
  EXPECT_EQ(result.mesh.creases[0].sharpness, 1.5);
  EXPECT_EQ(result.mesh.corners.size(), 1U);
  EXPECT_EQ(result.mesh.holes, (std::vector<Index>{24 + 3}));
  for (std::ptrdiff_t c = 24; c < static_cast<std::ptrdiff_t>(given.face_vertices.size()); ++c) {
    EXPECT_EQ(result.mesh.face_vertices[c + 24 * 3], given.face_vertices[c]);
  }
  EXPECT_LE(missed(result.mesh, result.mesh.points, given.points), 1e-10 * bounding_diagonal(given.points));
  // Each component is what it is by itself.
  const Mesh alone = interpolate(dressed_cube()).mesh;
  EXPECT_LE((result.mesh.points.topRows(8) - alone.points.topRows(8)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LE((result.mesh.points.bottomRows(18) - alone.points.bottomRows(18)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(InterpolatedMesh, ComponentsInAnyOrderKeepGroupsAndTexture) {
  const Mesh dressed = dressed_cube();
  Mesh given = beside(grid(2, 2), dressed, {6, 0, 0});
  given.groups = {{"g", "sheet", 0}, {"g", "cube", 4}, {"g", "half", 6}};
  Values uv(28, 2);
  uv.topRows(24) = attribute_of(dressed, "uv").values;
  uv.bottomRows(4) << 0, 0, 1, 0, 1, 1, 0, 1;
  Buffer<Index> rows{24, 25, 26, 27, 24, 25, 26, 27, 24, 25, 26, 27, -1, -1, -1, -1};
  const Attribute& own = attribute_of(dressed, "uv");
  rows.insert(rows.end(), own.corner_rows.begin(), own.corner_rows.end());
  given.attributes = {{"uv", uv, rows}, {"height", given.points.col(2), {}}};
  const InterpolatedMesh result = interpolate(given);
  ASSERT_EQ(result.mesh.face_count(), 4 + 24);
  EXPECT_EQ(result.mesh.groups[1].first_face, 4);
  EXPECT_EQ(result.mesh.groups[2].first_face, 4 + 8);
  const Attribute& refined = attribute_of(result.mesh, "uv");
  EXPECT_TRUE(std::equal(rows.begin(), rows.begin() + 16, refined.corner_rows.begin()));
  EXPECT_EQ(refined.values.topRows(28), uv);
  const Attribute whole = refine_at_corners(Topology(given), SchemeKind::CatmullClark, given.attributes[0]);
  EXPECT_LT(refined.values.rows(), whole.values.rows());
  for (std::ptrdiff_t c = 0; c < 96; ++c) {
    EXPECT_EQ(refined.values.row(refined.corner_rows[16 + c]), whole.values.row(whole.corner_rows[64 + c]));
  }
  EXPECT_LE(missed(result.mesh, attribute_of(result.mesh, "height").values, given.points.col(2)), 1e-9);
}

/// Rows that both components have must not move on the one that stays as it is.
TEST(InterpolatedMesh, ASmoothTextureIsThatOfTheMeshGiven) {
  Mesh given = beside(grid(2, 2), dressed_cube(), {6, 0, 0});
  Attribute uv{"uv", Values::Random(20, 2), Buffer<Index>()};
  for (std::size_t c = 0; c < given.face_vertices.size(); ++c) {
    uv.corner_rows.push_back(c % 7 == 3 ? static_cast<Index>(c % 20) : given.face_vertices[c]);
  }
  given.attributes = {uv};
  for (const FaceVaryingRule rule :
       {FaceVaryingRule::None, FaceVaryingRule::CornersOnly, FaceVaryingRule::Boundaries}) {
    given.face_varying = rule;
    const InterpolatedMesh result = interpolate(given);
    ASSERT_EQ(result.mesh.face_count(), 4 + 24);
    EXPECT_EQ(result.mesh.face_varying, rule);
    const Attribute before = face_varying_limit(Topology(given), choose_scheme(given), uv, 0);
    const Attribute after = face_varying_limit(result.topology, result.scheme, attribute_of(result.mesh, "uv"), 0);
    for (std::ptrdiff_t c = 0; c < 40; ++c) {
      const std::ptrdiff_t same = c < 16 ? c : 16 + 4 * (c - 16);  // the first corner of a child is the parent's
      const Eigen::RowVector2d moved =
          after.values.row(after.corner_rows[same]) - before.values.row(before.corner_rows[c]);
      EXPECT_LE(moved.norm(), 1e-14) << c;
    }
  }
}

TEST(InterpolatedMesh, EverythingIsRefinedWhereThatIsAsked) {
  Mesh given = beside(dressed_cube(), grid(5, 4), {6, 0, 0});
  given.attributes.clear();
  InterpolateOptions options;
  options.refined = RefinedExtent::Everything;
  const InterpolatedMesh result = interpolate(given, options);
  EXPECT_EQ(result.mesh.face_count(), 24 + 80);
  EXPECT_LE(missed(result.mesh, result.mesh.points, given.points), 1e-10 * bounding_diagonal(given.points));
}

TEST(InterpolatedMesh, NothingIsRefinedWhereTheSurfaceExists) {
  Mesh given = dressed_cube();
  given.points = cube().points;
  given.attributes.resize(2);
  given.attributes[0].values = given.points;
  const Topology topology(given);
  const InterpolatedMesh result = interpolate(Interpolator(topology, Scheme()), given);
  EXPECT_FALSE(result.is_refined);
  EXPECT_EQ(&result.topology.tables(), &topology.tables());  // the same handle
  EXPECT_EQ(result.mesh.groups.size(), given.groups.size());
  EXPECT_EQ(result.mesh.scheme, SchemeKind::CatmullClark);
}

/// Black and white by turns: the values that are farthest from those of any Catmull-Clark surface on a cube.
Mesh chequered_cube() {
  Mesh mesh = cube();
  Values color(8, 3);
  for (Index v = 0; v < 8; ++v) color.row(v).setConstant(mesh.points.row(v).prod() > 0.0 ? 1.0 : 0.0);
  mesh.attributes = {{"color", color, {}}};
  return mesh;
}

TEST(InterpolatedMesh, ColoursThatNeedAlphaTakeThePointsAlong) {
  const Mesh given = chequered_cube();
  const InterpolatedMesh result = interpolate(given);
  EXPECT_TRUE(result.converged());
  ASSERT_TRUE(result.is_refined);
  EXPECT_LE(missed(result.mesh, result.mesh.points, given.points), 1e-10 * bounding_diagonal(given.points));
  const Values& color = given.attributes[0].values;
  EXPECT_LE(missed(result.mesh, result.mesh.attributes[0].values, color), 1e-10 * bounding_diagonal(color));
}

TEST(InterpolatedMesh, ColoursWithoutASurfaceAreNamedAndJudgedByThemselves) {
  const Mesh given = chequered_cube();
  InterpolateOptions options;
  options.on_singular = OnSingular::Refuse;
  io_tests::expect_error([&] { interpolate(given, options); }, ErrorCode::SingularSystem, "'color' on the component");
  options.on_singular = OnSingular::LeastSquares;
  const InterpolatedMesh result = interpolate(given, options);
  ASSERT_EQ(result.reports.size(), 2U);
  EXPECT_EQ(result.reports[0].outcome, Outcome::Reached);
  EXPECT_EQ(result.reports[1].name, "color");
  EXPECT_EQ(result.reports[1].outcome, Outcome::LeastSquares);
  EXPECT_NEAR(result.reports[1].max_error, 0.5 * std::sqrt(3.0), 1e-9);
}

TEST(InterpolatedMesh, ANumberThatIsNotFiniteIsNamedWithItsVertex) {
  Mesh given = dressed_cube();
  given.attributes[0].values(6, 1) = std::nan("");
  io_tests::expect_error([&] { interpolate(given); }, ErrorCode::NotFinite, "color of vertex 6");
}

TEST(InterpolatedMesh, AlphaOfTheSchemeItselfEndsWithTheFirstStep) {
  Mesh given = dressed_cube();
  Scheme scheme;
  scheme.alpha = 0.7;
  const Topology topology(given);
  const InterpolatedMesh result = interpolate(Interpolator(topology, scheme), given);
  ASSERT_TRUE(result.is_refined);
  EXPECT_LE(missed(result.mesh, result.mesh.points, given.points), 1e-10 * bounding_diagonal(given.points));
}

TEST(InterpolatedMesh, FacesThatABoundaryRuleLeavesOutStayOutWhenRefined) {
  Mesh given = beside(dressed_cube(), grid(5, 5), {6, 0, 0});
  given.attributes.clear();
  given.boundary = BoundaryRule::None;
  const InterpolatedMesh result = interpolate(given);
  ASSERT_TRUE(result.is_refined);
  const Topology topology(given);
  const Buffer<std::uint8_t> holes = surface_holes(topology, choose_scheme(given));
  EXPECT_EQ(static_cast<std::ptrdiff_t>(result.mesh.holes.size()), 4 * std::count(holes.begin(), holes.end(), 1));
}

}  // namespace
}  // namespace batten
