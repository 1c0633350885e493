/// XYZ in and out.
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

Mesh xyz(const std::string& text) { return parse(io::read_xyz, text); }

TEST(XyzReader, BlanksAndCommasPartTheNumbers) {
  const Points expected = (Points(2, 3) << 1, 2, 3, -4, 5.5, 6).finished();
  for (const char* text : {"1 2 3\n-4 5.5 6", "# head\n1,2,3\r\n\n-4, 5.5,\t6 # tail\n"}) {
    EXPECT_EQ(xyz(text).points, expected) << text;
  }
}

TEST(XyzReader, CarriageReturnsAloneEndLines) {
  EXPECT_EQ(xyz("# two\r1 2 3\r4 5 6\r").points, xyz("1 2 3\n4 5 6\n").points);
}

TEST(XyzReader, SixColumnsArePointsAndNormals) {
  const Mesh mesh = xyz("1 2 3 0 0 1\n4 5 6 1 0 nan\n");
  ASSERT_EQ(mesh.attributes.size(), 1U);
  EXPECT_EQ(mesh.attributes[0].name, "normal");
  EXPECT_EQ(mesh.attributes[0].values(0, 2), 1.0);
}

TEST(XyzReader, OtherColumnsAreKept) {
  const Mesh mesh = xyz("1 2 3 0.5\n4 5 6 0.25\n");
  EXPECT_EQ(mesh.attributes.at(0).name, "extra");
  EXPECT_EQ(mesh.attributes.at(0).values, (Values(2, 1) << 0.5, 0.25).finished());
}

TEST(XyzReader, ErrorsNameTheLine) {
  const auto expect = [](const std::string& text, ErrorCode code, const std::string& part) {
    expect_read_error(io::read_xyz, text, code, part);
  };
  expect("# c\n1 2\n", ErrorCode::BadFile, "test:2: missing z");
  expect("1 2 3\nx 2 3\n", ErrorCode::BadFile, "test:2: 'x'");
  expect("1 2 3\n1 2 3 4\n", ErrorCode::BadFile, "test:2: '4'");
  expect("1 2 3 4\n1 2 3\n", ErrorCode::BadFile, "test:2: ");
  expect("1 2 3\n1 -inf 3\n", ErrorCode::NotFinite, "test:2: '-inf'");
  expect("# nothing\n", ErrorCode::BadFile, "no points");
}

TEST(XyzReader, ColumnsThatOnlyTheFirstLineHasTakeNoMemory) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "1 ";
  for (int i = 0; i < 3000; ++i) text += "\n1";
  expect_error([&] { xyz(text); }, ErrorCode::BadFile, "test:2: the first line has 3000 numbers");
}

TEST(XyzWriter, DoublesSurvive) {
  Mesh mesh;
  mesh.points = random_doubles(20000, 3, 1);
  expect_same_mesh(mesh, round_trip(mesh, "xyz"));
  mesh.attributes.push_back({"normal", random_doubles(20000, 3, 2), {}});
  expect_same_mesh(mesh, round_trip(mesh, "xyz"));
}

}  // namespace
}  // namespace batten::io_tests
