/// Material files, images, and the paths of both.
#include "batten/io/materials.h"

#include "batten/io/file_paths.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

using Color = std::array<double, 4>;

io::Materials mtl(const std::string& text) {
  io::Materials materials;
  io::read_obj_materials("in/paint.mtl", text, materials);
  return materials;
}

TEST(Materials, HaveTheirColoursOpacitiesAndImages) {
  const io::Materials found = mtl(
      "# paint\nKd 1 1 1\nnewmtl red paint\r\nKa 9 9 9\nKd 1 0.5 0\n\tmap_Kd  wood floor.png \nd 0.25\nnewmtl grey\n"
      "Kd 0.5\nTr 0.25\nmap_Kd -s 2 2 1 -o 0.5 -mm 0 1 -clamp on -blendu off sub/w.jpg\nnewmtl plain\nmap_Ks no.png\n");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found.at("red paint").color, (Color{1, 0.5, 0, 0.25}));
  EXPECT_EQ(found.at("red paint").texture, "in/wood floor.png");
  EXPECT_EQ(found.at("grey").color, (Color{0.5, 0.5, 0.5, 0.75}));
  EXPECT_EQ(found.at("grey").texture, "in/sub/w.jpg");
  EXPECT_EQ(found.at("plain").color, (Color{1, 1, 1, 1}));
  EXPECT_EQ(found.at("plain").texture, "");
}

TEST(Materials, AnyTextIsRead) {
  EXPECT_TRUE(mtl("").empty());
  EXPECT_TRUE(mtl("\n\r#\n  \nnewmt").empty());
  EXPECT_EQ(mtl("newmtl a\rKd nan -1 7\rd\rTr x\rmap_Kd\rmap_Kd -o\rmap_Kd -s 1\rKd spectral a.rfl\r").at("a").color,
            (Color{0, 0, 1, 1}));
  EXPECT_EQ(mtl("newmtl a\nKd 0 0 0\nnewmtl a\nKd 1 1 1\n").at("a").color, (Color{0, 0, 0, 1}));
}

TEST(Materials, AreFoundInTheLibrariesOfAMesh) {
  const TemporaryFolder folder;
  make_file(folder.path("paint.mtl"), "newmtl red\nKd 1 0 0\nnewmtl unused\nnewmtl b.png\nmap_Kd c.png\n");
  Mesh mesh;
  mesh.material_libraries = {"missing.mtl", ".", "paint.mtl"};
  mesh.groups = {{"usemtl", "red", 0}, {"g", "unused", 0}, {"usemtl", "a.PNG", 0}, {"usemtl", "b.png", 0}};
  const io::Materials found = io::find_materials(folder.path("m.obj"), mesh);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found.at("red").color, (Color{1, 0, 0, 1}));
  EXPECT_EQ(found.at("a.PNG").texture, folder.path("a.PNG"));
  EXPECT_EQ(found.at("b.png").texture, folder.path("c.png"));
}

TEST(Materials, ImagesAreKnownByTheirFirstBytes) {
  const TemporaryFolder folder;
  make_file(folder.path("a.png"), "\x89PNG\r\n\x1A\n rest");
  make_file(folder.path("b.png"), "no image");
  io::Material material;
  EXPECT_EQ(io::load_image(material), nullptr);
  for (const auto& [name, known] : {std::pair("a.png", true), std::pair("b.png", false), std::pair("c.png", false)}) {
    material.texture = folder.path(name);
    EXPECT_EQ(io::has_image(material), known) << name;
    EXPECT_EQ(io::load_image(material) != nullptr, known) << name;
  }
  material.image = std::make_shared<const std::string>("\xFF\xD8\xFF rest");
  EXPECT_EQ(io::load_image(material), material.image);
  EXPECT_EQ(io::image_type(*material.image), "image/jpeg");
}

TEST(FilePaths, AreRelativeToTheFileThatNamesThem) {
  EXPECT_EQ(io::path_named_in("in/m.obj", "paint.mtl"), "in/paint.mtl");
  EXPECT_EQ(io::path_named_in("m.obj", "./paint.mtl"), "paint.mtl");
  EXPECT_EQ(io::path_named_in("in/m.obj", "/a/paint.mtl"), "/a/paint.mtl");
  EXPECT_EQ(io::name_in("out/deep/m.obj", "in/paint.mtl"), "../../in/paint.mtl");
  EXPECT_EQ(io::name_in("in/m.obj", "in/paint.mtl"), "paint.mtl");
  EXPECT_EQ(io::name_in("standard output", "in/paint.mtl"), "in/paint.mtl");
  EXPECT_EQ(io::name_in("-", "in/paint.mtl"), "in/paint.mtl");
  const TemporaryFolder folder;
  make_file(folder.path("a.png"), "");
  std::filesystem::create_directories(folder.path("sub"));
  EXPECT_EQ(io::path_named_in(folder.path("sub/m.mtl"), "..\\a.png"), folder.path("a.png"));
}

}  // namespace
}  // namespace batten::io_tests
