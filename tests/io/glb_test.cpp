/// Written GLB files, read by tinygltf.
#include <array>
#include <cmath>
#include <set>

#include "batten/io/write_check.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "io/glb_test_tools.h"
#include "io/io_test_tools.h"
#include "support/source_folder.h"

namespace batten::io_tests {
namespace {

using Floats = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

tinygltf::Model written(const Mesh& mesh) {
  const TemporaryFolder folder;
  write_mesh(folder.path("m.glb"), mesh);
  return load_glb(folder.path("m.glb"));
}

const unsigned char* bytes_of(const tinygltf::Model& model, const tinygltf::Accessor& accessor) {
  const tinygltf::BufferView& view = model.bufferViews[accessor.bufferView];
  EXPECT_EQ(view.byteOffset % 4, 0U);
  return model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset;
}

Floats floats(const tinygltf::Model& model, const std::string& name) {
  const auto& attributes = model.meshes[0].primitives[0].attributes;
  if (attributes.count(name) == 0) return {};
  const tinygltf::Accessor& accessor = model.accessors[attributes.at(name)];
  EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
  Floats values(static_cast<Eigen::Index>(accessor.count), tinygltf::GetNumComponentsInType(accessor.type));
  std::memcpy(values.data(), bytes_of(model, accessor), sizeof(float) * static_cast<std::size_t>(values.size()));
  return values;
}

std::vector<Index> indices(const tinygltf::Model& model, std::size_t primitive = 0) {
  const tinygltf::Accessor& accessor = model.accessors[model.meshes[0].primitives[primitive].indices];
  const bool small = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  const unsigned char* bytes = bytes_of(model, accessor);
  std::vector<Index> result(accessor.count, 0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::memcpy(&result[i], bytes + i * (small ? 2 : 4), small ? 2 : 4);
  }
  return result;
}

/// Every corner of every triangle has the corner's own numbers, as floats.
void expect_corners(const Mesh& mesh, const tinygltf::Model& model) {
  const Floats positions = floats(model, "POSITION");
  const Floats normals = floats(model, "NORMAL");
  const Floats uvs = floats(model, "TEXCOORD_0");
  const io::CornerList normal = io::corner_list(mesh, "normal");
  const io::CornerList uv = io::corner_list(mesh, "uv");
  const std::vector<Index> vertices = indices(model);
  std::vector<std::array<Index, 3>> triangles;
  std::size_t place = 0;
  for (Index face = 0; face < mesh.face_count(); ++face) {
    triangles.clear();
    triangulate_face(mesh, face, triangles);
    for (const auto& triangle : triangles) {
      for (const Index k : triangle) {
        const Index corner = mesh.face_offsets[face] + k;
        ASSERT_LT(place, vertices.size());
        const Index vertex = vertices[place++];
        EXPECT_EQ(positions.row(vertex), mesh.points.row(mesh.face_vertices[corner]).cast<float>());
        // Half a unit in the last place of a float near 1, for the normal and for its length.
        EXPECT_NEAR(normals.row(vertex).cast<double>().norm(), 1.0, 2e-7);
        const Eigen::RowVector3d given = normal.attribute->values.row(normal.row(mesh, corner));
        EXPECT_LT((normals.row(vertex).cast<double>() - given).norm(), 2e-7);
        if (uv.attribute == nullptr) continue;
        const Eigen::RowVector2d texture = uv.attribute->values.row(uv.row(mesh, corner));
        EXPECT_EQ(uvs(vertex, 0), static_cast<float>(texture[0]));
        EXPECT_EQ(uvs(vertex, 1), static_cast<float>(1.0 - texture[1]));
      }
    }
  }
  EXPECT_EQ(place, vertices.size());
}

/// The unit cube's corners with the normals of their faces and with one texture a face.
Mesh box() {
  Mesh mesh = cube();
  Attribute normal{"normal", Values(6, 3), {}};
  Attribute uv{"uv", (Values(4, 2) << 0, 0, 1, 0, 1, 0.25, 0, 0.25).finished(), {}};
  for (Index face = 0; face < 6; ++face) {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (Index i = 0; i < 4; ++i) {
      centre += mesh.points.row(mesh.face_vertices[4 * face + i]);
      normal.corner_rows.push_back(face);
      uv.corner_rows.push_back(i);
    }
    normal.values.row(face) = centre.normalized();
  }
  mesh.attributes = {normal, uv};
  return mesh;
}

TEST(GlbWriter, EveryCornerKeepsItsPointNormalAndTexture) {
  const tinygltf::Model model = written(box());
  EXPECT_EQ(floats(model, "POSITION").rows(), 24);
  expect_corners(box(), model);
}

TEST(GlbWriter, EqualCornersAreOneVertex) {
  Mesh mesh = torus(9, 7);
  Attribute normal{"normal", mesh.points.rowwise().normalized(), mesh.face_vertices};
  // The same value from another row is the same vertex.
  normal.values.conservativeResize(64, 3);
  normal.values.row(63) = normal.values.row(normal.corner_rows[5]);
  normal.corner_rows[5] = 63;
  mesh.attributes = {normal};
  const tinygltf::Model model = written(mesh);
  EXPECT_EQ(floats(model, "POSITION").rows(), 63);
  expect_corners(mesh, model);
}

TEST(GlbWriter, BoundsAreThoseOfTheWrittenFloats) {
  Mesh mesh = torus(9, 7, 1.0 / 3.0, 0.1);
  const tinygltf::Model model = written(mesh);
  const Floats positions = floats(model, "POSITION");
  const tinygltf::Accessor& accessor = model.accessors[model.meshes[0].primitives[0].attributes.at("POSITION")];
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(accessor.minValues[k], static_cast<double>(positions.col(k).minCoeff()));
    EXPECT_EQ(accessor.maxValues[k], static_cast<double>(positions.col(k).maxCoeff()));
  }
  EXPECT_TRUE(model.nodes[0].translation.empty());
}

TEST(GlbWriter, FarFromTheOriginTheNodeCarriesThePlace) {
  Mesh mesh = torus(9, 7);
  mesh.points.rowwise() += Eigen::RowVector3d(4.5e6, -7.1e5, 12.0);
  const tinygltf::Model model = written(mesh);
  ASSERT_EQ(model.nodes[0].translation.size(), 3U);
  const Eigen::RowVector3d place = Eigen::Map<const Eigen::RowVector3d>(model.nodes[0].translation.data());
  const Values points = floats(model, "POSITION").cast<double>().rowwise() + place;
  // Floats alone would be 0.25 off; these have the precision of floats at the origin and of the doubles' last place.
  EXPECT_LT((points - mesh.points).cwiseAbs().maxCoeff(), 1.5e-7);
}

TEST(GlbWriter, StandsTheModelUprightAndIsReadSo) {
  const TemporaryFolder folder;
  Mesh mesh = cube();
  mesh.points.col(2) *= 3.0;
  mesh.points.rowwise() += Eigen::RowVector3d(1000.0, 2000.0, 4000.0);
  WriteOptions options;
  options.up = UpAxis::Z;
  write_mesh(folder.path("m.glb"), mesh, options);
  const Mesh read = read_mesh(folder.path("m.glb"));
  EXPECT_EQ(find_up_axis(read, "glb"), UpAxis::Y);
  const auto row_of = [&](const Eigen::RowVector3d& point) { return (read.points.rowwise() - point).rowwise().norm(); };
  for (const Eigen::RowVector3d& p : mesh.points.rowwise())
    EXPECT_EQ(row_of({p.x(), p.z(), -p.y()}).minCoeff(), 0.0) << p;
  const Floats normals = floats(load_glb(folder.path("m.glb")), "NORMAL");
  const Floats points = floats(load_glb(folder.path("m.glb")), "POSITION");
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    if (normals(i, 1) <= 0.9F) continue;
    EXPECT_EQ(points(i, 1), points.col(1).maxCoeff());  // the top, which was at the largest z
  }
}

TEST(FindUpAxis, FollowsTheFormatsConventionUnlessTheShapeSaysOtherwise) {
  const Mesh neither = dodecahedron();
  for (const char* format : {"obj", "ply", "off", "glb"}) EXPECT_EQ(find_up_axis(neither, format), UpAxis::Y) << format;
  for (const char* format : {"stl", "xyz"}) EXPECT_EQ(find_up_axis(neither, format), UpAxis::Z) << format;
  const Mesh joint = read_mesh(test::source_folder() + "/models/creature.obj");  // stands on four feet on z
  EXPECT_EQ(find_up_axis(joint, "obj"), UpAxis::Z);
  EXPECT_EQ(find_up_axis(joint, "glb"), UpAxis::Y);
}

TEST(GlbWriter, WithoutNormalsTheyAreTheFacesMean) {
  const Floats normals = floats(written(cube()), "NORMAL");
  const Mesh mesh = cube();
  for (Index v = 0; v < 8; ++v)
    EXPECT_LT((normals.row(v) - mesh.points.row(v).normalized().cast<float>()).norm(), 2e-7);
  Mesh zero = cube();
  zero.attributes = {{"normal", Values::Zero(8, 3), {}}};
  EXPECT_EQ(floats(written(zero), "NORMAL"), normals);
  zero.points.setZero();
  EXPECT_EQ(floats(written(zero), "NORMAL").col(2), Eigen::VectorXf::Ones(8));
}

TEST(GlbWriter, ColorsBecomeLinear) {
  Mesh mesh = cube();
  Attribute color{"color", Values::Constant(8, 4, 0.5), {}};
  color.values.row(0) << 0.0, 1.0, 1.5, 0.25;
  mesh.attributes = {color};
  const tinygltf::Model model = written(mesh);
  const Floats colors = floats(model, "COLOR_0");
  EXPECT_EQ(colors.row(0), Eigen::RowVector4f(0.0F, 1.0F, 1.0F, 0.25F));
  EXPECT_NEAR(colors(1, 0), 0.21404114, 1e-7);  // IEC 61966-2-1
  EXPECT_EQ(colors(1, 3), 0.5F);
  EXPECT_EQ(model.materials[0].alphaMode, "BLEND");
  EXPECT_EQ(model.materials[0].pbrMetallicRoughness.baseColorFactor, std::vector<double>(4, 1.0));
}

TEST(GlbWriter, IndicesAreAsWideAsNeeded) {
  const Mesh mesh = grid(256, 256);
  ASSERT_EQ(mesh.vertex_count(), 257 * 257);
  const tinygltf::Model model = written(mesh);
  EXPECT_EQ(model.accessors[model.meshes[0].primitives[0].indices].componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  const std::vector<Index> wide = indices(model);
  EXPECT_EQ(*std::max_element(wide.begin(), wide.end()), 257 * 257 - 1);
  const tinygltf::Model small = written(grid(3, 3));
  EXPECT_EQ(small.accessors[small.meshes[0].primitives[0].indices].componentType,
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

TEST(GlbWriter, HolesAndLoneVerticesAreNotWritten) {
  Mesh mesh = grid(2, 1);
  mesh.holes = {0};
  mesh.points.conservativeResize(7, 3);
  mesh.points.row(6) << 100, 100, 100;
  const tinygltf::Model model = written(mesh);
  EXPECT_EQ(floats(model, "POSITION").rows(), 4);
  EXPECT_EQ(indices(model).size(), 6U);
}

TEST(GlbWriter, AMaterialIsAPrimitive) {
  Mesh mesh = grid(3, 1);
  mesh.groups = {{"g", "part", 0}, {"usemtl", "red", 1}, {"usemtl", "", 2}};
  const tinygltf::Model model = written(mesh);
  ASSERT_EQ(model.meshes[0].primitives.size(), 2U);
  EXPECT_EQ(model.materials[model.meshes[0].primitives[1].material].name, "red");
  EXPECT_TRUE(model.materials[0].doubleSided);
  EXPECT_EQ(indices(model, 0).size(), 12U);
  const std::vector<Index> red = indices(model, 1);
  EXPECT_EQ(std::set<Index>(red.begin(), red.end()),
            std::set<Index>(mesh.face_vertices.begin() + 4, mesh.face_vertices.begin() + 8));
}

TEST(GlbWriter, RefusesWhatGlbCannotHold) {
  const TemporaryFolder folder;
  const auto expect = [&](void (*spoil)(Mesh&), ErrorCode code, const char* part) {
    Mesh mesh = grid(2, 2);
    spoil(mesh);
    expect_error([&] { write_mesh(folder.path("m.glb"), mesh); }, code, part);
  };
  expect([](Mesh& m) { m.holes = {0, 1, 2, 3}; }, ErrorCode::BadShape, "has no face");
  expect([](Mesh& m) { m.points(0, 0) = 1e39; }, ErrorCode::BadArgument, "too large");
  expect(
      [](Mesh& m) {
        m.attributes = {{"normal", Values::Constant(9, 3, std::nan("")), {}}};
      },
      ErrorCode::NotFinite, "'normal', row 0");
  expect([](Mesh& m) { m.attributes = {{"uv", Values::Constant(9, 2, HUGE_VAL), {}}}; }, ErrorCode::NotFinite, "'uv'");
  expect_error([&] { read_mesh(folder.path("m.usda")); }, ErrorCode::UnknownFormat, "only written");
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(Glb, NumbersWithoutANameInGltfHaveNamesOfTheirOwn) {
  Mesh mesh = octahedron();
  const Values heights = mesh.points.col(2);
  mesh.attributes = {{"Mean height", heights, {}}, {"band", Values::Ones(6, 3), {}}, {"wide", Values::Ones(6, 5), {}}};
  const tinygltf::Model model = written(mesh);
  const Floats places = floats(model, "POSITION");
  const Floats found = floats(model, "_MEAN_HEIGHT");
  ASSERT_EQ(found.rows(), places.rows());
  ASSERT_EQ(found.cols(), 1);
  EXPECT_TRUE((found.col(0).array() == places.col(2).array()).all());
  EXPECT_EQ(floats(model, "_BAND").cols(), 3);
  EXPECT_EQ(floats(model, "_WIDE").size(), 0);
}

TEST(Glb, NumbersWhoseNamesBecomeEqualAreAllWritten) {
  Mesh mesh = octahedron();
  mesh.attributes = {{"a b", Values::Ones(6, 1), {}}, {"a_b", Values::Constant(6, 1, 2.0), {}}};
  const tinygltf::Model model = written(mesh);
  EXPECT_TRUE((floats(model, "_A_B").array() == 1.0F).all());
  ASSERT_GT(floats(model, "_A_B_").size(), 0);
  EXPECT_TRUE((floats(model, "_A_B_").array() == 2.0F).all());
}

}  // namespace
}  // namespace batten::io_tests
