/// PLY in and out.
#include "batten/io/bytes.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

Mesh ply(const std::string& text) { return parse(io::read_ply, text); }

/// The bytes of a number in the order asked for.
template <typename T>
std::string bytes(T value, io::ByteOrder order = io::ByteOrder::Little) {
  std::string text(sizeof(T), '\0');
  std::memcpy(text.data(), &value, sizeof(T));
  if (order != io::kNativeOrder) std::reverse(text.begin(), text.end());
  return text;
}

const char* const kTextHeader =
    "ply\nformat ascii 1.0\ncomment C:\\path\\\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST(PlyReader, ReadsText) {
  const Mesh mesh = ply(std::string(kTextHeader) + "0 0 0\n1 0.1 0\r\n\n0 1 -2e1\n3 0 1 2\n");
  EXPECT_EQ(mesh.points, (Points(3, 3) << 0, 0, 0, 1, 0.1, 0, 0, 1, -20).finished());
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2}));
  EXPECT_TRUE(mesh.attributes.empty());
}

TEST(PlyReader, PropertiesBecomeAttributes) {
  const Mesh mesh =
      ply("ply\nformat ascii 1.0\nelement vertex 2\nproperty uchar red\nproperty double x\nproperty float y\nproperty "
          "int z\n"
          "property uchar green\nproperty uchar blue\nproperty float nx\nproperty float ny\nproperty float nz\n"
          "property float confidence\nproperty float s\nproperty float t\nend_header\n"
          "255 1 2 3 51 0 0 0 1 0.5 0.25 0.75\n0 4 5 6 0 255 1 0 0 nan 1 0\n");
  EXPECT_EQ(mesh.points, (Points(2, 3) << 1, 2, 3, 4, 5, 6).finished());
  ASSERT_EQ(mesh.attributes.size(), 4U);
  EXPECT_EQ(mesh.attributes[0].name, "normal");
  EXPECT_EQ(mesh.attributes[0].values, (Values(2, 3) << 0, 0, 1, 1, 0, 0).finished());
  EXPECT_EQ(mesh.attributes[1].name, "color");
  EXPECT_EQ(mesh.attributes[1].values, (Values(2, 3) << 1, 0.2, 0, 0, 0, 1).finished());
  EXPECT_EQ(mesh.attributes[2].name, "uv");
  EXPECT_EQ(mesh.attributes[3].name, "confidence");
  EXPECT_EQ(mesh.attributes[3].values(0, 0), 0.5);
}

TEST(PlyReader, UvGoesByThreePairsOfNames) {
  for (const auto& [first, second] : {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v")}) {
    const Mesh mesh = ply(std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n") +
                          "property float z\nproperty float " + second + "\nproperty float " + first +
                          "\nend_header\n0 0 0 0.25 0.5\n");
    ASSERT_EQ(mesh.attributes.size(), 1U);
    EXPECT_EQ(mesh.attributes[0].name, "uv");
    EXPECT_EQ(mesh.attributes[0].values, (Values(1, 2) << 0.5, 0.25).finished());
  }
}

/// A vertex and a face element, between others that are skipped, in every type.
std::string binary_file(io::ByteOrder order, const std::string& format) {
  std::string text = "ply\nformat " + format +
                     " 1.0\nelement camera 1\nproperty list ushort double view\nproperty short id\nelement face 2\n"
                     "property char flag\nproperty list uint ushort vertex_index\nproperty double weight\n"
                     "element vertex 4\nproperty short x\nproperty double y\nproperty float z\nproperty uint8 q\n"
                     "element edge 1\nproperty int a\nend_header\n";
  text += bytes<std::uint16_t>(2, order) + bytes(1.0, order) + bytes(2.0, order) + bytes<std::int16_t>(7, order);
  for (const std::vector<std::uint16_t>& face : {std::vector<std::uint16_t>{0, 1, 2}, {3, 2, 1, 0}}) {
    text += bytes<std::int8_t>(-1) + bytes(static_cast<std::uint32_t>(face.size()), order);
    for (const std::uint16_t vertex : face) text += bytes(vertex, order);
    text += bytes(0.5, order);
  }
  for (int i = 0; i < 4; ++i) {
    text += bytes(static_cast<std::int16_t>(-i), order) + bytes(i + 0.1, order) + bytes(i + 0.5F, order);
    text += bytes(static_cast<std::uint8_t>(250 + i));
  }
  return text + bytes<std::int32_t>(5, order);
}

TEST(PlyReader, ReadsBothByteOrdersAndAnyTypes) {
  for (const bool little : {true, false}) {
    const Mesh mesh = ply(binary_file(little ? io::ByteOrder::Little : io::ByteOrder::Big,
                                      little ? "binary_little_endian" : "binary_big_endian"));
    EXPECT_EQ(mesh.points.row(3), (Eigen::RowVector3d(-3, 3.1, 3.5)));
    EXPECT_EQ(mesh.face_offsets, (Buffer<Index>{0, 3, 7}));
    EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2, 3, 2, 1, 0}));
    ASSERT_EQ(mesh.attributes.size(), 1U);
    EXPECT_EQ(mesh.attributes[0].values(2, 0), 252.0);
  }
}

TEST(PlyReader, RowsWithSeveralListsAreReadToo) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty list uchar float skipped\nproperty float x\n"
      "property float y\nproperty float z\nelement face 2\nproperty list uchar float texcoord\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    text += bytes(static_cast<std::uint8_t>(i));
    for (int k = 0; k < i; ++k) text += bytes(9.0F);
    for (int k = 0; k < 3; ++k) text += bytes(static_cast<float>(i + k));
  }
  for (int face = 0; face < 2; ++face) {
    text += bytes(std::uint8_t{1}) + bytes(0.5F) + bytes(std::uint8_t{3});
    for (int k = 0; k < 3; ++k) text += bytes(std::int32_t{2 - k});
  }
  const Mesh mesh = ply(text);
  EXPECT_EQ(mesh.points.row(2), Eigen::RowVector3d(2, 3, 4));
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{2, 1, 0, 2, 1, 0}));
}

const char* const kStripHeader =
    " 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
    "element tristrips 2\nproperty list int int vertex_indices\nend_header\n";

/// The six vertices of a strip in the plane z = 0, then two strips in three parts: a strip with a jump by repeated
/// vertices, one after a restart, and one in a row of its own.
const std::vector<std::vector<std::int32_t>> kStrips = {{0, 1, 2, 3, 3, 5, 4, -1, 1, 3, 2, -1, 0, 1}, {4, 5, 2}};
const Buffer<Index> kStripFaces = {0, 1, 2, 2, 1, 3, 3, 5, 4, 1, 3, 2, 4, 5, 2};

TEST(PlyReader, TriangleStripsAlternateAndRestart) {
  std::string text = std::string("ply\nformat ascii") + kStripHeader;
  std::string little = std::string("ply\nformat binary_little_endian") + kStripHeader;
  for (int i = 0; i < 6; ++i) {
    text += std::to_string(i % 2) + " " + std::to_string(i / 2) + " 0\n";
    for (const int value : {i % 2, i / 2, 0}) little += bytes(static_cast<float>(value));
  }
  for (const std::vector<std::int32_t>& strip : kStrips) {
    text += std::to_string(strip.size());
    little += bytes(static_cast<std::int32_t>(strip.size()));
    for (const std::int32_t vertex : strip) text += " " + std::to_string(vertex);
    for (const std::int32_t vertex : strip) little += bytes(vertex);
    text += "\n";
  }
  const Mesh mesh = ply(text);
  EXPECT_EQ(mesh.face_vertices, kStripFaces);
  EXPECT_EQ(mesh.face_offsets, (Buffer<Index>{0, 3, 6, 9, 12, 15}));
  expect_same_mesh(mesh, ply(little));
  expect_same_mesh(mesh, parse(io::read_ply, text, 1));
  expect_error([&] { ply(text.substr(0, text.find("5 4 -1")) + "5 6 -1 1 3 2 -1 0 1\n3 0 1 2\n"); },
               ErrorCode::IndexOutOfRange, "names vertex 6");
}

TEST(PlyReader, AStripOfAConsistentFanHasOneOrientation) {
  const Mesh mesh = ply(std::string("ply\nformat ascii") + kStripHeader +
                        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n6 0 1 2 3 4 5\n0\n");
  ASSERT_EQ(mesh.face_count(), 4);
  for (Index face = 0; face < 4; ++face) {
    const auto point = [&](int k) { return Eigen::RowVector3d(mesh.points.row(mesh.face_vertices[3 * face + k])); };
    const Eigen::RowVector3d a = point(1) - point(0);
    const Eigen::RowVector3d b = point(2) - point(0);
    EXPECT_EQ(a[0] * b[1] - a[1] * b[0], 1.0) << face;
  }
}

TEST(PlyReader, FacesAndStripsAreReadFromOneFile) {
  const std::string head = " 1.0\nelement vertex 4\nproperty char x\nproperty char y\nproperty char z\n";
  const std::string faces = "element face 1\nproperty list uchar char vertex_index\n";
  const std::string strips = "element tristrips 1\nproperty list uchar char vertex_index\n";
  const std::string points("\0\0\0\1\0\0\0\1\0\1\1\0", 12);
  const std::string face("\3\0\1\2", 4);
  const std::string strip("\4\0\1\2\3", 5);
  const auto file = [&](const std::string& elements) { return "ply\nformat binary_big_endian" + head + elements; };
  EXPECT_EQ(ply(file(faces + strips + "end_header\n") + points + face + strip).face_vertices,
            (Buffer<Index>{0, 1, 2, 0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(ply(file(strips + faces + "end_header\n") + points + strip + face).face_vertices,
            (Buffer<Index>{0, 1, 2, 2, 1, 3, 0, 1, 2}));
}

/// A triangle whose list has 64-bit entries.
std::string wide_file(io::ByteOrder order, const std::string& format, std::int64_t last) {
  std::string text = "ply\nformat " + format +
                     " 1.0\nelement vertex 3\nproperty int64 x\nproperty uint64 y\nproperty float z\n"
                     "element face 1\nproperty list uint64 int64 vertex_indices\nend_header\n";
  for (int i = 0; i < 3; ++i) text += bytes(std::int64_t{-i}, order) + bytes(std::uint64_t{7}, order) + bytes(0.0F);
  text += bytes(std::uint64_t{3}, order);
  for (const std::int64_t vertex : {std::int64_t{0}, std::int64_t{1}, last}) text += bytes(vertex, order);
  return text;
}

TEST(PlyReader, ReadsIntegersOf64Bits) {
  for (const bool little : {true, false}) {
    const io::ByteOrder order = little ? io::ByteOrder::Little : io::ByteOrder::Big;
    const std::string format = little ? "binary_little_endian" : "binary_big_endian";
    const Mesh mesh = ply(wide_file(order, format, 2));
    EXPECT_EQ(mesh.points.row(2), Eigen::RowVector3d(-2, 7, 0));
    EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2}));
    for (const std::int64_t bad : {std::int64_t{3}, std::int64_t{1} << 32, std::int64_t{-1}}) {
      expect_error([&] { ply(wide_file(order, format, bad)); }, ErrorCode::IndexOutOfRange,
                   "names vertex " + std::to_string(bad));
    }
  }
  std::string text(kTextHeader);
  text.replace(text.find("uchar int"), 9, "uint64 int64");
  EXPECT_EQ(ply(text + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").face_count(), 1);
}

TEST(PlyReader, CarriageReturnsAloneEndLines) {
  const std::string text = std::string(kTextHeader) + "0 0 0\n1 0.1 0\n0 1 -2e1\n3 0 1 2\n";
  expect_same_mesh(ply(text), ply(with_carriage_returns(text)));
  const std::string whole = binary_file(io::ByteOrder::Little, "binary_little_endian");
  const std::size_t body = whole.find("end_header\n") + 11;
  // A body with bytes that look like line ends stays as it is.
  expect_same_mesh(ply(whole), ply(with_carriage_returns(whole.substr(0, body)) + whole.substr(body)));
}

TEST(PlyReader, SkippedElementsAndPropertiesAreNamed) {
  EXPECT_EQ(notes_of(io::read_ply, binary_file(io::ByteOrder::Little, "binary_little_endian")),
            std::vector<std::string>{"test: elements and properties that are skipped: 'camera', 'face flag', "
                                     "'face weight', 'edge'"});
  EXPECT_TRUE(notes_of(io::read_ply, std::string(kTextHeader) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").empty());
}

TEST(PlyReader, EveryCutOfABinaryFileIsAnError) {
  const std::string whole = binary_file(io::ByteOrder::Little, "binary_little_endian");
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_EQ(error_of([&] { ply(whole.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
}

TEST(PlyReader, EveryCutOfATextFileIsAnError) {
  const std::string whole = std::string(kTextHeader) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_EQ(error_of([&] { ply(whole.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
}

TEST(PlyReader, APromiseThatTheFileCannotHoldIsRefusedBeforeMemoryIsTaken) {
  for (const char* format : {"ascii", "binary_little_endian"}) {
    for (const char* count : {"2000000000", "1000000"}) {
      const std::string head = std::string("ply\nformat ") + format + " 1.0\nelement vertex ";
      const std::string tail = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
      expect_error([&] { ply(head + count + tail); }, ErrorCode::BadFile, count);
      expect_error([&] { ply(head + "99999999999" + tail); }, ErrorCode::TooLarge, "32-bit");
    }
  }
}

TEST(PlyReader, ErrorsOfTextNameTheLine) {
  const std::string head(kTextHeader);
  const auto expect = [&](const std::string& body, ErrorCode code, const std::string& part) {
    expect_read_error(io::read_ply, head + body, code, part);
  };
  expect("0 0 0\n1 0\n0 1 0\n3 0 1 2\n", ErrorCode::BadFile, "test:12: missing z");
  expect("0 0 0\n1 0 0\n0 1 x\n3 0 1 2\n", ErrorCode::BadFile, "test:13: 'x' is not a number (z)");
  expect("0 0 0\n1 0 0 9\n0 1 0\n3 0 1 2\n", ErrorCode::BadFile, "test:12: '9' is not the end");
  expect("0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", ErrorCode::NotFinite, "test:12: 'inf'");
  expect("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ErrorCode::IndexOutOfRange, "test:14: a face names vertex 3");
  expect("0 0 0\n1 0 0\n0 1 0\n2 0 1\n", ErrorCode::BadFile, "test:14: a face needs 3");
  expect("0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", ErrorCode::BadFile, "test:14: missing vertex");
}

TEST(PlyReader, ErrorsOfBytesNameTheElementAndTheByte) {
  std::string file =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::size_t body = file.size();
  for (int i = 0; i < 9; ++i) file += bytes(static_cast<float>(i));
  for (int i = 0; i < 2; ++i) file += bytes(std::uint8_t{3}) + bytes(std::int32_t{0}) + bytes(1) + bytes(2);
  EXPECT_EQ(ply(file).face_count(), 2);
  std::string broken = file;
  broken.replace(body + 12, 4, bytes(std::nanf("")));
  expect_error([&] { ply(broken); }, ErrorCode::NotFinite, "vertex 1 ");
  expect_error([&] { ply(broken); }, ErrorCode::NotFinite, "(byte " + std::to_string(body + 12) + ")");
  broken = file;
  broken.replace(broken.size() - 4, 4, bytes(std::int32_t{-1}));
  expect_error([&] { ply(broken); }, ErrorCode::IndexOutOfRange, "face 1 names vertex -1");
  broken = file;
  broken[body + 36] = 2;
  expect_error([&] { ply(broken); }, ErrorCode::BadFile, "face 0 has 2 corners");
}

TEST(PlyReader, HeadersThatSayTooLittleAreErrors) {
  const auto expect = [](const std::string& header, const std::string& part) {
    expect_error([&] { ply(header); }, ErrorCode::BadFile, part);
  };
  expect("plx\n", "begins with");
  expect("ply\nelement vertex 0\nend_header\n", "format");
  expect("ply\nformat ascii 1.0\nend_header\n", "no element 'vertex'");
  expect("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n", "no property 'y'");
  expect("ply\nformat ascii 1.0\nelement vertex 0\nproperty quad x\nend_header\n",
         "test:4: unknown property type 'quad'");
  expect("ply\nformat ascii 1.0\nproperty float x\n", "test:3: a property comes after");
  expect("ply\nformat ascii 1.0\nelement vertex -1\n", "test:3:");
}

TEST(PlyWriter, DoublesSurviveInBytesAndInText) {
  Mesh mesh = random_mesh(5000, 3000);
  mesh.attributes.push_back({"normal", random_doubles(5000, 3, 2), {}});
  mesh.attributes.push_back({"color", random_doubles(5000, 4, 3), {}});
  mesh.attributes.push_back({"uv", random_doubles(5000, 2, 4), {}});
  mesh.attributes.push_back({"weight", random_doubles(5000, 1, 5), {}});
  mesh.attributes[3].values(7, 0) = std::numeric_limits<double>::infinity();
  for (const bool binary : {true, false}) expect_same_mesh(mesh, round_trip(mesh, "ply", binary));
}

TEST(PlyWriter, AMeshWithoutVerticesSurvives) {
  Mesh empty;
  empty.attributes.push_back({"normal", Values(0, 3), {}});
  for (const bool binary : {true, false}) expect_same_mesh(empty, round_trip(empty, "ply", binary));
}

TEST(PlyWriter, ColoursThatCameAsBytesGoAsBytes) {
  Mesh mesh = random_mesh(256, 0);
  mesh.attributes.push_back({"color", Values(256, 3), {}});
  for (Index i = 0; i < 256; ++i) mesh.attributes[0].values.row(i).setConstant(i / 255.0);
  const TemporaryFolder folder;
  for (const bool binary : {true, false}) {
    write_mesh(folder.path("c.ply"), mesh, {"", binary});
    EXPECT_NE(file_text(folder.path("c.ply")).find("property uchar red"), std::string::npos);
    expect_same_mesh(mesh, read_mesh(folder.path("c.ply")));
  }
}

TEST(PlyWriter, OtherColoursGoAsBytesAndExactlyBesideThem) {
  Mesh mesh = random_mesh(4, 0);
  mesh.attributes.push_back(
      {"color", (Values(4, 3) << 0, 0.1, 0.5, 1, 0.999, 1.0 / 510, -2, 7, -0.0, 0, 0, 0).finished(), {}});
  mesh.attributes[0].values(3, 1) = std::nan("");
  const TemporaryFolder folder;
  write_mesh(folder.path("c.ply"), mesh, {"", false});
  const std::string text = file_text(folder.path("c.ply"));
  // Other programs take the properties by name and want bytes.
  const std::string header =
      "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property double exact_red\nproperty double exact_green\nproperty double exact_blue\nend_header\n";
  EXPECT_NE(text.find(header), std::string::npos) << text;
  EXPECT_NE(text.find(" 0 26 128 0 0.1 0.5\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" 255 255 1 1 0.999 "), std::string::npos) << text;
  EXPECT_NE(text.find(" 0 255 0 -2 7 -0\n"), std::string::npos) << text;
  expect_same_mesh(mesh, read_mesh(folder.path("c.ply")));
}

TEST(PlyReader, ChangedBytesOverruleExactColours) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty double exact_red\n"
      "property double exact_green\nproperty double exact_blue\nend_header\n0 0 0 51 0 0 0.2001 0 0\n";
  const auto red_of_first = [&](const std::string& second) {
    const Mesh mesh = ply(head + second);
    EXPECT_EQ(mesh.attributes.size(), 1U);
    return mesh.attributes.at(0).values(0, 0);
  };
  EXPECT_EQ(red_of_first("1 0 0 255 0 0 0.999 0 0\n"), 0.2001);
  EXPECT_EQ(red_of_first("1 0 0 0 255 0 0.999 0 0\n"), 0.2);  // painted green elsewhere
}

TEST(PlyWriter, PolygonsOfAnySizeSurvive) {
  Mesh mesh = random_mesh(100000, 2);
  for (Index i = 0; i < 100000; ++i) mesh.face_vertices.push_back(i);
  mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  for (const bool binary : {true, false}) expect_same_mesh(mesh, round_trip(mesh, "ply", binary));
}

TEST(PlyReader, TinyChunksChangeNothing) {
  const TemporaryFolder folder;
  write_mesh(folder.path("m.ply"), random_mesh(50, 40), {"", false});
  const std::string text = file_text(folder.path("m.ply"));
  for (const std::size_t chunk : {1U, 11U, 50U, 333U}) expect_same_mesh(ply(text), parse(io::read_ply, text, chunk));
}

TEST(PlyReader, AScalarCalledNormalIsNoNormal) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float normal\nend_header\n0 0 0 7\n";
  const Mesh mesh = parse(io::read_ply, text);
  EXPECT_EQ(mesh.attributes.at(0).name, "normal_");
  expect_same_attributes(mesh, round_trip(mesh, "ply"));
}

}  // namespace
}  // namespace batten::io_tests
