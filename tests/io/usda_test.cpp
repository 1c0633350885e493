/// Written USD text, compared with the documented schema.
#include <map>
#include <set>
#include <sstream>

#include "batten/io/crease_chains.h"
#include "batten/mesh/primitives.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

/// Names and types as OpenUSD's pxr/usd/usdGeom/schema.usda declares them for Mesh, what it inherits (PointBased,
/// Gprim, Boundable, Xformable) and GeomSubset; primvars:st and its type from the "USD preview surface" convention, the
/// indices from UsdGeomPrimvar.
const std::map<std::string, std::string> kSchema = {
    {"faceVertexCounts", "int[]"},
    {"faceVertexIndices", "int[]"},
    {"points", "point3f[]"},
    {"normals", "normal3f[]"},
    {"extent", "float3[]"},
    {"doubleSided", "uniform bool"},
    {"subdivisionScheme", "uniform token"},
    {"interpolateBoundary", "token"},
    {"faceVaryingLinearInterpolation", "token"},
    {"triangleSubdivisionRule", "token"},
    {"holeIndices", "int[]"},
    {"cornerIndices", "int[]"},
    {"cornerSharpnesses", "float[]"},
    {"creaseIndices", "int[]"},
    {"creaseLengths", "int[]"},
    {"creaseSharpnesses", "float[]"},
    {"primvars:displayColor", "color3f[]"},
    {"primvars:displayOpacity", "float[]"},
    {"primvars:st", "texCoord2f[]"},
    {"primvars:st:indices", "int[]"},
    {"xformOp:transform", "matrix4d"},
    {"xformOp:translate", "double3"},
    {"xformOpOrder", "uniform token[]"},
    {"elementType", "uniform token"},
    {"familyName", "uniform token"},
    {"indices", "int[]"},
};

/// The attributes of a file: name to (type, value).
struct Usda {
  std::string text;
  std::map<std::string, std::string> types;
  std::map<std::string, std::string> values;

  std::string value(const std::string& name) const { return values.count(name) > 0 ? values.at(name) : "nothing"; }
  std::vector<double> numbers(const std::string& name) const {
    std::string digits = value(name);
    for (char& c : digits) c = std::string_view("[](),").find(c) != std::string_view::npos ? ' ' : c;
    std::istringstream words(digits);
    std::vector<double> result;
    for (std::string word; words >> word;) result.push_back(std::stod(word));
    return result;
  }
};

Usda written_usda(const Mesh& mesh, UpAxis up = UpAxis::Y) {
  const TemporaryFolder folder;
  WriteOptions options;
  options.up = up;
  write_mesh(folder.path("m.usda"), mesh, options);
  Usda file;
  file.text = file_text(folder.path("m.usda"));
  std::istringstream lines(file.text);
  bool in_prim = false;
  for (std::string line; std::getline(lines, line);) {
    in_prim = in_prim || line == "{";
    const std::size_t metadata = line.find(" (", line.find(']') == std::string::npos ? 0 : line.find(']'));
    std::string head = line.substr(line.find_first_not_of(' ') == std::string::npos ? 0 : line.find_first_not_of(' '));
    if (!in_prim || head.find(" = ") == std::string::npos || head.find("interpolation") == 0) continue;
    if (metadata != std::string::npos && line.back() == '(') head.resize(head.size() - 2);
    const std::size_t equals = head.find(" = ");
    const std::size_t name = head.rfind(' ', equals - 1);
    file.types[head.substr(name + 1, equals - name - 1)] = head.substr(0, name);
    file.values[head.substr(name + 1, equals - name - 1)] = head.substr(equals + 3);
  }
  return file;
}

/// One of everything that USD knows.
Mesh tagged_mesh() {
  Mesh mesh = grid(4, 3);
  mesh.creases = {{0, 1, 2.5}, {1, 2, 2.5}, {6, 7, 30.0}};
  mesh.corners = {{4, 1.5}, {9, 1e9}};
  mesh.holes = {3, 5};
  mesh.boundary = BoundaryRule::EdgeAndCorner;
  mesh.triangle_rule = TriangleRule::Smooth;
  mesh.face_varying = FaceVaryingRule::CornersPlus1;
  mesh.groups = {{"usemtl", "red paint", 2}, {"usemtl", "2nd", 7}};
  mesh.attributes.push_back({"color", Values::Constant(mesh.vertex_count(), 4, 0.5), {}});
  Attribute uv{"uv", (Values(3, 2) << 0, 0, 1, 0, 0, 1).finished(), {}};
  for (std::size_t i = 0; i < mesh.face_vertices.size(); ++i) uv.corner_rows.push_back(static_cast<Index>(i % 4) - 1);
  mesh.attributes.push_back(uv);
  mesh.points.rowwise() += Eigen::RowVector3d(1e6, 0, 0);
  return mesh;
}

TEST(UsdaWriter, EveryAttributeIsDocumented) {
  Mesh polygons = grid(1, 1);
  polygons.attributes = {{"normal", Values::Constant(4, 3, 1.0), {}}};
  std::size_t seen = 0;
  std::set<std::string> missing;
  for (const auto& entry : kSchema) missing.insert(entry.first);
  for (const Mesh& mesh : {tagged_mesh(), polygons}) {
    for (const auto& type : written_usda(mesh, UpAxis::X).types) {
      ASSERT_EQ(kSchema.count(type.first), 1U) << type.first;
      EXPECT_EQ(kSchema.at(type.first), type.second) << type.first;
      missing.erase(type.first);
      ++seen;
    }
  }
  EXPECT_GT(seen, 20U);
  EXPECT_TRUE(missing.empty()) << "never written: " << *missing.begin();
}

TEST(UsdaWriter, PointsKeepEveryDigitOfTheirDoubles) {
  Mesh mesh = grid(30, 20);
  std::mt19937_64 generator(3);
  for (Eigen::Index i = 0; i < mesh.points.size(); ++i)
    mesh.points.data()[i] += 1e-3 * std::generate_canonical<double, 53>(generator);
  const std::vector<double> numbers = written_usda(mesh).numbers("points");
  ASSERT_EQ(numbers.size(), static_cast<std::size_t>(mesh.points.size()));
  EXPECT_TRUE(std::equal(numbers.begin(), numbers.end(), mesh.points.data()));
}

TEST(UsdaWriter, FacesAreThoseOfTheMesh) {
  const Mesh mesh = grid(4, 3);
  const Usda file = written_usda(mesh);
  const std::vector<double> indices = file.numbers("faceVertexIndices");
  EXPECT_EQ(std::vector<Index>(indices.begin(), indices.end()),
            std::vector<Index>(mesh.face_vertices.begin(), mesh.face_vertices.end()));
  EXPECT_EQ(file.numbers("faceVertexCounts"), std::vector<double>(12, 4.0));
}

TEST(UsdaWriter, TheSurfaceIsTheMeshsOwn) {
  EXPECT_EQ(written_usda(grid(1, 1)).value("subdivisionScheme"), "\"catmullClark\"");
  EXPECT_EQ(written_usda(grid(1, 1)).value("interpolateBoundary"), "\"edgeOnly\"");
  EXPECT_EQ(written_usda(octahedron()).value("subdivisionScheme"), "\"loop\"");
  Mesh mesh = octahedron();
  mesh.scheme = SchemeKind::CatmullClark;
  mesh.boundary = BoundaryRule::None;
  mesh.attributes = {{"normal", mesh.points, {}}};
  const Usda file = written_usda(mesh);
  EXPECT_EQ(file.value("subdivisionScheme"), "\"catmullClark\"");
  EXPECT_EQ(file.value("interpolateBoundary"), "\"none\"");
  EXPECT_EQ(file.value("triangleSubdivisionRule"), "\"catmullClark\"");
  EXPECT_EQ(file.value("normals"), "nothing");
  EXPECT_EQ(written_usda(tagged_mesh()).value("triangleSubdivisionRule"), "\"smooth\"");
  EXPECT_EQ(written_usda(tagged_mesh()).value("interpolateBoundary"), "\"edgeAndCorner\"");
}

TEST(UsdaWriter, TheFaceVaryingRuleHasUsdsName) {
  constexpr const char* kNames[] = {"none", "cornersOnly", "cornersPlus1", "cornersPlus2", "boundaries", "all"};
  Mesh mesh = grid(1, 1);
  EXPECT_EQ(written_usda(mesh).value("faceVaryingLinearInterpolation"), "\"all\"");
  for (int rule = 0; rule < 6; ++rule) {
    mesh.face_varying = static_cast<FaceVaryingRule>(rule);
    EXPECT_EQ(written_usda(mesh).value("faceVaryingLinearInterpolation"), "\"" + std::string(kNames[rule]) + "\"");
  }
}

TEST(UsdaWriter, PolygonsWithNormalsAreNoSubdivisionSurface) {
  Mesh mesh = octahedron();
  mesh.attributes = {{"normal", 2.0 * mesh.points, {}}};
  const Usda file = written_usda(mesh);
  EXPECT_EQ(file.value("subdivisionScheme"), "\"none\"");
  const std::vector<double> normals = file.numbers("normals");
  EXPECT_EQ(normals, std::vector<double>(mesh.points.data(), mesh.points.data() + mesh.points.size()));
}

TEST(UsdaWriter, NormalsAtCornersAreWrittenThere) {
  Mesh mesh = octahedron();
  mesh.attributes = {{"normal", mesh.points, mesh.face_vertices}};
  mesh.attributes[0].corner_rows[2] = -1;
  const std::vector<double> normals = written_usda(mesh).numbers("normals");
  ASSERT_EQ(normals.size(), 3 * mesh.face_vertices.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    // The corner without one takes the mean of its faces: by symmetry the same.
    EXPECT_NEAR(normals[i], mesh.points(mesh.face_vertices[i / 3], i % 3), 1e-15);
  }
}

TEST(UsdaWriter, CreasesAreJoinedAndInfinityIsTen) {
  const Usda file = written_usda(tagged_mesh());
  EXPECT_EQ(file.value("creaseIndices"), "[0, 1, 2, 6, 7]");
  EXPECT_EQ(file.value("creaseLengths"), "[3, 2]");
  EXPECT_EQ(file.value("creaseSharpnesses"), "[2.5, 10]");
  EXPECT_EQ(file.value("cornerIndices"), "[4, 9]");
  EXPECT_EQ(file.value("cornerSharpnesses"), "[1.5, 10]");
  EXPECT_EQ(file.value("holeIndices"), "[3, 5]");
}

TEST(UsdaWriter, FarFromTheOriginTheTransformCarriesThePlace) {
  const Mesh mesh = tagged_mesh();
  const Usda file = written_usda(mesh);
  const std::vector<double> place = file.numbers("xformOp:translate");
  const std::vector<double> points = file.numbers("points");
  for (Eigen::Index i = 0; i < mesh.points.size(); ++i) EXPECT_EQ(points[i] + place[i % 3], mesh.points.data()[i]);
  EXPECT_EQ(written_usda(grid(3, 3)).value("xformOpOrder"), "nothing");
}

TEST(UsdaWriter, StandsTheModelUpright) {
  Mesh mesh = grid(1, 1);
  const auto says = [](const Usda& file, const std::string& words) {
    return file.text.find(words) != std::string::npos;
  };
  const Usda plain = written_usda(mesh);
  EXPECT_TRUE(says(plain, "upAxis = \"Y\""));
  const Usda on_z = written_usda(mesh, UpAxis::Z);
  EXPECT_TRUE(says(on_z, "upAxis = \"Z\""));
  EXPECT_EQ(on_z.values.at("points"), plain.values.at("points"));
  EXPECT_EQ(plain.values.count("xformOp:transform") + on_z.values.count("xformOp:transform"), 0U);
  // As a row times the matrix: x becomes y, y becomes x, z becomes -z.
  Usda on_x = written_usda(mesh, UpAxis::X);
  EXPECT_TRUE(says(on_x, "upAxis = \"Y\""));
  EXPECT_EQ(on_x.values.at("xformOp:transform"), "( (0, 1, 0, 0), (1, 0, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1) )");
  EXPECT_EQ(on_x.values.at("xformOpOrder"), "[\"xformOp:transform\"]");
  mesh.points.rowwise() += Eigen::RowVector3d(1e6, 0, 0);
  on_x = written_usda(mesh, UpAxis::X);
  EXPECT_EQ(on_x.values.at("xformOpOrder"), "[\"xformOp:transform\", \"xformOp:translate\"]");
}

TEST(UsdaWriter, ACornerWithoutATextureTakesZeros) {
  const Usda file = written_usda(tagged_mesh());
  EXPECT_EQ(file.value("primvars:st"), "[(0, 0), (1, 0), (0, 1), (0, 0)]");
  const std::vector<double> rows = file.numbers("primvars:st:indices");
  EXPECT_EQ(std::vector<double>(rows.begin(), rows.begin() + 5), (std::vector<double>{3, 0, 1, 2, 3}));
}

TEST(UsdaWriter, MaterialsAreSubsetsWithAllowedNames) {
  const std::string text = written_usda(tagged_mesh()).text;
  EXPECT_NE(text.find("def GeomSubset \"red_paint\""), std::string::npos);
  EXPECT_NE(text.find("def GeomSubset \"_2nd\""), std::string::npos);
  EXPECT_NE(text.find("int[] indices = [7, 8, 9, 10, 11]"), std::string::npos);
}

TEST(UsdaWriter, OtherAttributesBecomePrimvars) {
  Mesh mesh = grid(1, 1);
  mesh.attributes = {{"heat flux", Values::Constant(4, 1, 0.1), {}}, {"heat_flux", Values::Constant(4, 5, 2.0), {}}};
  const Usda file = written_usda(mesh);
  EXPECT_EQ(file.types.at("primvars:heat_flux"), "double[]");
  EXPECT_EQ(file.value("primvars:heat_flux"), "[0.1, 0.1, 0.1, 0.1]");
  EXPECT_EQ(file.numbers("primvars:heat_flux_1").size(), 20U);
  EXPECT_NE(file.text.find("elementSize = 5"), std::string::npos);
}

TEST(UsdaWriter, RefusesWhatUsdCannotHold) {
  const TemporaryFolder folder;
  Mesh mesh = tagged_mesh();
  mesh.crease_method = CreaseMethod::Chaikin;
  expect_error([&] { write_mesh(folder.path("m.usda"), mesh); }, ErrorCode::BadArgument, "Chaikin");
  mesh.creases = {{0, 1, 10.0}};
  write_mesh(folder.path("m.usda"), mesh);
  mesh.attributes[0].values(0, 0) = std::nan("");
  expect_error([&] { write_mesh(folder.path("m.usda"), mesh); }, ErrorCode::NotFinite, "'color'");
}

std::string chains(const std::vector<Crease>& creases) {
  std::ostringstream text;
  for (const io::CreaseChain& chain : io::crease_chains(creases)) {
    for (const Index vertex : chain.vertices) text << vertex << ' ';
    text << ": " << chain.sharpness << "; ";
  }
  return text.str();
}

TEST(CreaseChains, OpenClosedAndBranching) {
  EXPECT_EQ(chains({{3, 2, 1}, {1, 2, 1}, {4, 3, 1}}), "1 2 3 4 : 1; ");
  EXPECT_EQ(chains({{3, 2, 1}, {1, 2, 1}, {1, 3, 1}}), "1 2 3 1 : 1; ");
  EXPECT_EQ(chains({{0, 1, 2}, {0, 2, 2}, {0, 3, 2}}), "0 1 : 2; 0 2 : 2; 0 3 : 2; ");
  EXPECT_EQ(chains({{0, 1, 2}, {1, 2, 3}}), "0 1 : 2; 1 2 : 3; ");
  EXPECT_EQ(chains({}), "");
}

TEST(CreaseChains, TheLastTagOfAnEdgeCounts) {
  EXPECT_EQ(chains({{0, 1, 2}, {1, 0, 4}, {5, 6, 1}, {6, 5, 0}}), "0 1 : 4; ");
}

}  // namespace
}  // namespace batten::io_tests
