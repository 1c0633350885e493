/// OFF in and out.
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

Mesh off(const std::string& text) { return parse(io::read_off, text); }

const char* const kRows = "0 0 0\n1 0 0 # corner\n\n0 1 0\n3 0 1 2\n";

TEST(OffReader, TheCountsMayStandAnywhereBehindTheWord) {
  const Mesh mesh = off(std::string("OFF\n3 1 0\n") + kRows);
  EXPECT_EQ(mesh.points, (Points(3, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0).finished());
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2}));
  for (const char* head : {"# a file\nOFF # word\n# more\n\n3 1\n", "OFF 3 1 3\n", "OFF3 1 0\n", "3 1 0\r\n"}) {
    SCOPED_TRACE(head);
    expect_same_mesh(mesh, off(std::string(head) + kRows));
  }
}

TEST(OffReader, CarriageReturnsAloneEndLines) {
  const std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  expect_same_mesh(off(text), off(with_carriage_returns(text)));
}

TEST(OffReader, ReadsColoursAndNormals) {
  const Mesh mesh = off("NCOFF\n1 0 0\n1 2 3 0 0 1 51 0 255 255\n");
  ASSERT_EQ(mesh.attributes.size(), 2U);
  EXPECT_EQ(mesh.attributes[0].name, "normal");
  EXPECT_EQ(mesh.attributes[1].name, "color");
  EXPECT_EQ(mesh.attributes[1].values, (Values(1, 4) << 0.2, 0, 1, 1).finished());
  EXPECT_EQ(off("COFF\n1 0 0\n1 2 3 0.25 0 1 1\n").attributes[0].values(0, 0), 0.25);
}

TEST(OffReader, TheColoursOfFacesAreSkippedAndTold) {
  const std::string vertices = "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string text = vertices + "3 0 1 2 0.5 0.5 0.5\n3 0 1 2 # plain\n3 0 1 2 7\n";
  EXPECT_EQ(off(text).face_vertices, (Buffer<Index>{0, 1, 2, 0, 1, 2, 0, 1, 2}));
  for (const std::size_t chunk_bytes : {std::size_t{1}, io::kChunkBytes}) {
    EXPECT_EQ(notes_of(io::read_off, text, chunk_bytes),
              std::vector<std::string>{"test: colours of faces are skipped: 2"});
  }
  EXPECT_TRUE(notes_of(io::read_off, vertices + "3 0 1 2\n3 0 1 2 # red\n3 0 1 2\n").empty());
}

TEST(OffReader, ANumberSignInsideAWordBeginsNoComment) {
  // A backslash continues the line, so that the 9 is one more word of the first face, wherever the text is cut.
  const std::string text = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7#8\\\n9\n3 2 1 0\n";
  for (const std::size_t chunk_bytes : {std::size_t{1}, io::kChunkBytes}) {
    const Mesh mesh = io::read_off({"test", text, chunk_bytes});
    EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 1, 2, 2, 1, 0}));
  }
}

TEST(OffReader, ErrorsNameTheLine) {
  const auto expect = [](const std::string& text, ErrorCode code, const std::string& part) {
    expect_read_error(io::read_off, text, code, part);
  };
  expect("OFX\n", ErrorCode::BadFile, "test:1: an OFF file begins");
  expect("OFF BINARY\n3 1 0\n", ErrorCode::BadFile, "binary OFF is not read");
  expect("4OFF\n3 1 0\n", ErrorCode::BadFile, "other dimensions");
  expect("OFF\nx 1 0\n", ErrorCode::BadFile, "test:2: 'x' is not an integer");
  expect("OFF\n1 0 0\n1 2\n", ErrorCode::BadFile, "test:3: missing z");
  expect("OFF\n1 0 0\n1 2 3 4\n", ErrorCode::BadFile, "test:3: a vertex has");
  expect("OFF\n2 0 0\n1 2 3\n1 2 3 4\n", ErrorCode::BadFile, "test:4: '4'");
  expect("OFF\n1 0 0\n1 2 nan\n", ErrorCode::NotFinite, "test:3: 'nan'");
  expect("OFF\n1 1 0\n1 2 3\n3 0 0 1\n", ErrorCode::IndexOutOfRange, "test:4: a face names vertex 1");
  expect("OFF\n1 1 0\n1 2 3\n2 0 0\n", ErrorCode::BadFile, "test:4: a face needs 3");
  expect("OFF\n2000000000 2 0\n1 2 3\n", ErrorCode::BadFile, "only 1 lines follow");
  expect("OFF\n1 3000000000 0\n1 2 3\n", ErrorCode::TooLarge, "3000000000");
}

TEST(OffWriter, DoublesAndPolygonsSurvive) {
  Mesh mesh = random_mesh(5000, 3000);
  expect_same_mesh(mesh, round_trip(mesh, "off"));
  const Mesh empty;
  expect_same_mesh(empty, round_trip(empty, "off"));
}

}  // namespace
}  // namespace batten::io_tests
