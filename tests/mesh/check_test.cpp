#include "batten/mesh/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "support/shapes.h"

namespace batten {
namespace {

using test::faces_of;
using test::mesh_of_faces;
using test::with_faces;

struct Refusal {
  std::string name;
  Mesh mesh;
  ErrorCode code;
  std::string element;  ///< what the message must name
};

Mesh changed(const std::function<void(Mesh&)>& change) {
  Mesh mesh = cube();
  change(mesh);
  return mesh;
}

/// Four quads, the last glued with a half turn.
Mesh moebius_strip() { return mesh_of_faces(8, {{0, 2, 3, 1}, {2, 4, 5, 3}, {4, 6, 7, 5}, {6, 1, 0, 7}}); }

Mesh one_face_flipped(Mesh mesh, Index face) {
  std::vector<std::vector<Index>> faces = faces_of(mesh);
  std::reverse(faces[face].begin(), faces[face].end());
  return with_faces(mesh, faces);
}

std::vector<Refusal> array_refusals() {
  return {
      {"OffsetsThatDoNotEndAtTheCorners", changed([](Mesh& m) { m.face_offsets.back() = 20; }), ErrorCode::BadShape,
       "24"},
      {"OffsetsThatDoNotStartAtZero", changed([](Mesh& m) { m.face_offsets.front() = 1; }), ErrorCode::BadShape,
       "start with 0"},
      {"OffsetsThatDecrease", changed([](Mesh& m) { m.face_offsets[2] = 20; }), ErrorCode::BadShape, "not decrease"},
      {"NegativeOffsets", changed([](Mesh& m) { m.face_offsets[1] = -4; }), ErrorCode::BadShape, "not decrease"},
      {"NoOffsets", changed([](Mesh& m) { m.face_offsets.clear(); }), ErrorCode::BadShape, "face_offsets"},
      {"NotANumber", changed([](Mesh& m) { m.points(5, 1) = std::nan(""); }), ErrorCode::NotFinite, "vertex 5"},
      {"Infinity", changed([](Mesh& m) { m.points(6, 2) = std::numeric_limits<double>::infinity(); }),
       ErrorCode::NotFinite, "vertex 6"}};
}

std::vector<Refusal> face_refusals() {
  return {{"IndexTooLarge", changed([](Mesh& m) { m.face_vertices[9] = 8; }), ErrorCode::IndexOutOfRange,
           "face 2 names vertex 8"},
          {"NegativeIndex", changed([](Mesh& m) { m.face_vertices[4] = -1; }), ErrorCode::IndexOutOfRange,
           "face 1 names vertex -1"},
          {"FaceOfTwo", mesh_of_faces(3, {{0, 1, 2}, {0, 1}}), ErrorCode::DegenerateFace, "face 1 has only 2"},
          {"FaceOfNone", mesh_of_faces(3, {{}, {0, 1, 2}}), ErrorCode::DegenerateFace, "face 0 has only 0"},
          {"RepeatedVertex", mesh_of_faces(3, {{0, 1, 2, 1}}), ErrorCode::DegenerateFace, "face 0 uses vertex 1 twice"},
          {"RepeatedVertexInALargeFace",
           mesh_of_faces(20, {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 7}}),
           ErrorCode::DegenerateFace, "face 0 uses vertex 7 twice"},
          {"RepeatedFace", mesh_of_faces(4, {{0, 1, 2}, {2, 1, 3}, {1, 2, 0}}), ErrorCode::RepeatedFace,
           "face 2 has the same vertices as face 0"}};
}

std::vector<Refusal> manifold_refusals() {
  return {{"ThreeFacesAtAnEdge", mesh_of_faces(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), ErrorCode::NonManifoldEdge,
           "edge (0, 1) has 3 faces"},
          {"TwoConesAtAVertex", mesh_of_faces(7, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}}),
           ErrorCode::NonManifoldVertex, "vertex 0 joins 2"},
          {"TwoTrianglesAtAVertex", mesh_of_faces(5, {{0, 1, 2}, {2, 3, 4}}), ErrorCode::NonManifoldVertex,
           "vertex 2 joins 2"},
          {"OneFlippedFace", one_face_flipped(cube(), 4), ErrorCode::InconsistentFaces, "face 4"},
          {"MoebiusStrip", moebius_strip(), ErrorCode::NonOrientable, "orientation"}};
}

std::vector<Refusal> tag_refusals() {
  const double infinity = std::numeric_limits<double>::infinity();
  return {{"CreaseThatIsNoEdge", changed([](Mesh& m) {
             m.creases = {{0, 1, 1.0}, {0, 6, 1.0}};
           }),
           ErrorCode::BadArgument, "crease 1 on edge (0, 6)"},
          {"CreaseOutOfRange", changed([](Mesh& m) {
             m.creases = {{0, 8, 1.0}};
           }),
           ErrorCode::IndexOutOfRange, "crease 0"},
          {"CreaseOnANegativeVertex", changed([](Mesh& m) {
             m.creases = {{-1, 1, 1.0}};
           }),
           ErrorCode::IndexOutOfRange, "crease 0"},
          {"CreaseWithoutANumber", changed([](Mesh& m) {
             m.creases = {{0, 1, std::nan("")}};
           }),
           ErrorCode::NotFinite, "crease 0"},
          {"CornerOutOfRange", changed([](Mesh& m) {
             m.corners = {{8, 1.0}};
           }),
           ErrorCode::IndexOutOfRange, "vertex 8"},
          {"CornerWithoutANumber", changed([=](Mesh& m) {
             m.corners = {{2, infinity}};
           }),
           ErrorCode::NotFinite, "vertex 2"},
          {"HoleOutOfRange", changed([](Mesh& m) { m.holes = {6}; }), ErrorCode::IndexOutOfRange, "face 6"},
          {"NegativeHole", changed([](Mesh& m) { m.holes = {-2}; }), ErrorCode::IndexOutOfRange, "face -2"}};
}

class Gate : public ::testing::TestWithParam<Refusal> {};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }
std::string refusal_name(const ::testing::TestParamInfo<Refusal>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Arrays, Gate, ::testing::ValuesIn(array_refusals()), refusal_name);
INSTANTIATE_TEST_SUITE_P(Faces, Gate, ::testing::ValuesIn(face_refusals()), refusal_name);
INSTANTIATE_TEST_SUITE_P(Manifold, Gate, ::testing::ValuesIn(manifold_refusals()), refusal_name);
INSTANTIATE_TEST_SUITE_P(Tags, Gate, ::testing::ValuesIn(tag_refusals()), refusal_name);

TEST_P(Gate, RefusesAndNamesTheElement) {
  try {
    const Topology topology(GetParam().mesh);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), GetParam().code) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().element), std::string::npos) << error.what();
  }
}

TEST_P(Gate, IsExplainedByCheck) {
  const std::vector<MeshProblem> problems = check(GetParam().mesh);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.front().kind, GetParam().code);
  const std::string message = problems.front().messages.at(0);
  EXPECT_NE(message.find(GetParam().element), std::string::npos) << message;
}

TEST(Check, FindsNothingInMeshesThatTopologyAccepts) {
  for (const auto& sample : test::sample_meshes()) {
    EXPECT_NO_THROW(Topology(sample.mesh)) << sample.name;
    EXPECT_TRUE(check(sample.mesh).empty()) << sample.name;
    EXPECT_TRUE(check(test::with_random_tags(sample.mesh, 5)).empty()) << sample.name;
  }
}

TEST(Check, CountsAllAndNamesAtMostTheLimitOfEachKind) {
  Mesh mesh = cube();
  mesh.points.setConstant(std::nan(""));
  mesh.holes = {7, 8, 9};
  for (const std::size_t limit : {1U, 2U, 100U}) {
    const std::vector<MeshProblem> problems = check(mesh, limit);
    ASSERT_EQ(problems.size(), 2U);
    EXPECT_EQ(problems[0].kind, ErrorCode::NotFinite);
    EXPECT_EQ(problems[0].count, 8U);
    EXPECT_EQ(problems[0].messages.size(), std::min<std::size_t>(limit, 8));
    EXPECT_EQ(problems[1].kind, ErrorCode::IndexOutOfRange);
    EXPECT_EQ(problems[1].count, 3U);
    EXPECT_EQ(problems[1].messages.size(), std::min<std::size_t>(limit, 3));
  }
}

TEST(Check, OneFaultDoesNotHideAnother) {
  // A face that uses a vertex twice, a fin, a bow tie, a flipped face and a crease on no edge.
  Mesh mesh = mesh_of_faces(
      16,
      {{0, 1, 1}, {2, 3, 4}, {3, 2, 5}, {2, 3, 6}, {7, 8, 9}, {9, 10, 11}, {12, 13, 14}, {12, 13, 15}, {14, 13, 15}});
  mesh.creases = {{0, 15, 1.0}};
  std::vector<ErrorCode> kinds;
  for (const MeshProblem& problem : check(mesh)) kinds.push_back(problem.kind);
  EXPECT_EQ(kinds,
            (std::vector<ErrorCode>{ErrorCode::DegenerateFace, ErrorCode::NonManifoldEdge, ErrorCode::InconsistentFaces,
                                    ErrorCode::NonManifoldVertex, ErrorCode::BadArgument}));
}

TEST(Check, NamesEachFlippedFaceOfTheMinority) {
  const Mesh mesh = one_face_flipped(one_face_flipped(dodecahedron(), 2), 9);
  const std::vector<MeshProblem> problems = check(mesh, 10);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].count, 2U);
  ASSERT_EQ(problems[0].messages.size(), 2U);
  EXPECT_NE(problems[0].messages[0].find("face 2 "), std::string::npos) << problems[0].messages[0];
  EXPECT_NE(problems[0].messages[1].find("face 9 "), std::string::npos) << problems[0].messages[1];
}

/// Random faces over few vertices: nearly all are refused, for every reason at once.
TEST(Check, AgreesWithTopologyOnRandomFaces) {
  std::mt19937 random(11);
  int accepted = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    test::Faces faces(1 + random() % 4);
    for (auto& face : faces) {
      for (unsigned i = 0; i < 3 + random() % 2; ++i) face.push_back(static_cast<Index>(random() % 7));
    }
    const Mesh mesh = mesh_of_faces(7, faces);
    bool builds = true;
    try {
      const Topology topology(mesh);
    } catch (const Error&) {
      builds = false;
    }
    ASSERT_EQ(check(mesh).empty(), builds) << "trial " << trial;
    accepted += builds ? 1 : 0;
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace batten
