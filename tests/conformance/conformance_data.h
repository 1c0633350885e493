/// \file The names of the files in $BATTEN_DATA that conformance tests read.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/scheme/scheme.h"

namespace batten::test {

/// The folder of the test data, or empty; it is not part of the repository.
inline std::string data_folder() {
  const char* folder = std::getenv("BATTEN_DATA");
  return folder == nullptr ? "" : folder;
}

/// First line of a test that reads the data.
#define BATTEN_REQUIRE_DATA() \
  if (batten::test::data_folder().empty()) GTEST_SKIP() << "set BATTEN_DATA to the folder of the test data"

inline Mesh load_shape(const std::string& name) { return read_mesh(data_folder() + "/osd-shapes/" + name + ".obj"); }
inline Mesh load_model(const std::string& name) { return read_mesh(data_folder() + "/meshes/" + name + ".obj"); }

/// OpenSubdiv's regression shapes that are oriented manifolds.
inline const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> names{"catmark_bishop",         "catmark_cube_corner0",
                                              "catmark_cube_corner2",   "catmark_cube_corner3",
                                              "catmark_cube_corner4",   "catmark_cube_creases0",
                                              "catmark_cube_creases1",  "catmark_cubes_semisharp",
                                              "catmark_dart_edgeonly",  "catmark_edgenone",
                                              "catmark_flap",           "catmark_flap2",
                                              "catmark_fvar_bound0",    "catmark_fvar_bound1",
                                              "catmark_fvar_bound2",    "catmark_fvar_project0",
                                              "catmark_gregory_test1",  "catmark_gregory_test7",
                                              "catmark_gregory_test8",  "catmark_hole_test1",
                                              "catmark_hole_test2",     "catmark_hole_test3",
                                              "catmark_hole_test4",     "catmark_inf_crease1",
                                              "catmark_lefthanded",     "catmark_nonman_bareverts",
                                              "catmark_pawn",           "catmark_pole360",
                                              "catmark_pyramid",        "catmark_pyramid_creases0",
                                              "catmark_rook",           "catmark_single_crease",
                                              "catmark_smoothtris0",    "catmark_tent_creases1",
                                              "catmark_toroidal_tet",   "catmark_torus",
                                              "catmark_val2_back2back", "catmark_val2_foldover",
                                              "catmark_val2_interior",  "loop_chaikin1",
                                              "loop_cube_creases0",     "loop_cube_creases1",
                                              "loop_cubes_semisharp",   "loop_fvar_bound0",
                                              "loop_fvar_bound1",       "loop_fvar_bound2",
                                              "loop_fvar_bound3",       "loop_icos_infsharp",
                                              "loop_icosahedron",       "loop_pole8",
                                              "loop_saddle_edgecorner", "loop_saddle_edgeonly",
                                              "loop_tetrahedron",       "loop_triangle_edgecorner",
                                              "loop_triangle_edgenone", "loop_triangle_edgeonly"};
  return names;
}

inline const std::vector<std::string>& model_names() {
  static const std::vector<std::string> names{"armorguy",       "beast",     "beetle-alt", "bigguy", "fandisk",
                                              "imrod",          "nefertiti", "rocker-arm", "spot",   "spot-quads",
                                              "stanford-bunny", "suzanne",   "t-rex"};
  return names;
}

/// What Topology refuses, and why.
struct RefusedFile {
  std::string path;
  ErrorCode code;
  std::string reason;  ///< a part of the message
};
inline const std::vector<RefusedFile>& refused_files() {
  static const std::vector<RefusedFile> files{
      {"osd-shapes/catmark_nonman_edge100", ErrorCode::NonManifoldEdge, "edge (200, 201) has 100 faces"},
      {"osd-shapes/catmark_nonman_quadpole64", ErrorCode::DegenerateFace, "face 1 uses vertex 4 twice"},
      {"osd-shapes/catmark_nonman_verts", ErrorCode::NonManifoldVertex, "joins"},
      {"osd-shapes/loop_nonman_edge100", ErrorCode::NonManifoldEdge, "edge (100, 101) has 100 faces"},
      {"osd-shapes/loop_nonman_edges", ErrorCode::DegenerateFace, "face 51 uses vertex 45 twice"},
      // Two triangles around an interior vertex of valence 2 have the third edge in common with their surroundings.
      {"osd-shapes/loop_val2_interior", ErrorCode::NonManifoldEdge, "edge (10, 11) has 4 faces"},
      {"meshes/beetle", ErrorCode::NonManifoldEdge, "has 3 faces"},
      {"meshes/teapot", ErrorCode::NonManifoldVertex, "vertex 66 joins 2 separate fans"}};
  return files;
}

/// The scheme that a shape's name and tags ask for.
inline Scheme scheme_of_shape(const std::string& name, const Mesh& mesh) {
  Scheme scheme;
  scheme.kind = name.rfind("loop_", 0) == 0 ? SchemeKind::Loop : SchemeKind::CatmullClark;
  scheme.boundary = mesh.boundary.value_or(scheme.boundary);
  scheme.crease_method = mesh.crease_method.value_or(scheme.crease_method);
  scheme.triangle_rule = mesh.triangle_rule.value_or(scheme.triangle_rule);
  return scheme;
}

/// A test of one shape under the scheme that its file asks for. Skipped without the data.
class ShapeTest : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    BATTEN_REQUIRE_DATA();
    mesh = load_shape(GetParam());
    scheme = scheme_of_shape(GetParam(), mesh);
  }

  /// Calls check(scheme) with each boundary rule.
  template <typename Check>
  void for_each_boundary_rule(const Check& check) {
    for (const auto rule : {BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner}) {
      scheme.boundary = rule;
      check(scheme);
    }
  }
  void take_smooth_triangles() {
    scheme.kind = SchemeKind::CatmullClark;
    scheme.triangle_rule = TriangleRule::Smooth;
  }

  Mesh mesh;
  Scheme scheme;
};

/// A parametrised test's name from a file's.
inline std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name) letter = letter == '-' ? '_' : letter;
  return name;
}

}  // namespace batten::test
