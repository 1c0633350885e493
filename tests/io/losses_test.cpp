/// What a format does not keep, checked by writing and reading.
#include "batten/io/losses.h"

#include "batten/mesh/primitives.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

using Words = std::vector<std::string>;

/// Something of everything: quads, tags, attributes at vertices and corners, groups of all kinds.
Mesh full_mesh() {
  Mesh mesh = cube();
  const auto vertices = Eigen::Index{mesh.vertex_count()};
  mesh.creases = {{mesh.face_vertices[0], mesh.face_vertices[1], 2.0}};
  mesh.corners = {{0, 3.0}};
  mesh.holes = {5};
  mesh.boundary = BoundaryRule::EdgeAndCorner;
  mesh.crease_method = CreaseMethod::Chaikin;
  mesh.triangle_rule = TriangleRule::Smooth;
  mesh.face_varying = FaceVaryingRule::Boundaries;
  mesh.scheme = SchemeKind::CatmullClark;
  Buffer<Index> rows(mesh.face_vertices.size(), 0);
  mesh.attributes = {{"uv", Values::Zero(1, 2), rows},
                     {"normal", Values::Ones(vertices, 3), {}},
                     {"color", Values::Ones(vertices, 3), {}},
                     {"weight", Values::Ones(vertices, 1), {}}};
  mesh.groups = {{"g", "half", 3}, {"usemtl", "red", 0}, {"s", "1", 0}, {"s", "off", 2}};
  mesh.material_libraries = {"colours.mtl"};
  return mesh;
}

TEST(Losses, EveryFormatNamesWhatItDoesNotKeep) {
  const Mesh mesh = full_mesh();
  const Words tags = {"boundary rule", "creases",       "corners",          "holes",
                      "crease method", "triangle rule", "face-varying rule"};
  const auto with_tags = [&](const Words& before, const Words& after) {
    Words all = before;
    all.insert(all.end(), tags.begin(), tags.end());
    all.insert(all.end(), after.begin(), after.end());
    return all;
  };
  EXPECT_EQ(find_losses("m.obj", mesh), Words{"attribute 'weight'"});
  EXPECT_EQ(find_losses("m.ply", mesh), with_tags({}, {"groups", "materials", "smoothing groups"}));
  const Words values = {"texture coordinates", "normals",         "colours", "attribute 'weight'", "groups",
                        "materials",           "smoothing groups"};
  EXPECT_EQ(find_losses("m.off", mesh), with_tags({}, values));
  EXPECT_EQ(find_losses("m.stl", mesh), with_tags({"polygons (cut into triangles)"}, values));
  EXPECT_EQ(find_losses("m.xyz", mesh), with_tags({"faces"}, {"texture coordinates", "colours", "attribute 'weight'",
                                                              "groups", "materials", "smoothing groups"}));
  EXPECT_EQ(find_losses("m.glb", mesh),
            with_tags({"polygons (cut into triangles)"}, {"groups", "smoothing groups", "material library"}));
  EXPECT_EQ(find_losses("m.usda", mesh), (Words{"normals", "groups", "smoothing groups", "material library"}));
}

/// One part of the full mesh, and whether a file lacks it, found by reading the file again.
TEST(Losses, NoneIsNamedWhereTheMeshComesBackAndOneWhereItDoesNot) {
  const Mesh full = full_mesh();
  std::vector<std::pair<std::string, Mesh>> parts;
  const auto add = [&](const std::string& name, const auto& change) {
    Mesh mesh = cube();
    change(mesh);
    parts.emplace_back(name, std::move(mesh));
  };
  add("creases", [&](Mesh& mesh) { mesh.creases = full.creases; });
  add("corners", [&](Mesh& mesh) { mesh.corners = full.corners; });
  add("holes", [&](Mesh& mesh) { mesh.holes = full.holes; });
  add("boundary", [&](Mesh& mesh) { mesh.boundary = full.boundary; });
  add("method", [&](Mesh& mesh) { mesh.crease_method = full.crease_method; });
  add("triangles", [&](Mesh& mesh) { mesh.triangle_rule = full.triangle_rule; });
  add("face-varying", [&](Mesh& mesh) { mesh.face_varying = full.face_varying; });
  add("group", [&](Mesh& mesh) { mesh.groups = {full.groups[0]}; });
  add("material", [&](Mesh& mesh) { mesh.groups = {full.groups[1]}; });
  add("library", [&](Mesh& mesh) { mesh.material_libraries = full.material_libraries; });
  for (std::size_t i = 0; i < full.attributes.size(); ++i) {
    add(full.attributes[i].name, [&](Mesh& mesh) { mesh.attributes = {full.attributes[i]}; });
  }
  const auto facts = [](const Mesh& mesh) {
    return std::tuple(mesh.face_vertices, mesh.creases.size(), mesh.corners.size(), mesh.holes, mesh.boundary,
                      mesh.crease_method, mesh.triangle_rule, mesh.face_varying, mesh.groups.size(),
                      mesh.material_libraries, mesh.attributes.size());
  };
  for (const auto& part : parts) {
    for (const std::string format : {"obj", "ply", "off", "xyz"}) {
      const bool same = facts(part.second) == facts(round_trip(part.second, format));
      EXPECT_EQ(find_losses("m." + format, part.second).empty(), same) << part.first << " in " << format;
    }
  }
}

TEST(Losses, PlyKeepsImagesButNoOtherMaterials) {
  Mesh mesh = cube();
  mesh.groups = {{"usemtl", "wood.png", 1}, {"usemtl", "untextured", 2}, {"usemtl", "stone.jpg", 4}};
  EXPECT_EQ(find_losses("m.ply", mesh), Words{});
  const Mesh read = round_trip(mesh, "ply");
  ASSERT_EQ(read.groups.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(read.groups[i].name, mesh.groups[i].name);
  mesh.groups.push_back({"usemtl", "red", 5});
  EXPECT_EQ(find_losses("m.ply", mesh), Words{"materials"});
}

TEST(Losses, WhatReadersAssumeAnywayIsNone) {
  Mesh mesh = cube();
  mesh.boundary = BoundaryRule::EdgeOnly;
  mesh.crease_method = CreaseMethod::Uniform;
  mesh.triangle_rule = TriangleRule::Catmark;
  mesh.face_varying = FaceVaryingRule::All;
  mesh.scheme = SchemeKind::CatmullClark;
  mesh.groups = {{"s", "off", 0}};
  for (const char* path : {"m.obj", "m.ply", "m.off", "m.usda"}) EXPECT_EQ(find_losses(path, mesh), Words{}) << path;
  mesh.scheme = SchemeKind::Loop;
  EXPECT_EQ(find_losses("m.obj", mesh), Words{"scheme"});
  EXPECT_EQ(find_losses("m.usda", mesh), Words{});
  mesh.scheme = SchemeKind::Butterfly;
  EXPECT_EQ(find_losses("m.usda", mesh), Words{"scheme"});
}

TEST(Losses, FloatsCountWhereTheyAreTooCoarse) {
  Mesh mesh = octahedron();
  EXPECT_EQ(find_losses("m.stl", mesh), Words{});
  mesh.points.rowwise() += Eigen::RowVector3d(4.5e6, 5.2e5, 0);
  EXPECT_EQ(find_losses("m.stl", mesh), Words{"digits of the coordinates"});
  EXPECT_EQ(find_losses("m.stl", mesh, {"", false}), Words{});
  EXPECT_EQ(find_losses("m.glb", mesh), Words{});
}

TEST(Losses, LooseVerticesAndUnknownFormats) {
  Mesh mesh = octahedron();
  mesh.points.conservativeResize(7, 3);
  mesh.points.row(6).setZero();
  EXPECT_EQ(find_losses("m.stl", mesh), Words{"vertices without a face"});
  EXPECT_EQ(find_losses("m.ply", mesh), Words{});
  expect_error([&] { find_losses("m.abc", mesh); }, ErrorCode::UnknownFormat, "'abc'");
  expect_error([&] { find_losses("m.gltf", mesh); }, ErrorCode::UnknownFormat, "only read");
  EXPECT_EQ(find_losses("-", mesh, {"xyz"}), Words{"faces"});
}

}  // namespace
}  // namespace batten::io_tests
