/// Points that were placed in 3D Slicer.
#include "batten/volume/marked_points.h"

#include <gtest/gtest.h>

#include "batten/error.h"
#include "support/errors.h"

namespace batten {
namespace {

std::string list_of(const std::string& type, const std::string& world, const std::string& points) {
  return R"({"type": ")" + type + R"(", "coordinateSystem": ")" + world +
         R"(", "coordinateUnits": "mm", "controlPoints": [)" + points + "]}";
}

std::string markups(const std::string& lists) { return R"({"@schema": "x", "markups": [)" + lists + "]}"; }

const Points kTwo = (Points(2, 3) << 1, 2, 3, -4, 5.5, 6).finished();

TEST(MarkedPoints, MarkupsOfBothWorldsAreOne) {
  const std::string ras = list_of("Fiducial", "RAS", R"({"label": "F-1", "position": [1, 2, 3]})");
  const std::string lps =
      list_of("ClosedCurve", "LPS", R"({"position": [4, -5.5, 6], "positionStatus": "defined", "locked": false})");
  EXPECT_EQ(marked_points("test", markups(ras + "," + lps)), kTwo);
}

TEST(MarkedPoints, PointsThatWereNotPlacedAreLeftOut) {
  const std::string list = list_of("Curve", "RAS",
                                   R"({"position": [0, 0, 0], "positionStatus": "undefined"}, {"position": [1, 2, 3]},
                                      {"positionStatus": "preview"}, {"position": [-4, 5.5, 6]})");
  EXPECT_EQ(marked_points("test", markups(list)), kTwo);
}

TEST(MarkedPoints, TablesOfBothWorldsAreOne) {
  const std::string columns = "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";
  for (const char* world : {"RAS", "0"}) {
    EXPECT_EQ(marked_points(
                  "test", "# Markups fiducial file version = 4.11\n# CoordinateSystem = " + std::string(world) + "\n" +
                              columns + "vtkMRMLMarkupsFiducialNode_0,1,2,3,0,0,0,1,1,1,0,F 1,,\n\n2,-4,5.5,6\n"),
              kTwo);
  }
  for (const char* world : {"LPS", "1"}) {
    EXPECT_EQ(marked_points("test", "# CoordinateSystem = " + std::string(world) + "\r\n,-1,-2,3,,\r\n2, 4 ,-5.5,6"),
              kTwo);
  }
}

TEST(MarkedPoints, ErrorsNameThePlace) {
  const auto expect = [](const std::string& text, ErrorCode code, const std::string& part) {
    test::expect_error([&] { marked_points("test", text); }, code, part);
  };
  expect("a,1,2,3\n", ErrorCode::BadFile, "does not say its world");
  expect("# CoordinateSystem = LPS\n", ErrorCode::BadFile, "no points");
  expect("", ErrorCode::BadFile, "no points");
  expect("# CoordinateSystem = IJK\na,1,2,3\n", ErrorCode::BadFile, "test:1: the coordinate system 'IJK'");
  expect("# CoordinateSystem = LPS\n\na,1,2\n", ErrorCode::BadFile, "test:3: missing z");
  expect("# CoordinateSystem = LPS\na,1,two,3\n", ErrorCode::BadFile, "test:2: 'two' is not a number");
  expect("# CoordinateSystem = LPS\na,1,2 2,3\n", ErrorCode::BadFile, "test:2: '2' is not the end");
  expect("# CoordinateSystem = LPS\na,1,nan,3\n", ErrorCode::NotFinite, "test:2: 'nan'");
  expect("{}", ErrorCode::BadFile, "markups is missing");
  expect(markups(""), ErrorCode::BadFile, "no points");
  expect(markups(R"({"type": "Fiducial", "controlPoints": []})"), ErrorCode::BadFile,
         "markups[0]: coordinateSystem is missing");
  expect(markups(list_of("Fiducial", "IJK", "")), ErrorCode::BadFile, "markups[0].coordinateSystem");
  expect(markups(list_of("Plane", "LPS", "")), ErrorCode::BadFile, "a ClosedCurve");
  expect(markups(list_of("Fiducial", "LPS", R"({"position": [1, 2]})")), ErrorCode::BadFile,
         "markups[0].controlPoints[0].position");
}

TEST(MarkedPoints, NamesTellTheirFiles) {
  EXPECT_TRUE(is_marked_points_path("a/F.mrk.json"));
  EXPECT_TRUE(is_marked_points_path("F.FCSV"));
  EXPECT_FALSE(is_marked_points_path("F.json"));
  EXPECT_FALSE(is_marked_points_path("fcsv"));
}

}  // namespace
}  // namespace batten
