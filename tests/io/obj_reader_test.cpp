/// The meaning of OBJ's statements.
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

const char* const kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Mesh obj(const std::string& text) { return parse(io::read_obj, text); }

TEST(ObjReader, ReadsPointsAndPolygons) {
  const Mesh mesh = obj("v 0 0.5 -1e3\nv 1 0 0\nv 1 1 0\nv +2 .5 5.\nf 1 2 3\nf 1 2 3 4\n");
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_EQ(mesh.points(0, 2), -1000.0);
  EXPECT_EQ(mesh.points(3, 0), 2.0);
  EXPECT_EQ(mesh.points(3, 2), 5.0);
  EXPECT_EQ(mesh.face_offsets, (Buffer<Index>{0, 3, 7}));
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2, 0, 1, 2, 3}));
}

TEST(ObjReader, ADecimalBecomesTheNearestDouble) {
  const Mesh mesh = obj("v 0.1 123456789.123456789 2.2250738585072011e-308\n");
  EXPECT_EQ(mesh.points(0, 0), 0.1);
  EXPECT_EQ(mesh.points(0, 1), 123456789.123456789);
  EXPECT_EQ(mesh.points(0, 2), 2.2250738585072011e-308);
}

TEST(ObjReader, LineEndsTabsCommentsAndContinuedLinesDoNotMatter) {
  const Mesh plain = obj(std::string(kCorners) + "f 1 2 3\n");
  const Mesh odd =
      obj("# C:\\folder\\\r\n\r\n \tv\t0  0 0\t# origin\r\nv 1 \\\r\n 0 0\r\nv 0 \\\n\\\n1 0\n\nf 1\\\n 2 3 \\\n#c");
  expect_same_mesh(plain, odd);
}

TEST(ObjReader, ACommentThatEndsInABackslashHidesNoLine) {
  EXPECT_EQ(obj("# path C:\\\nv 1 2 3 # D:\\\nv 4 5 6\n").vertex_count(), 2);
}

TEST(ObjReader, CarriageReturnsAloneEndLines) {
  const std::string text = std::string("# comment\nusemtl a b\n") + kCorners + "f 1 \\\n2 3\n";
  for (const std::size_t chunk : {std::size_t{1}, io::kChunkBytes}) {
    const Mesh mesh = parse(io::read_obj, with_carriage_returns(text), chunk);
    EXPECT_EQ(mesh.face_count(), 1);
    expect_same_mesh(obj(text), mesh);
  }
  expect_read_error(io::read_obj, "v 0 0 0\rv 1 0\r", ErrorCode::BadFile, "test:2: missing z");
}

TEST(ObjReader, SkippedStatementsAreNamedWithTheirFirstLine) {
  const std::string text = "v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0 2\nv 1 1 0\nl 1 2\np 1\nf 1 2 3\nl 2 3\ncurv 0 1 1 2\n";
  const std::vector<std::string> expected = {
      "test: weights w other than 1 are skipped: 2 (the first in line 2)",
      "test: lines (`l`) are skipped: 2 (the first in line 5)",
      "test: points (`p`) are skipped: 1 (the first in line 6)",
      "test: curves and free-form surfaces (`curv`, `surf`) are skipped: 1 (the first in line 9)"};
  EXPECT_EQ(notes_of(io::read_obj, text), expected);
  EXPECT_EQ(notes_of(io::read_obj, text, 1), expected);
  EXPECT_EQ(notes_of(io::read_obj, std::string(kCorners) + "v 1 1 1 1\nf 1 2 3\n"), std::vector<std::string>());
}

TEST(ObjReader, NegativeIndicesCountBackFromTheLine) {
  const Mesh mesh = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1 -2 -4\n");
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2, 3, 2, 0}));
}

TEST(ObjReader, CornersKeepTheSharingOfTheirRows) {
  const Mesh mesh =
      obj(std::string(kCorners) + "vt 0 0\nvt 1 0 9\nvt 0.5\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/-1\nf 3//1 2 1/3\n");
  ASSERT_EQ(mesh.attributes.size(), 2U);
  EXPECT_EQ(mesh.attributes[0].name, "uv");
  EXPECT_EQ(mesh.attributes[0].values, (Values(3, 2) << 0, 0, 1, 0, 0.5, 0).finished());
  EXPECT_EQ(mesh.attributes[0].corner_rows, (Buffer<Index>{0, 1, 0, -1, -1, 2}));
  EXPECT_EQ(mesh.attributes[1].name, "normal");
  EXPECT_EQ(mesh.attributes[1].corner_rows, (Buffer<Index>{0, 0, 0, 0, -1, -1}));
}

TEST(ObjReader, EmptyFieldsOfACornerAreNone) {
  const Mesh mesh = obj(std::string(kCorners) + "f 1/ 2// 3\n");
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2}));
  EXPECT_TRUE(mesh.attributes.empty());
}

TEST(ObjReader, NormalsOfAPointCloudBelongToItsVertices) {
  const Mesh mesh = obj("v 0 0 0\nvn 1 0 0\nv 1 1 1\nvn 0 1 0\n");
  ASSERT_EQ(mesh.attributes.size(), 1U);
  EXPECT_FALSE(mesh.attributes[0].per_corner());
  EXPECT_EQ(mesh.attributes[0].values, (Values(2, 3) << 1, 0, 0, 0, 1, 0).finished());
}

TEST(ObjReader, ColoursCountWhenEveryVertexHasThem) {
  const Mesh all = obj("v 0 0 0 1 0.5 0\nv 1 1 1 0 0 0.25\n");
  ASSERT_EQ(all.attributes.size(), 1U);
  EXPECT_EQ(all.attributes[0].name, "color");
  EXPECT_EQ(all.attributes[0].values, (Values(2, 3) << 1, 0.5, 0, 0, 0, 0.25).finished());
  EXPECT_TRUE(obj("v 0 0 0 1 0.5 0\nv 1 1 1\n").attributes.empty());
  EXPECT_EQ(obj("v 0 0 0 0 1 1 0.5\n").attributes[0].values.cols(), 4);
}

TEST(ObjReader, AWeightIsNoColour) {
  const Mesh mesh = obj("v 1 2 3 1.0\n");
  EXPECT_TRUE(mesh.attributes.empty());
  EXPECT_EQ(mesh.points(0, 2), 3.0);
}

TEST(ObjReader, APolygonMayHaveAnySize) {
  for (const Index size : {300, 100000}) {
    std::string text;
    std::string face("f");
    for (Index i = 1; i <= size; ++i) {
      text += "v " + std::to_string(i) + " 0 0\n";
      face.append(" ").append(std::to_string(i));
    }
    const Mesh mesh = obj(text + face + "\n");
    ASSERT_EQ(mesh.face_count(), 1);
    EXPECT_EQ(mesh.face_size(0), size);
    EXPECT_EQ(mesh.face_vertices[static_cast<std::size_t>(size) - 1], size - 1);
  }
}

TEST(ObjReader, AReturnInsideANameIsABlank) {
  EXPECT_EQ(obj("g a\rb\r\n" + std::string(kCorners)).groups.at(0).name, "a b");
}

TEST(ObjReader, GroupsAndMaterialsAreKept) {
  const Mesh mesh = obj("mtllib my materials.mtl\n" + std::string(kCorners) +
                        "o thing\ng left arm\nusemtl red\ns off\nf 1 2 3\ng unused\ng right\nf 3 2 1\ns 1\n");
  EXPECT_EQ(mesh.material_libraries, std::vector<std::string>{"my materials.mtl"});
  ASSERT_EQ(mesh.groups.size(), 6U);
  EXPECT_EQ(mesh.groups[1].keyword, "g");
  EXPECT_EQ(mesh.groups[1].name, "left arm");
  EXPECT_EQ(mesh.groups[4].name, "right");
  EXPECT_EQ(mesh.groups[4].first_face, 1);
  EXPECT_EQ(mesh.groups[5].keyword, "s");
  EXPECT_EQ(mesh.groups[5].first_face, 2);
}

TEST(ObjReader, LinesPointsAndUnknownStatementsAreSkipped) {
  const Mesh mesh =
      obj(std::string(kCorners) + "l 1 2\np 1\nvp 0.5\ncstype bezier\nwhatever 1 abc \\\nv not a vertex\n");
  EXPECT_EQ(mesh.vertex_count(), 3);
  EXPECT_EQ(mesh.face_count(), 0);
}

TEST(ObjReader, ReadsOpenSubdivTags) {
  const Mesh mesh = obj(std::string(kCorners) +
                        "f 1 2 3\nt interpolateboundary 1/0/0 2\nt crease 2/1/0 0 1 2.5\nt crease 3/2/0 0 1 2 3 4\n"
                        "t crease 3/1/0 2 1 0 5\nt corner 1/1/0 2 10\nt corner 2/1/0 0 1 3\nt hole 1/0/0 0\n"
                        "t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n"
                        "t facevaryinginterpolateboundary 1/0/0 1\nt unknown 0/0/3 a b c\n");
  ASSERT_EQ(mesh.creases.size(), 5U);
  EXPECT_EQ(mesh.creases[0].sharpness, 2.5);
  EXPECT_EQ(mesh.creases[2].a, 1);
  EXPECT_EQ(mesh.creases[2].b, 2);
  EXPECT_EQ(mesh.creases[2].sharpness, 4.0);
  EXPECT_EQ(mesh.creases[4].sharpness, 5.0);
  ASSERT_EQ(mesh.corners.size(), 3U);
  EXPECT_EQ(mesh.corners[0].vertex, 2);
  EXPECT_EQ(mesh.corners[2].sharpness, 3.0);
  EXPECT_EQ(mesh.holes, std::vector<Index>{0});
  EXPECT_EQ(mesh.boundary, BoundaryRule::EdgeOnly);
  EXPECT_EQ(mesh.crease_method, CreaseMethod::Chaikin);
  EXPECT_EQ(mesh.triangle_rule, TriangleRule::Smooth);
  EXPECT_EQ(mesh.face_varying, FaceVaryingRule::CornersOnly);
}

TEST(ObjReader, BoundaryRulesHaveOpenSubdivsNumbers) {
  const auto rule = [](const std::string& number) {
    return obj("v 0 0 0\nt interpolateboundary 1/0/0 " + number + "\n").boundary;
  };
  EXPECT_EQ(rule("0"), BoundaryRule::None);
  EXPECT_EQ(rule("1"), BoundaryRule::EdgeAndCorner);
  EXPECT_EQ(rule("2"), BoundaryRule::EdgeOnly);
}

TEST(ObjReader, TinyChunksChangeNothing) {
  std::string text = "mtllib a\n";
  for (int i = 0; i < 40; ++i) {
    const std::string n = std::to_string(i);
    text += "v " + n + " 0.25 \\\n1e-3\r\nvt 0." + n + " 1\nvn 0 0 1\n# comment " + n + "\\\n";
    if (i < 5) continue;
    text +=
        "g group " + n + "\nf -1/-1/-1 -2//-2 -3/-3\nf 1 2 \\\n3 4\nf -5/1 -4/2 -3/3\nt crease 2/1/0 0 " + n + " 2\n";
    text += "t hole 1/0/0 " + n + "\n";
  }
  const Mesh whole = obj(text);
  EXPECT_EQ(whole.face_count(), 105);
  for (const std::size_t bytes : {1U, 2U, 7U, 30U, 64U, 100U, 1000U}) {
    SCOPED_TRACE(bytes);
    expect_same_mesh(whole, parse(io::read_obj, text, bytes));
  }
}

}  // namespace
}  // namespace batten::io_tests
