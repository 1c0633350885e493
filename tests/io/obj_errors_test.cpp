/// Errors of the OBJ reader name the fault and the line.
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

struct Case {
  const char* line;  ///< the text of line 4
  ErrorCode code;
  const char* part;
};

class ObjErrors : public testing::TestWithParam<Case> {};

TEST_P(ObjErrors, NameTheLine) {
  const std::string text = kTriangle + GetParam().line + "\nv 1 2 3\nf 1 2 3\n";
  for (const std::size_t chunk_bytes : {std::size_t{1}, io::kChunkBytes}) {
    expect_error([&] { parse(io::read_obj, text, chunk_bytes); }, GetParam().code, "test:4: ");
    expect_error([&] { parse(io::read_obj, text, chunk_bytes); }, GetParam().code, GetParam().part);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ObjErrors,
    testing::Values(
        Case{"v 1 2", ErrorCode::BadFile, "missing z coordinate"},
        Case{"v abc 1 2", ErrorCode::BadFile, "'abc' is not a number (x coordinate)"},
        Case{"v 1 2 3x", ErrorCode::BadFile, "'3x'"}, Case{"v 1,0 2 3", ErrorCode::BadFile, "'1,0'"},
        Case{"v +-1 2 3", ErrorCode::BadFile, "'+-1'"}, Case{"v 1 nan 2", ErrorCode::NotFinite, "'nan'"},
        Case{"v 1 2 -inf", ErrorCode::NotFinite, "'-inf'"}, Case{"v 1e999 2 3", ErrorCode::NotFinite, "'1e999'"},
        Case{"v 1 2 3 4 5", ErrorCode::BadFile, "not 5"}, Case{"v 1 2 3 4 5 6 7 8", ErrorCode::BadFile, "'8'"},
        Case{"vt", ErrorCode::BadFile, "missing texture coordinate u"},
        Case{"vn 0 0", ErrorCode::BadFile, "missing normal z"}, Case{"f 1 2", ErrorCode::BadFile, "has 2"},
        Case{"f", ErrorCode::BadFile, "has 0"}, Case{"f 0 1 2", ErrorCode::IndexOutOfRange, "counts from 1"},
        Case{"f 1 2 5", ErrorCode::IndexOutOfRange, "there are 4"},
        Case{"f 1 2 -4", ErrorCode::IndexOutOfRange, "does not exist"},
        Case{"f 1 2 3000000000", ErrorCode::IndexOutOfRange, "3000000000"},
        Case{"f 1 2 99999999999999999999", ErrorCode::BadFile, "not an integer"},
        Case{"f 1/1 2/1 3/1", ErrorCode::IndexOutOfRange, "`vt` that does not exist; there are 0"},
        Case{"f 1//-1 2//1 3//1", ErrorCode::IndexOutOfRange, "`vn`"}, Case{"f 1 2 3.5", ErrorCode::BadFile, "'3.5'"},
        Case{"f 1/ 2", ErrorCode::BadFile, "has 2"}, Case{"f 1 /2 3 1", ErrorCode::BadFile, "'/2'"},
        Case{"f 1/1/1/1 2 3", ErrorCode::BadFile, "not"},
        Case{"t crease 2/1/0 0 4 1", ErrorCode::IndexOutOfRange, "names 4, but there are 4 vertices"},
        Case{"t crease 2/1/0 0 -1 1", ErrorCode::IndexOutOfRange, "count from 0"},
        Case{"t crease 2/1/0 0 1", ErrorCode::BadFile, "missing sharpness"},
        Case{"t crease 2/1/0 0 1 nan", ErrorCode::NotFinite, "'nan'"},
        Case{"t crease 2/1/0 0 1 -2", ErrorCode::BadFile, "0 or more"},
        Case{"t crease 2/1/0 0 1 2 3", ErrorCode::BadFile, "'3'"},
        Case{"t crease 2/1 0 1 2", ErrorCode::BadFile, "look like 2/1/0"},
        Case{"t crease 4/2/0 0 1 2 3 1 1", ErrorCode::BadFile, "crease 2/1/0"},
        Case{"t corner 1/1/0 9 1", ErrorCode::IndexOutOfRange, "9"},
        Case{"t hole 1/0/0 1", ErrorCode::IndexOutOfRange, "there are 1 faces"},
        Case{"t interpolateboundary 1/0/0 3", ErrorCode::BadFile, "0|1|2"},
        Case{"t creasemethod 0/0/1 strange", ErrorCode::BadFile, "normal|chaikin"}));

TEST(ObjErrors, TheFirstWrongLineIsReportedForAnyChunkSize) {
  std::string text;
  for (int i = 1; i <= 100; ++i) text += i % 30 == 0 ? "v x 0 0\n" : "v 0 0 0\n";
  for (const std::size_t chunk_bytes : {1U, 9U, 100U, 100000U}) {
    expect_error([&] { parse(io::read_obj, text, chunk_bytes); }, ErrorCode::BadFile, "test:30: ");
  }
}

TEST(ObjErrors, TheFirstIndexOutOfRangeIsReportedForAnyChunkSize) {
  std::string text = kTriangle + "vt 0 0\n";
  for (int i = 5; i <= 100; ++i) {
    text += i == 61 ? "f 1 2 3/9\n" : i >= 62 && i % 3 == 0 ? "f 9 1 2\n" : "f 1 2 3/-1\n";
  }
  for (const std::size_t chunk_bytes : {1U, 9U, 100U, 100000U}) {
    expect_error([&] { parse(io::read_obj, text, chunk_bytes); }, ErrorCode::IndexOutOfRange, "test:61: ");
  }
}

TEST(ObjErrors, AFileWithoutVerticesIsNoObj) {
  expect_error([] { parse(io::read_obj, "GIF89a \x01\x02\n"); }, ErrorCode::BadFile, "is this an OBJ file?");
}

TEST(ObjErrors, OfSeveralWrongTagsTheFirstIsNamed) {
  const auto read = [] { parse(io::read_obj, "v 0 0 0\nt corner 1/1/0 7 1\nt crease 2/1/0 0 9 1\n"); };
  expect_error(read, ErrorCode::IndexOutOfRange, "test:2: the tag names 7");
}

}  // namespace
}  // namespace batten::io_tests
