/// VTK, FreeSurfer and GIFTI out, read back by the few lines that each format takes.
#include <sstream>

#include "batten/io/bytes.h"
#include "batten/io/losses.h"
#include "batten/mesh/triangulate.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

/// A quad and a triangle beside it, with numbers that floats do not hold.
Mesh two_faces() {
  Mesh mesh;
  mesh.points.resize(5, 3);
  mesh.points << 0, 0, 0.1, 1, 0, -0.2, 1, 1.5, 0, 0, 1, 1.0 / 3.0, 2, 0.5, 0;
  mesh.add_face({0, 1, 2, 3});
  mesh.add_face({1, 4, 2});
  return mesh;
}

std::string written(const Mesh& mesh, const WriteOptions& options) {
  const TemporaryFolder folder;
  const std::string path = folder.path("m." + options.format);
  write_mesh(path, mesh, options);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Takes numbers from the front of a text, the most significant byte first.
template <typename T>
T take(std::string& bytes) {
  std::reverse(bytes.begin(), bytes.begin() + sizeof(T));
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes.erase(0, sizeof(T));
  return value;
}

std::string take_line(std::string& bytes) {
  const std::size_t end = bytes.find('\n');
  std::string line = bytes.substr(0, end);
  bytes.erase(0, end + 1);
  return line;
}

TEST(Vtk, HoldsPolygonsInDoubles) {
  const Mesh mesh = two_faces();
  WriteOptions options;
  options.format = "vtk";
  options.comment = "SPACE=RAS";
  std::string bytes = written(mesh, options);
  EXPECT_EQ(take_line(bytes), "# vtk DataFile Version 3.0");
  EXPECT_NE(take_line(bytes).find("SPACE=RAS"), std::string::npos);
  EXPECT_EQ(take_line(bytes), "BINARY");
  EXPECT_EQ(take_line(bytes), "DATASET POLYDATA");
  EXPECT_EQ(take_line(bytes), "POINTS 5 double");
  for (Eigen::Index i = 0; i < 15; ++i) EXPECT_EQ(take<double>(bytes), mesh.points.data()[i]);
  EXPECT_EQ(take_line(bytes), "");
  EXPECT_EQ(take_line(bytes), "POLYGONS 2 9");
  for (const Index number : {4, 0, 1, 2, 3, 3, 1, 4, 2}) EXPECT_EQ(take<Index>(bytes), number);
  EXPECT_EQ(bytes, "\n");
  EXPECT_EQ(find_losses("m.vtk", mesh), std::vector<std::string>{});
}

TEST(Vtk, TextHasTheSameNumbers) {
  WriteOptions options;
  options.format = "vtk";
  options.binary = false;
  std::istringstream text(written(two_faces(), options));
  std::string line;
  for (int i = 0; i < 5; ++i) std::getline(text, line);
  for (Eigen::Index i = 0; i < 15; ++i) {
    double number = 0.0;
    text >> number;
    EXPECT_EQ(number, two_faces().points.data()[i]);
  }
  text >> line;
  EXPECT_EQ(line, "POLYGONS");
}

TEST(FreeSurfer, HoldsTrianglesInFloats) {
  const Mesh mesh = two_faces();
  const Mesh triangles = triangulated(mesh);
  WriteOptions options;
  options.format = "fsb";
  std::string bytes = written(mesh, options);
  EXPECT_EQ(bytes.substr(0, 3), "\xff\xff\xfe");
  bytes.erase(0, 3);
  EXPECT_EQ(take_line(bytes).substr(0, 10), "created by");
  EXPECT_EQ(take_line(bytes), "");
  EXPECT_EQ(take<Index>(bytes), 5);
  EXPECT_EQ(take<Index>(bytes), 3);
  for (Eigen::Index i = 0; i < 15; ++i) EXPECT_EQ(take<float>(bytes), static_cast<float>(mesh.points.data()[i]));
  for (const Index vertex : triangles.face_vertices) EXPECT_EQ(take<Index>(bytes), vertex);
  EXPECT_TRUE(bytes.empty());
  EXPECT_EQ(find_losses("m.fsb", mesh), std::vector<std::string>{"polygons (cut into triangles)"});
}

/// What stands between the n-th <Data> and </Data>.
std::string data_of(const std::string& text, int n) {
  std::size_t begin = 0;
  for (int i = 0; i <= n; ++i) begin = text.find("<Data>", begin) + 6;
  return text.substr(begin, text.find("</Data>", begin) - begin);
}

std::string bytes_of(const std::string& letters) {
  std::string bytes;
  int bits = 0;
  unsigned group = 0;
  for (const char letter : letters) {
    const auto value = std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(letter);
    if (value == std::string::npos) break;
    group = group << 6 | static_cast<unsigned>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255);
  }
  return bytes;
}

TEST(Gifti, HoldsTrianglesAsBase64AndAsText) {
  const Mesh mesh = two_faces();
  const Mesh triangles = triangulated(mesh);
  WriteOptions options;
  options.format = "gii";
  const std::string file = written(mesh, options);
  const std::string points = bytes_of(data_of(file, 0));
  ASSERT_EQ(points.size(), 60U);
  for (int i = 0; i < 15; ++i)
    EXPECT_EQ((io::load<float, io::ByteOrder::Little>(&points[4 * i])), static_cast<float>(mesh.points.data()[i]));
  const std::string faces = bytes_of(data_of(file, 1));
  ASSERT_EQ(faces.size(), 36U);
  for (int i = 0; i < 9; ++i)
    EXPECT_EQ((io::load<Index, io::ByteOrder::Little>(&faces[4 * i])), triangles.face_vertices[i]);
  EXPECT_NE(file.find("NIFTI_XFORM_SCANNER_ANAT"), std::string::npos);
  options.binary = false;
  std::istringstream text(data_of(written(mesh, options), 0));
  for (int i = 0; i < 15; ++i) {
    float number = 0.0F;
    text >> number;
    EXPECT_EQ(number, static_cast<float>(mesh.points.data()[i]));
  }
}

TEST(Gifti, RefusesPointsAlone) {
  Mesh points;
  points.points = Points::Ones(3, 3);
  for (const char* format : {"gii", "fsb"}) {
    WriteOptions options;
    options.format = format;
    expect_error([&] { written(points, options); }, ErrorCode::BadShape, "no face");
  }
}

}  // namespace
}  // namespace batten::io_tests
