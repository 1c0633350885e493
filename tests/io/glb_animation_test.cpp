/// Morph targets and their animation in GLB, read by tinygltf.
#include <tiny_gltf.h>

#include <cmath>

#include "batten/io/animation.h"
#include "batten/mesh/primitives.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

/// A cube that grows spikes and turns, with normals that change too.
MorphTargets moving(const Mesh& mesh) {
  MorphTargets targets;
  targets.displacements = {0.5 * mesh.points, Points::Constant(mesh.vertex_count(), 3, 1.0 / 3.0)};
  targets.normals = {Values::Constant(mesh.vertex_count(), 3, 0.25), Values::Zero(mesh.vertex_count(), 3)};
  targets.times = {0.0, 0.5, 2.0};
  targets.weights = (Values(3, 2) << 0.125, 0.0, 1.0, 0.5, 0.0, 1.0).finished();
  return targets;
}

tinygltf::Model written(const Mesh& mesh, const MorphTargets& targets) {
  const TemporaryFolder folder;
  write_animation(folder.path("m.glb"), mesh, targets);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, folder.path("m.glb"))) << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

std::vector<float> numbers(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  std::vector<float> values(accessor.count *
                            static_cast<std::size_t>(tinygltf::GetNumComponentsInType(accessor.type & 0xff)));
  if (accessor.type == TINYGLTF_TYPE_SCALAR) values.resize(accessor.count);
  std::memcpy(values.data(), model.buffers[0].data.data() + view.byteOffset, values.size() * sizeof(float));
  return values;
}

TEST(GlbAnimation, KeepsTargetsTimesAndWeights) {
  const Mesh mesh = icosahedron();
  const MorphTargets targets = moving(mesh);
  const tinygltf::Model model = written(mesh, targets);
  const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
  ASSERT_EQ(primitive.targets.size(), 2U);
  // Each vertex is used and there are no seams: vertices stay as they are.
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<float> moved = numbers(model, primitive.targets[i].at("POSITION"));
    const std::vector<float> turned = numbers(model, primitive.targets[i].at("NORMAL"));
    ASSERT_EQ(moved.size(), 36U);
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k / 3);
      const auto column = static_cast<Eigen::Index>(k % 3);
      EXPECT_EQ(moved[k], static_cast<float>(targets.displacements[i](row, column)));
      EXPECT_EQ(turned[k], static_cast<float>(targets.normals[i](row, column)));
    }
  }
  ASSERT_EQ(model.animations.size(), 1U);
  const tinygltf::AnimationChannel& channel = model.animations[0].channels.at(0);
  const tinygltf::AnimationSampler& sampler = model.animations[0].samplers.at(0);
  EXPECT_EQ(channel.target_path, "weights");
  EXPECT_EQ(channel.target_node, 0);
  EXPECT_EQ(sampler.interpolation, "LINEAR");
  EXPECT_EQ(numbers(model, sampler.input), (std::vector<float>{0.0F, 0.5F, 2.0F}));
  EXPECT_EQ(numbers(model, sampler.output), (std::vector<float>{0.125F, 0.0F, 1.0F, 0.5F, 0.0F, 1.0F}));
  EXPECT_EQ(model.accessors[static_cast<std::size_t>(sampler.input)].maxValues, std::vector<double>{2.0});
  EXPECT_EQ(model.meshes[0].weights, (std::vector<double>{0.125, 0.0}));
}

TEST(GlbAnimation, SplitVerticesMoveTogether) {
  Mesh mesh = cube();
  Attribute normal{"normal", Values(6, 3), {}};
  for (Index face = 0; face < 6; ++face) {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (Index i = 0; i < 4; ++i) {
      centre += mesh.points.row(mesh.face_vertices[static_cast<std::size_t>(4 * face + i)]);
      normal.corner_rows.push_back(face);
    }
    normal.values.row(face) = centre.normalized();
  }
  mesh.attributes = {normal};
  MorphTargets targets = moving(mesh);
  // Normals at corners: each its own.
  targets.normals[0] = Values::Zero(24, 3);
  for (Index corner = 0; corner < 24; ++corner) targets.normals[0](corner, 0) = corner;
  const tinygltf::Model model = written(mesh, targets);
  const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
  const std::vector<float> points = numbers(model, primitive.attributes.at("POSITION"));
  const std::vector<float> moved = numbers(model, primitive.targets[0].at("POSITION"));
  ASSERT_EQ(points.size(), 72U);
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_EQ(moved[k], 0.5F * points[k]);
  std::vector<float> turned;
  const std::vector<float> normals = numbers(model, primitive.targets[0].at("NORMAL"));
  for (std::size_t k = 0; k < 72; k += 3) turned.push_back(normals[k]);
  std::sort(turned.begin(), turned.end());
  for (std::size_t k = 0; k < 24; ++k) EXPECT_EQ(turned[k], static_cast<float>(k));
}

TEST(GlbAnimation, RefusesWhatDoesNotFit) {
  const TemporaryFolder folder;
  const Mesh mesh = cube();
  const auto fails = [&](const MorphTargets& targets, ErrorCode code, const char* words) {
    expect_error([&] { write_animation(folder.path("m.glb"), mesh, targets); }, code, words);
  };
  MorphTargets targets = moving(mesh);
  targets.displacements[1].conservativeResize(7, 3);
  fails(targets, ErrorCode::BadShape, "morph target 1 must have 8 rows");
  targets = moving(mesh);
  targets.times[1] = 3.0;
  fails(targets, ErrorCode::BadArgument, "must rise");
  targets = moving(mesh);
  targets.weights(1, 1) = std::nan("");
  fails(targets, ErrorCode::NotFinite, "weight");
  targets = moving(mesh);
  targets.normals.pop_back();
  fails(targets, ErrorCode::BadShape, "all or none");
  targets = moving(mesh);
  targets.weights.resize(3, 1);
  fails(targets, ErrorCode::BadShape, "a weight for each");
  expect_error([&] { write_animation(folder.path("m.obj"), mesh, moving(mesh)); }, ErrorCode::UnknownFormat,
               "only glb");
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace batten::io_tests
