/// STL in and out.
#include "batten/io/bytes.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

Mesh stl(const std::string& text) { return parse(io::read_stl, text); }

const char* const kText =
    "solid two triangles\n facet normal nan 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   VERTEX 0 1 0\n"
    "  endloop\n endfacet\n facet normal 0 0 1\r\n  outer loop\n   vertex 1 0 0\n   vertex 1 1e0 0\n   vertex -0 1 "
    "0.0\n"
    "  endloop\n endfacet\nendsolid two triangles\n";

/// 80 bytes of head, the number of triangles, and their bytes.
std::string binary_file(const std::string& head, const std::vector<float>& coordinates) {
  io::ByteBuffer out;
  out.put(static_cast<std::uint32_t>(coordinates.size() / 9));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (i % 9 == 0) out.put(0.0F).put(0.0F).put(0.0F);
    out.put(coordinates[i]);
    if (i % 9 == 8) out.put(std::uint16_t{0});
  }
  std::string text = head;
  text.resize(80, '\0');
  return text + std::string(out.text());
}

const std::vector<float> kTwoTriangles = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, -0.0F, 1, 0};

TEST(StlReader, EqualCoordinatesBecomeOneVertexInOrderOfAppearance) {
  for (const std::string& text : {std::string(kText), binary_file("binary", kTwoTriangles)}) {
    const Mesh mesh = stl(text);
    EXPECT_EQ(mesh.points, (Points(4, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0).finished());
    EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(mesh.face_offsets, (Buffer<Index>{0, 3, 6}));
  }
}

TEST(StlReader, ABinaryFileMayBeginWithSolid) {
  EXPECT_EQ(stl(binary_file("solid from a CAD program", kTwoTriangles)).face_count(), 2);
}

TEST(StlReader, NearCoordinatesStayApart) {
  std::vector<float> coordinates = kTwoTriangles;
  coordinates[12] = std::nextafter(1.0F, 2.0F);
  EXPECT_EQ(stl(binary_file("", coordinates)).vertex_count(), 4);
  coordinates[9] = std::nextafter(1.0F, 2.0F);
  EXPECT_EQ(stl(binary_file("", coordinates)).vertex_count(), 5);
}

/// The two triangles with so many attribute bytes after each, of which `told` are announced.
std::string file_with_attributes(const std::vector<std::uint16_t>& bytes, const std::vector<std::uint16_t>& told,
                                 const std::string& head = "binary") {
  const std::string plain = binary_file(head, kTwoTriangles);
  std::string text = plain.substr(0, 84);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    io::ByteBuffer count;
    count.put(told[i]);
    text += plain.substr(84 + 50 * i, 48) + std::string(count.text()) + std::string(bytes[i], '\xff');
  }
  return text;
}

TEST(StlReader, AttributeBytesAreSkippedWhereTheirNumbersAddUp) {
  const std::string text = file_with_attributes({3, 60}, {3, 60}, "solid from a CAD program");
  expect_same_mesh(stl(binary_file("binary", kTwoTriangles)), stl(text));
  EXPECT_EQ(notes_of(io::read_stl, text),
            std::vector<std::string>{"test: attribute bytes of the triangles are skipped: 63"});
}

TEST(StlReader, AttributeNumbersThatDoNotAddUpMeanNothing) {
  const Mesh expected = stl(binary_file("binary", kTwoTriangles));
  // Colours in the place of the numbers, as several programs write them, in a file of the usual size.
  const std::string colored = file_with_attributes({0, 0}, {0x7fff, 0x801f});
  expect_same_mesh(expected, stl(colored));
  EXPECT_TRUE(notes_of(io::read_stl, colored).empty());
  for (const std::vector<std::uint16_t>& told :
       {std::vector<std::uint16_t>{0, 0}, {0x7fff, 0}, {0, 8}, {0, 6}, {0, 65535}}) {
    const std::string padded = file_with_attributes({0, 7}, told);
    expect_same_mesh(expected, stl(padded));
    EXPECT_EQ(notes_of(io::read_stl, padded),
              std::vector<std::string>{"test: bytes after the last triangle are skipped: 7"});
  }
}

TEST(StlReader, ATextStaysATextWhateverItsSize) {
  std::string text(kText);
  text.replace(text.find("two"), 3, std::string(100, '\xe4'));  // a name in an old encoding covers the count
  EXPECT_EQ(stl(text).face_count(), 2);
  EXPECT_EQ(stl(with_carriage_returns(kText)).face_count(), 2);
}

TEST(StlReader, BytesWithoutATriangleAreNoFile) {
  expect_error([] { stl(std::string(200, '\0')); }, ErrorCode::BadFile, "promises 84 bytes, but the file has 200");
}

TEST(StlReader, EveryCutIsAnError) {
  const std::string binary = binary_file("binary", kTwoTriangles);
  for (std::size_t size = 1; size < binary.size(); ++size) {
    EXPECT_EQ(error_of([&] { stl(binary.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
  const std::string text(kText);
  for (std::size_t size = 1; size < text.find("endsolid") + 8; ++size) {
    EXPECT_EQ(error_of([&] { stl(text.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
}

TEST(StlReader, ErrorsNameTheLineOrTheTriangle) {
  const auto broken = [](const std::string& from, const std::string& to) {
    std::string text(kText);
    text.replace(text.find(from), from.size(), to);
    return [text] { stl(text); };
  };
  expect_error(broken("vertex 1 1e0 0", "vertex 1 1e0 x"), ErrorCode::BadFile, "test:12: 'x' is not a number (z");
  expect_error(broken("vertex 1 1e0 0", "vertex 1 inf 0"), ErrorCode::NotFinite, "test:12: 'inf'");
  expect_error(broken("   vertex 1 1e0 0\n", ""), ErrorCode::BadFile,
               "test:13: a facet needs 3 vertices, this one has 2");
  expect_error(broken("endloop", "solid"), ErrorCode::BadFile, "the vertices before 'solid' lack an endloop");
  expect_error(broken("endfacet", "endfacets"), ErrorCode::BadFile, "test:8: 'endfacets'");
  std::vector<float> coordinates = kTwoTriangles;
  coordinates[13] = std::nanf("");
  expect_error([&] { stl(binary_file("", coordinates)); }, ErrorCode::NotFinite, "triangle 1 ");
}

TEST(StlReader, APromiseThatTheFileCannotHoldIsRefused) {
  std::string text = binary_file("", kTwoTriangles);
  text.replace(80, 4, "\xff\xff\xff\xff");
  expect_error([&] { stl(text); }, ErrorCode::BadFile, "promises 214748364834 bytes, but the file has 184");
}

TEST(StlWriter, FloatsSurviveInBytesAndDoublesInText) {
  Mesh mesh;
  mesh.points = (Points(4, 3) << 0, 0, 0, 0.1, 0, 0, 0.1, 0.7, 0, 0, 1, 1e-3).finished();
  mesh.add_face({0, 1, 2});
  mesh.add_face({0, 2, 3});
  expect_same_mesh(mesh, round_trip(mesh, "stl", false));
  const Mesh back = round_trip(mesh, "stl", true);
  expect_same_faces(mesh, back);
  EXPECT_EQ(back.points, mesh.points.cast<float>().cast<double>());
}

TEST(StlWriter, PolygonsBecomeFansWithUnitNormals) {
  Mesh mesh;
  mesh.points = (Points(5, 3) << 0, 0, 0, 2, 0, 0, 3, 1, 0, 2, 2, 0, 0, 2, 0).finished();
  mesh.add_face({0, 1, 2, 3, 4});
  const TemporaryFolder folder;
  write_mesh(folder.path("m.stl"), mesh);
  const std::string text = file_text(folder.path("m.stl"));
  EXPECT_EQ(text.size(), 84U + 3 * 50U);
  EXPECT_EQ((io::load<float, io::ByteOrder::Little>(text.data() + 84 + 8)), 1.0F);
  EXPECT_EQ(read_mesh(folder.path("m.stl")).face_vertices, (Buffer<Index>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

TEST(StlWriter, RefusesWhatStlCannotHold) {
  const TemporaryFolder folder;
  Mesh points = random_mesh(4, 0);
  expect_error([&] { write_mesh(folder.path("m.stl"), points); }, ErrorCode::BadShape, "triangles only");
  points.points = Points::Constant(3, 3, 1e39);
  points.add_face({0, 1, 2});
  expect_error([&] { write_mesh(folder.path("m.stl"), points); }, ErrorCode::BadArgument, "too large");
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace batten::io_tests
