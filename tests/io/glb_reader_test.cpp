/// glTF in.
#include <set>

#include "batten/io/bytes.h"
#include "batten/mesh/primitives.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

Mesh gltf(const std::string& bytes) { return parse(io::read_gltf, bytes); }

/// A GLB of this JSON and this binary part.
std::string glb_file(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto number = [](std::size_t value) {
    io::ByteBuffer bytes;
    bytes.put(static_cast<std::uint32_t>(value));
    return std::string(bytes.text());
  };
  return "glTF" + number(2) + number(28 + json.size() + binary.size()) + number(json.size()) + "JSON" + json +
         number(binary.size()) + std::string("BIN\0", 4) + binary;
}

std::string floats(const std::vector<float>& values) {
  io::ByteBuffer bytes;
  for (const float value : values) bytes.put(value);
  return std::string(bytes.text());
}

/// Four vertices of a square in the plane z = 0, followed by the bytes of `more`.
std::string square(const std::string& more = "") { return floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) + more; }

std::string with_single_quotes(std::string text) {
  std::replace(text.begin(), text.end(), '\'', '"');
  return text;
}

/// A file with `bytes` in one buffer and one view; the other parts are JSON with single quotes.
std::string file_of(const std::string& accessors, const std::string& primitives, const std::string& bytes,
                    const std::string& nodes = "{'mesh':0}", const std::string& more = "") {
  const std::string size = std::to_string(bytes.size());
  const std::string json = "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[" + nodes +
                           "],'meshes':[{'name':'m','primitives':[" + primitives + "]}],'accessors':[" + accessors +
                           "],'bufferViews':[{'buffer':0,'byteLength':" + size + "}],'buffers':[{'byteLength':" + size +
                           "}]" + more + "}";
  return glb_file(with_single_quotes(json), bytes);
}

const char* const kPlaces = "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'}";

/// An accessor of the bytes from `offset`.
std::string accessor(std::size_t offset, int component, int count, const std::string& type,
                     const std::string& more = "") {
  return std::string(",{'bufferView':0,'byteOffset':") + std::to_string(offset) +
         ",'componentType':" + std::to_string(component) + ",'count':" + std::to_string(count) + ",'type':'" + type +
         "'" + more + "}";
}

TEST(GlbReader, ATexturedCubeComesBackWelded) {
  Mesh mesh = cube();
  mesh.attributes.push_back({"uv", (Values(4, 2) << 0, 0, 1, 0, 1, 1, 0, 1).finished(), {}});
  for (std::size_t i = 0; i < mesh.face_vertices.size(); ++i) {
    mesh.attributes[0].corner_rows.push_back(static_cast<Index>(i % 4));
  }
  mesh.attributes.push_back({"color", Values::Constant(8, 3, 0.25), {}});
  mesh.attributes[1].values.col(0).setLinSpaced(8, 0.0, 1.0);
  mesh.groups = {{"usemtl", "red", 0}, {"usemtl", "blue", 2}};
  const TemporaryFolder folder;
  write_mesh(folder.path("m.glb"), mesh);
  const Mesh back = read_mesh(folder.path("m.glb"));
  EXPECT_EQ(back.vertex_count(), 8);
  EXPECT_EQ(back.face_count(), 12);
  ASSERT_EQ(back.groups.size(), 3U);
  EXPECT_EQ(back.groups[1].name, "red");
  EXPECT_EQ(back.groups[2].name, "blue");
  EXPECT_EQ(back.groups[2].first_face, 4);
  ASSERT_EQ(back.attributes.size(), 3U);
  EXPECT_EQ(back.attributes[0].name, "uv");
  EXPECT_TRUE(back.attributes[0].per_corner());
  EXPECT_EQ(back.attributes[2].name, "color");
  EXPECT_FALSE(back.attributes[2].per_corner());
  // Each corner has the place, texture coordinates and colour of the corner that it was.
  for (Index face = 0; face < 12; ++face) {
    std::set<Index> corners;
    for (Index k = 0; k < 3; ++k) {
      const Index corner = 3 * face + k;
      const Index vertex = back.face_vertices[corner];
      for (Index old = 4 * (face / 2); old < 4 * (face / 2) + 4; ++old) {
        const Index place = mesh.face_vertices[old];
        if (mesh.points.row(place) != back.points.row(vertex)) continue;
        corners.insert(old);
        EXPECT_EQ(back.attributes[0].values.row(back.attributes[0].corner_rows[corner]),
                  mesh.attributes[0].values.row(old % 4));
        EXPECT_LT((back.attributes[2].values.row(vertex) - mesh.attributes[1].values.row(place)).norm(), 1e-6);
      }
    }
    EXPECT_EQ(corners.size(), 3U);
  }
}

TEST(GlbReader, NodesMoveTurnAndMirror) {
  // A quarter turn around z after a scaling, below a parent that mirrors x and moves.
  const std::string nodes =
      "{'children':[1],'matrix':[-1,0,0,0,0,1,0,0,0,0,1,0,10,20,30,1]},"
      "{'mesh':0,'translation':[1,0,0],'rotation':[0,0,0.70710678118654752,0.70710678118654752],'scale':[2,3,4]}";
  const std::string normals = floats({0, 0, 1, 0, 0, 1, 0, 0.6F, 0.8F, 1, 0, 0});
  const std::string indices("\0\1\2", 3);
  const Mesh mesh =
      gltf(file_of(std::string(kPlaces) + accessor(48, 5126, 4, "VEC3") + accessor(96, 5121, 3, "SCALAR"),
                   "{'attributes':{'POSITION':0,'NORMAL':1},'indices':2}", square(normals + indices), nodes));
  // (x, y, z) -> (1 - 3y, 2x, 4z) -> (9 + 3y, 20 + 2x, 30 + 4z)
  // The vertex without a corner is left out.
  ASSERT_EQ(mesh.vertex_count(), 3);
  EXPECT_LT((mesh.points - (Points(3, 3) << 9, 20, 30, 9, 22, 30, 12, 20, 30).finished()).norm(), 1e-13);
  EXPECT_EQ(mesh.face_vertices, (Buffer<Index>{0, 2, 1}));  // the mirror image, seen from outside
  ASSERT_EQ(mesh.attributes.size(), 1U);
  ASSERT_FALSE(mesh.attributes[0].per_corner());
  // Normals scale inversely: (0, 0.6 / 3, 0.8 / 4) turned to -x and mirrored. Floats round 0.6 and 0.8.
  const Eigen::RowVector3d expected = Eigen::RowVector3d(0.2, 0, 0.2).normalized();
  EXPECT_LT((mesh.attributes[0].values.row(0) - Eigen::RowVector3d(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((mesh.attributes[0].values.row(2) - expected).norm(), 1e-7);
}

TEST(GlbReader, StripsFansAndUnindexedTriangles) {
  const auto faces = [](int mode) {
    return gltf(file_of(kPlaces, "{'attributes':{'POSITION':0},'mode':" + std::to_string(mode) + "}", square()))
        .face_vertices;
  };
  EXPECT_EQ(faces(4), (Buffer<Index>{0, 1, 2}));
  EXPECT_EQ(faces(5), (Buffer<Index>{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(faces(6), (Buffer<Index>{0, 1, 2, 0, 2, 3}));
}

TEST(GlbReader, NormalizedAndSparseNumbersCount) {
  const std::string uvs("\0\xff\x80\0\0\0\0\xff", 8);                         // bytes from 48
  const std::string sparse = std::string("\3\0\0\0", 4) + floats({5, 6, 7});  // from 56
  const std::string replaced =
      "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','sparse':{'count':1,'indices':{'bufferView':0,"
      "'byteOffset':56,'componentType':5121},'values':{'bufferView':0,'byteOffset':60}}}";
  const Mesh mesh = gltf(file_of(replaced + accessor(48, 5121, 4, "VEC2", ",'normalized':true"),
                                 "{'attributes':{'POSITION':0,'TEXCOORD_0':1},'mode':5}", square(uvs + sparse)));
  EXPECT_EQ(mesh.points.row(3), Eigen::RowVector3d(5, 6, 7));
  ASSERT_EQ(mesh.attributes.size(), 1U);
  EXPECT_FALSE(mesh.attributes[0].per_corner());
  EXPECT_EQ(mesh.attributes[0].values.row(0), Eigen::RowVector2d(0, 0));  // v points up here
  EXPECT_EQ(mesh.attributes[0].values.row(1), Eigen::RowVector2d(128.0 / 255.0, 1));
}

TEST(GlbReader, TextWithABufferOfItsOwnIsRead) {
  const TemporaryFolder folder;
  make_file(folder.path("square.bin"), square());
  const std::string json =
      "{'asset':{'version':'2.0'},'nodes':[{'mesh':0,'name':'a'},{'mesh':0}],'meshes':[{'primitives':[{'attributes':"
      "{'POSITION':0},'mode':5}]}],'accessors':[" +
      std::string(kPlaces) +
      "],'bufferViews':[{'buffer':0,'byteLength':48}],'buffers':[{'byteLength':48,'uri':'square.bin'}]}";
  make_file(folder.path("m.gltf"), with_single_quotes(json));
  const Mesh mesh = read_mesh(folder.path("m.gltf"));
  EXPECT_EQ(mesh.vertex_count(), 8);  // two objects stay two
  EXPECT_EQ(mesh.face_count(), 4);
  expect_error([&] { write_mesh(folder.path("n.gltf"), mesh); }, ErrorCode::UnknownFormat, "only read");
}

TEST(GlbReader, PackedMeshesAreRefusedByName) {
  const std::string plain = "{'attributes':{'POSITION':0}}";
  for (const std::string packing : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    const std::string more = ",'extensionsUsed':['" + packing + "'],'extensionsRequired':['" + packing + "']";
    expect_error([&] { gltf(file_of(kPlaces, plain, square(), "{'mesh':0}", more)); }, ErrorCode::BadFile, packing);
  }
  const std::string draco =
      "{'attributes':{'POSITION':0},'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{}}}}";
  expect_error([&] { gltf(file_of(kPlaces, draco, square())); }, ErrorCode::BadFile, "KHR_draco_mesh_compression");
}

TEST(GlbReader, PartsWithoutAPlaceAreNamed) {
  const std::string points = "{'attributes':{'POSITION':0},'mode':0}";
  const std::string strip = "{'attributes':{'POSITION':0},'mode':5,'targets':[{'POSITION':0}]}";
  EXPECT_EQ(notes_of(io::read_gltf, file_of(kPlaces, points + "," + strip, square())),
            std::vector<std::string>{"test: parts that are skipped: morph targets, points and lines"});
}

TEST(GlbReader, DamagedFilesAreErrors) {
  const std::string plain = "{'attributes':{'POSITION':0}}";
  const auto expect = [](const std::string& file, ErrorCode code, const std::string& part) {
    expect_error([&] { gltf(file); }, code, part);
  };
  const std::string whole = file_of(kPlaces, plain, square());
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_EQ(error_of([&] { gltf(whole.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
  expect(file_of("{'bufferView':0,'componentType':5126,'count':5,'type':'VEC3'}", plain, square()), ErrorCode::BadFile,
         "beyond its buffer");
  expect(file_of("{'componentType':5126,'count':2000000000,'type':'VEC3'}", plain, square()), ErrorCode::BadFile,
         "promises 2000000000 rows");
  expect(file_of("{'bufferView':7,'componentType':5126,'count':4,'type':'VEC3'}", plain, square()), ErrorCode::BadFile,
         "no such bufferView");
  expect(file_of(kPlaces, "{'attributes':{'POSITION':3}}", square()), ErrorCode::BadFile, "no such accessor");
  expect(file_of(std::string(kPlaces) + accessor(48, 5121, 3, "SCALAR"), "{'attributes':{'POSITION':0},'indices':1}",
                 square(std::string("\0\1\4", 3))),
         ErrorCode::IndexOutOfRange, "vertex 4, but its mesh has 4");
  expect(file_of(kPlaces, plain, square(), "{'mesh':0,'children':[0]}"), ErrorCode::BadFile, "two parents");
  expect(file_of(kPlaces, plain, square(), "{'mesh':4}"), ErrorCode::BadFile, "");
  expect(file_of(kPlaces, plain, floats({0, 0, 0, 1, 0, 0, 0, std::nanf(""), 0, 1, 1, 0})), ErrorCode::NotFinite, "");
}

}  // namespace
}  // namespace batten::io_tests
