/// Materials of a glTF file in the files beside an OBJ file.
#include "batten/io/obj_library.h"

#include "batten/error.h"
#include "batten/io/losses.h"
#include "batten/mesh/primitives.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

namespace fs = std::filesystem;

const std::string kPngBytes = "\x89PNG\r\n\x1A\n wood";

/// A cube as read from a GLB: one half is half transparent, the other shows an image.
Mesh cube_from_glb(const TemporaryFolder& folder) {
  fs::create_directories(folder.path("in"));
  make_file(folder.path("in/paint.mtl"), "newmtl red\nKd 1 0.5 0.25\nd 0.5\nnewmtl wood\nmap_Kd my wood.png\n");
  make_file(folder.path("in/my wood.png"), kPngBytes);
  Mesh mesh = cube();
  mesh.attributes = {{"uv", Values(mesh.points.leftCols(2)), {}}};
  mesh.groups = {{"usemtl", "red", 0}, {"usemtl", "wood", 3}};
  mesh.material_libraries = {"paint.mtl"};
  write_mesh(folder.path("in/m.glb"), mesh);
  fs::remove(folder.path("in/paint.mtl"));
  fs::remove(folder.path("in/my wood.png"));
  return read_mesh(folder.path("in/m.glb"));
}

TEST(ObjLibrary, ColoursAndImagesGoFromGlbToObjAndBack) {
  const TemporaryFolder folder;
  write_mesh(folder.path("m.obj"), cube_from_glb(folder));
  fs::remove(folder.path("in/m.glb"));
  const Mesh obj = read_mesh(folder.path("m.obj"));
  EXPECT_EQ(obj.material_libraries, std::vector<std::string>{"m.mtl"});
  EXPECT_EQ(file_text(folder.path("my_wood.png")), kPngBytes);
  write_mesh(folder.path("back.glb"), obj);
  const Mesh back = read_mesh(folder.path("back.glb"));
  const io::Materials found = io::find_materials(folder.path("back.glb"), back);
  ASSERT_EQ(found.size(), 2U);
  const std::array<double, 4> red{1.0, 0.5, 0.25, 0.5};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found.at("red").color[k], red[k], 1e-12) << k;
  ASSERT_NE(io::load_image(found.at("wood")), nullptr);
  EXPECT_EQ(*io::load_image(found.at("wood")), kPngBytes);
  EXPECT_FALSE(io::has_image(found.at("red")));
}

TEST(ObjLibrary, FilesOfOthersStayAndOursAreReplaced) {
  const TemporaryFolder folder;
  const Mesh mesh = cube_from_glb(folder);
  make_file(folder.path("m.mtl"), "newmtl mine\n");
  make_file(folder.path("my_wood.png"), "another picture");
  for (int round = 0; round < 2; ++round) {
    write_mesh(folder.path("m.obj"), mesh);
    EXPECT_EQ(read_mesh(folder.path("m.obj")).material_libraries, std::vector<std::string>{"m-2.mtl"});
    EXPECT_EQ(file_text(folder.path("m.mtl")), "newmtl mine\n");
    EXPECT_EQ(file_text(folder.path("my_wood.png")), "another picture");
    EXPECT_EQ(file_text(folder.path("my_wood-2.png")), kPngBytes);
    EXPECT_NE(file_text(folder.path("m-2.mtl")).find("newmtl red\nKd 1 0.5 0.25\nd 0.5\n"), std::string::npos);
    make_file(folder.path("m-2.mtl"), "# Materials, written by Batten\n");  // before
    EXPECT_FALSE(fs::exists(folder.path("m-3.mtl")) || fs::exists(folder.path("my_wood-3.png")));
  }
}

TEST(ObjLibrary, NothingIsLeftWhereTheMaterialFileCannotBeWritten) {
  const TemporaryFolder folder;
  const Mesh mesh = cube_from_glb(folder);
  make_file(folder.path("m.obj"), "old");
  const io::ObjLibrary library(folder.path("m.obj"), mesh);
  fs::create_directories(folder.path("m.mtl"));
  EXPECT_THROW(library.write(), Error);
  EXPECT_FALSE(fs::exists(folder.path("my_wood.png")));
  write_mesh(folder.path("m.obj"), mesh);  // which takes another name
  EXPECT_TRUE(fs::exists(folder.path("m-2.mtl")));
}

TEST(ObjLibrary, WhatItDoesNotHoldIsTold) {
  const TemporaryFolder folder;
  const Mesh mesh = cube_from_glb(folder);
  EXPECT_EQ(find_losses(folder.path("m.obj"), mesh), std::vector<std::string>{"materials but for colours and images"});
  WriteOptions options;
  options.format = "obj";
  EXPECT_EQ(find_losses("/dev/stdout", mesh, options), std::vector<std::string>{"colours and images of materials"});
  EXPECT_TRUE(io::ObjLibrary("/dev/stdout", mesh).libraries().empty());
  fs::remove(folder.path("in/m.glb"));
  EXPECT_EQ(find_losses(folder.path("m.obj"), mesh), std::vector<std::string>{"material library"});
}

TEST(ObjLibrary, AMeshOfAMaterialFileGetsNone) {
  const TemporaryFolder folder;
  Mesh mesh = cube();
  mesh.groups = {{"usemtl", "red", 0}};
  mesh.material_libraries = {"paint.mtl"};
  write_mesh(folder.path("m.obj"), mesh);
  EXPECT_EQ(read_mesh(folder.path("m.obj")).material_libraries, mesh.material_libraries);
  EXPECT_FALSE(fs::exists(folder.path("m.mtl")));
}

}  // namespace
}  // namespace batten::io_tests
