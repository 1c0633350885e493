/// Texture coordinates and images of the faces of PLY files.
#include "batten/io/bytes.h"
#include "batten/mesh/primitives.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

Mesh textured_ply(const std::string& text) { return parse(io::read_ply, text); }

/// Two triangles of a square as MeshLab writes them, with these properties of faces and these rows.
std::string square_ply(const std::string& properties, const std::string& rows, const std::string& comments = "") {
  return "ply\nformat ascii 1.0\n" + comments +
         "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n" + properties +
         "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + rows;
}

const char* const kVertexList = "property list uchar int vertex_indices\n";
const char* const kUvList = "property list uchar float texcoord\n";

TEST(PlyFaces, TextureCoordinatesStandAtTheCorners) {
  const std::string rows = "3 0 1 2 6 0 0 0.5 0 0.5 1\n3 0 2 3 6 0.75 0 1 1 0.75 1\n";
  const Mesh mesh = textured_ply(square_ply(std::string(kVertexList) + kUvList, rows));
  ASSERT_EQ(mesh.attributes.size(), 1U);
  const Attribute& uv = mesh.attributes[0];
  EXPECT_EQ(uv.name, "uv");
  // The corners of vertex 0 differ, and so do those of vertex 2.
  EXPECT_EQ(uv.corner_rows, (Buffer<Index>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(uv.values, (Values(6, 2) << 0, 0, 0.5, 0, 0.5, 1, 0.75, 0, 1, 1, 0.75, 1).finished());
  const std::string turned = "6 0 0 0.5 0 0.5 1 3 0 1 2\n6 0.75 0 1 1 0.75 1 3 0 2 3\n";
  expect_same_mesh(mesh, textured_ply(square_ply(std::string(kUvList) + kVertexList, turned)));
  EXPECT_TRUE(notes_of(io::read_ply, square_ply(std::string(kVertexList) + kUvList, rows)).empty());
}

TEST(PlyFaces, WithoutASeamTheyStandAtTheVertices) {
  const std::string rows = "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n";
  const Mesh mesh = textured_ply(square_ply(std::string(kVertexList) + kUvList, rows));
  ASSERT_EQ(mesh.attributes.size(), 1U);
  EXPECT_FALSE(mesh.attributes[0].per_corner());
  EXPECT_EQ(mesh.attributes[0].values, Values(mesh.points.leftCols(2)));
}

TEST(PlyFaces, AListOfAnotherLengthIsSkippedAndTold) {
  const std::string rows = "3 0 1 2 0\n3 0 2 3 6 0 0 1 1 0 1\n";
  const Mesh mesh = textured_ply(square_ply(std::string(kVertexList) + kUvList, rows));
  EXPECT_EQ(mesh.attributes.at(0).corner_rows, (Buffer<Index>{-1, -1, -1, 0, 1, 2}));
  const std::string wrong = square_ply(std::string(kVertexList) + kUvList, "3 0 1 2 2 0 0\n3 0 2 3 6 0 0 1 1 0 1\n");
  for (const std::size_t chunk_bytes : {std::size_t{1}, io::kChunkBytes}) {
    expect_same_mesh(mesh, parse(io::read_ply, wrong, chunk_bytes));
    const std::vector<std::string> notes = notes_of(io::read_ply, wrong, chunk_bytes);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("faces: 1"), std::string::npos) << notes[0];
  }
}

TEST(PlyFaces, FacesTakePrecedenceOverVertices) {
  std::string text = square_ply(std::string(kVertexList) + kUvList, "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 0\n");
  text.replace(text.find("element face"), 0, "property float s\nproperty float t\n");
  for (const char* row : {"0 0 0\n", "1 0 0\n", "1 1 0\n", "0 1 0\n"}) {
    text.replace(text.find(row, text.find("end_header")) + 5, 0, " 9 9");
  }
  const Mesh mesh = textured_ply(text);
  ASSERT_EQ(mesh.attributes.size(), 1U);
  EXPECT_TRUE(mesh.attributes[0].per_corner());
  EXPECT_EQ(notes_of(io::read_ply, text).size(), 1U);
}

/// Polygons with texture coordinates at most corners, all of them doubles, or all floats.
Mesh with_corner_uvs(bool floats) {
  Mesh mesh = random_mesh(60, 50);
  Attribute uv{"uv", random_doubles(static_cast<Eigen::Index>(mesh.face_vertices.size()), 2, 5), {}};
  if (floats) uv.values = Values::Random(uv.values.rows(), 2).cast<float>().cast<double>();
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) uv.corner_rows.push_back(static_cast<Index>(c));
  mesh.attributes = {uv};
  return mesh;
}

/// Equal at each corner; the rows may be others.
void expect_same_corner_values(const Mesh& mesh, const Mesh& read) {
  ASSERT_EQ(read.attributes.size(), 1U);
  expect_same_faces(mesh, read);
  const Attribute& a = mesh.attributes[0];
  const Attribute& b = read.attributes[0];
  ASSERT_EQ(a.corner_rows.size(), b.corner_rows.size());
  for (std::size_t c = 0; c < a.corner_rows.size(); ++c) {
    ASSERT_EQ(a.corner_rows[c] < 0, b.corner_rows[c] < 0);
    if (a.corner_rows[c] < 0) continue;
    ASSERT_TRUE(same_bits(a.values.row(a.corner_rows[c]), b.values.row(b.corner_rows[c]))) << c;
  }
}

TEST(PlyFaces, CornerValuesSurviveInBytesAndInText) {
  for (const bool floats : {true, false}) {
    Mesh mesh = with_corner_uvs(floats);
    std::fill_n(mesh.attributes[0].corner_rows.begin() + mesh.face_offsets[7], mesh.face_size(7), -1);
    for (const bool binary : {true, false}) {
      expect_same_corner_values(mesh, round_trip(mesh, "ply", binary));
      const TemporaryFolder folder;
      write_mesh(folder.path("m.ply"), mesh, {"", binary});
      const std::string text = file_text(folder.path("m.ply"));
      EXPECT_NE(text.find("property list uchar float texcoord\n"), std::string::npos);
      EXPECT_EQ(text.find("property list uchar double exact_texcoord\n") == std::string::npos, floats);
      if (!binary) expect_same_corner_values(mesh, parse(io::read_ply, text, 40));
    }
  }
}

TEST(PlyFaces, AFaceWithACornerWithoutValueHasNone) {
  Mesh mesh = with_corner_uvs(true);
  mesh.attributes[0].corner_rows[mesh.face_offsets[3] + 1] = -1;
  const Mesh read = round_trip(mesh, "ply");
  std::fill_n(mesh.attributes[0].corner_rows.begin() + mesh.face_offsets[3], mesh.face_size(3), -1);
  expect_same_corner_values(mesh, read);
}

TEST(PlyFaces, PolygonsOfAnySizeKeepTheirTextureCoordinates) {
  for (const Index corners : {127, 128, 300}) {
    Mesh mesh = random_mesh(corners, 1);
    for (Index i = 0; i < corners; ++i) mesh.face_vertices.push_back(i);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
    const auto count = static_cast<Index>(mesh.face_vertices.size());
    mesh.attributes = {{"uv", random_doubles(count, 2, 3), Buffer<Index>(static_cast<std::size_t>(count))}};
    for (Index i = 0; i < count; ++i) mesh.attributes[0].corner_rows[i] = count - 1 - i;
    for (const bool binary : {true, false}) expect_same_corner_values(mesh, round_trip(mesh, "ply", binary));
  }
}

TEST(PlyFaces, ChangedFloatsOverruleExactNumbers) {
  const std::string properties = std::string(kVertexList) + kUvList + "property list uchar double exact_texcoord\n";
  const std::string exact = " 6 0.1 0 0 0 0 0\n";
  const auto first = [&](const std::string& rounded) {
    const Mesh mesh =
        textured_ply(square_ply(properties, "3 0 1 2 6 " + rounded + " 0 0 0 0 0" + exact + "3 0 2 3 0 0\n"));
    return mesh.attributes.at(0).values(0, 0);
  };
  EXPECT_EQ(first("0.1"), 0.1);
  EXPECT_EQ(first("0.10000000149011612"), 0.1);  // the float
  EXPECT_EQ(first("0.25"), 0.25);
}

TEST(PlyFaces, TextureNumbersBecomeMaterialsNamedByTheirImages) {
  const std::string properties = std::string(kVertexList) + kUvList + "property int texnumber\n";
  const std::string comments = "comment TextureFile wood.png\ncomment made elsewhere\ncomment TextureFile  a b.jpg \n";
  const std::string rows = "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0 0 1 1 0 1 0\n";
  const Mesh mesh = textured_ply(square_ply(properties, rows, comments));
  ASSERT_EQ(mesh.groups.size(), 2U);
  EXPECT_EQ(mesh.groups[0].name, "a b.jpg");
  EXPECT_EQ(mesh.groups[1].name, "wood.png");
  EXPECT_EQ(mesh.groups[1].first_face, 1);
  EXPECT_EQ(mesh.groups[1].keyword, "usemtl");
  for (const bool binary : {true, false}) expect_same_mesh(mesh, round_trip(mesh, "ply", binary));
  // Numbers of no image.
  const std::string none = "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 -1\n";
  for (const std::string& text : {none, std::string(none).replace(none.rfind("-1"), 2, "7")}) {
    const Mesh part = textured_ply(square_ply(properties, text, comments));
    ASSERT_EQ(part.groups.size(), 2U);
    EXPECT_EQ(part.groups[1].name, "untextured");
    expect_same_mesh(part, round_trip(part, "ply"));
  }
  EXPECT_TRUE(textured_ply(square_ply(properties, rows)).groups.empty());
  EXPECT_EQ(notes_of(io::read_ply, square_ply(properties, rows)).size(), 1U);
}

TEST(PlyFaces, OneImageWithoutNumbersIsThatOfAllFaces) {
  const Mesh mesh = textured_ply(square_ply(kVertexList, "3 0 1 2\n3 0 2 3\n", "comment TextureFile wood.png\n"));
  ASSERT_EQ(mesh.groups.size(), 1U);
  EXPECT_EQ(mesh.groups[0].name, "wood.png");
  const TemporaryFolder folder;
  write_mesh(folder.path("m.ply"), mesh, {"", false});
  const std::string text = file_text(folder.path("m.ply"));
  EXPECT_NE(text.find("comment TextureFile wood.png\n"), std::string::npos);
  EXPECT_EQ(text.find("texnumber"), std::string::npos);
}

TEST(PlyFaces, EveryCutOfAFileWithTextureCoordinatesIsAnError) {
  const TemporaryFolder folder;
  Mesh mesh = with_corner_uvs(false);
  mesh.groups = {{"usemtl", "a.png", 0}, {"usemtl", "b.png", 20}};
  write_mesh(folder.path("m.ply"), mesh);
  const std::string whole = file_text(folder.path("m.ply"));
  expect_same_corner_values(mesh, textured_ply(whole));
  for (std::size_t size = 1; size < whole.size(); size += size < 400 ? 1 : 7) {
    EXPECT_EQ(error_of([&] { textured_ply(whole.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
}

TEST(PlyFaces, AHugeListIsRefused) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty list uint double texcoord\nend_header\n";
  std::string body(36, '\0');
  body += '\3';
  for (const char index : {0, 1, 2}) body += std::string(1, index) + std::string(3, '\0');
  expect_error([&] { textured_ply(head + body + "\xFF\xFF\xFF\x7F" + std::string(48, '\0')); }, ErrorCode::BadFile,
               "cut short");
}

TEST(PlyFaces, LongNamesOfImagesAtEachFaceAreSkipped) {
  std::string rows;
  for (int i = 0; i < 1000; ++i) rows += i % 2 == 0 ? "3 0 1 2 0\n" : "3 0 1 2 1\n";
  std::string text = square_ply(std::string(kVertexList) + "property int texnumber\n", rows,
                                "comment TextureFile " + std::string(500, 'a') + ".png\ncomment TextureFile b.png\n");
  text.replace(text.find("element face 2"), 14, "element face 1000");
  EXPECT_TRUE(textured_ply(text).groups.empty());
  EXPECT_EQ(notes_of(io::read_ply, text).size(), 1U);
}

}  // namespace
}  // namespace batten::io_tests
