/// Base colours and images of materials in glTF, in and out.
#include "batten/io/glb_materials.h"
#include "batten/io/losses.h"
#include "batten/mesh/primitives.h"
#include "io/glb_test_tools.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

/// A PNG of one pixel.
const unsigned char kPixel[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00,
    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xdf, 0xa0, 0x00, 0x00, 0x04, 0x21, 0x01, 0xa0, 0x4d,
    0xbf, 0x32, 0x90, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
};
const std::string kPng(reinterpret_cast<const char*>(kPixel), sizeof(kPixel));

/// A cube whose halves have two materials, and texture coordinates.
Mesh painted_cube() {
  Mesh mesh = cube();
  mesh.attributes = {{"uv", Values(mesh.points.leftCols(2)), {}}};
  mesh.groups = {{"usemtl", "red", 0}, {"usemtl", "wood", 3}};
  mesh.material_libraries = {"paint.mtl"};
  return mesh;
}

void make_paint(const TemporaryFolder& folder) {
  make_file(folder.path("paint.mtl"), "newmtl red\nKd 1 0.5 0\nd 0.5\nnewmtl wood\nmap_Kd sub/wood.png\n");
  std::filesystem::create_directories(folder.path("sub"));
  make_file(folder.path("sub/wood.png"), kPng);
}

/// What a viewer sees of the painted cube.
void expect_paint(const tinygltf::Model& model) {
  ASSERT_EQ(model.materials.size(), 2U);
  const tinygltf::Material& red = model.materials[0];
  EXPECT_EQ(red.name, "red");
  EXPECT_EQ(red.alphaMode, "BLEND");
  const std::vector<double>& color = red.pbrMetallicRoughness.baseColorFactor;
  ASSERT_EQ(color.size(), 4U);
  EXPECT_NEAR(color[0], 1.0, 1e-12);
  EXPECT_NEAR(color[1], 0.21404114048223255, 1e-12);  // sRGB's 0.5
  EXPECT_NEAR(color[2], 0.0, 1e-12);
  EXPECT_NEAR(color[3], 0.5, 1e-12);
  EXPECT_LT(red.pbrMetallicRoughness.baseColorTexture.index, 0);
  const tinygltf::Material& wood = model.materials[1];
  EXPECT_EQ(wood.alphaMode, "OPAQUE");
  ASSERT_EQ(model.images.size(), 1U);
  ASSERT_EQ(wood.pbrMetallicRoughness.baseColorTexture.index, 0);
  EXPECT_EQ(model.textures.at(0).source, 0);
  const tinygltf::Image& image = model.images[0];
  EXPECT_EQ(image.mimeType, "image/png");
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(image.bufferView));
  const std::vector<unsigned char>& data = model.buffers[0].data;
  EXPECT_EQ(std::string(data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset),
                        data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset + view.byteLength)),
            kPng);
  EXPECT_EQ(view.byteOffset % 4, 0U);
}

TEST(GlbMaterials, ColoursAndImagesOfAMaterialFileAreWritten) {
  const TemporaryFolder folder;
  make_paint(folder);
  const Mesh mesh = painted_cube();
  write_mesh(folder.path("m.glb"), mesh);
  expect_paint(load_glb(folder.path("m.glb")));
  const std::vector<std::string> losses = find_losses(folder.path("m.glb"), mesh);
  EXPECT_EQ(losses,
            (std::vector<std::string>{"polygons (cut into triangles)", "materials but for colours and images"}));
}

TEST(GlbMaterials, ComeBackFromTheFileThatTheyWereReadFrom) {
  const TemporaryFolder folder;
  make_paint(folder);
  write_mesh(folder.path("m.glb"), painted_cube());
  const Mesh mesh = read_mesh(folder.path("m.glb"));
  EXPECT_EQ(mesh.material_libraries, std::vector<std::string>{folder.path("m.glb")});
  write_mesh(folder.path("sub/n.glb"), mesh);
  std::filesystem::remove(folder.path("paint.mtl"));
  std::filesystem::remove(folder.path("sub/wood.png"));
  expect_paint(load_glb(folder.path("sub/n.glb")));
}

TEST(GlbMaterials, AMeshWithoutMaterialsNamesNoLibrary) {
  const TemporaryFolder folder;
  Mesh mesh = cube();
  write_mesh(folder.path("m.glb"), mesh);
  EXPECT_TRUE(read_mesh(folder.path("m.glb")).material_libraries.empty());
  mesh.attributes = {{"color", Values::Constant(8, 3, 0.5), {}}};
  write_mesh(folder.path("m.glb"), mesh);
  EXPECT_TRUE(read_mesh(folder.path("m.glb")).material_libraries.empty());
}

TEST(GlbMaterials, AnImageOfAPlyFileIsWrittenOnce) {
  const TemporaryFolder folder;
  make_file(folder.path("a.png"), kPng);
  Mesh mesh = painted_cube();
  mesh.material_libraries.clear();
  mesh.groups = {{"usemtl", "a.png", 0}, {"usemtl", "b.png", 3}, {"usemtl", "./a.png", 4}};
  write_mesh(folder.path("m.glb"), mesh);
  const tinygltf::Model model = load_glb(folder.path("m.glb"));
  ASSERT_EQ(model.materials.size(), 3U);
  EXPECT_EQ(model.images.size(), 1U);
  EXPECT_EQ(model.materials[0].pbrMetallicRoughness.baseColorTexture.index, 0);
  EXPECT_EQ(model.materials[1].pbrMetallicRoughness.baseColorTexture.index, -1);
  EXPECT_EQ(model.materials[2].pbrMetallicRoughness.baseColorTexture.index, 0);
  const std::vector<std::string> losses = find_losses(folder.path("m.glb"), mesh);
  EXPECT_EQ(losses.back(), "images of materials");
}

/// A triangle whose material has this base colour texture, and these other parts, in single quotes.
std::string text_gltf(const std::string& texture, const std::string& more) {
  std::string text =
      "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{'primitives':[{"
      "'attributes':{'POSITION':0},'material':0}]}],'accessors':[{'bufferView':0,'componentType':5126,'count':3,"
      "'type':'VEC3','min':[0,0,0],'max':[1,1,0]}],'bufferViews':[{'buffer':0,'byteLength':36}],'buffers':[{"
      "'byteLength':36,'uri':'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}],"
      "'materials':[{'name':'m','pbrMetallicRoughness':{'baseColorTexture':" +
      texture + "}}],'textures':[{'source':0}]," + more + "}";
  std::replace(text.begin(), text.end(), '\'', '"');
  return text;
}

TEST(GlbMaterials, ImagesInTheTextAndInFilesAreFound) {
  const TemporaryFolder folder;
  make_file(folder.path("my wood.png"), kPng);
  const std::string data =
      "data:image/"
      "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP436AAAAQhAaBNvzKQAAAAAElFTkSuQmCC";
  for (const std::string& uri : {data, std::string("my%20wood.png")}) {
    make_file(folder.path("m.gltf"), text_gltf("{'index':0}", "'images':[{'uri':'" + uri + "'}]"));
    std::vector<std::string> notes;
    const Mesh mesh = read_mesh(folder.path("m.gltf"), "", {}, &notes);
    EXPECT_TRUE(notes.empty());
    const io::Materials found = io::find_materials(folder.path("out.glb"), mesh);
    ASSERT_EQ(found.size(), 1U);
    const auto image = io::load_image(found.at("m"));
    ASSERT_NE(image, nullptr);
    EXPECT_EQ(*image, kPng);
  }
}

TEST(GlbMaterials, WhatIsNotKeptIsTold) {
  const std::string image = "'images':[{'uri':'data:image/png;base64,AAAA'}]";
  const auto notes = [&](const std::string& texture) {
    const std::vector<std::string> all = notes_of(io::read_gltf, text_gltf(texture, image));
    return all.empty() ? std::string() : all[0];
  };
  EXPECT_NE(notes("{'index':0,'texCoord':1}").find("second set"), std::string::npos);
  EXPECT_NE(notes("{'index':0,'extensions':{'KHR_texture_transform':{}}}").find("texture transform"),
            std::string::npos);
  // Bytes without a file cannot be read again.
  EXPECT_NE(notes("{'index':0}").find("colours and images of materials"), std::string::npos);
}

}  // namespace
}  // namespace batten::io_tests
