#include "batten/expand/texture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "batten/error.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/surface_mesh.h"
#include "io/io_test_tools.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr TexturePreset kPresets[] = {TexturePreset::Marble, TexturePreset::Wood, TexturePreset::Granite,
                                      TexturePreset::Rust, TexturePreset::Clouds};

const Attribute* attribute(const Mesh& mesh, const std::string& name) {
  for (const Attribute& found : mesh.attributes) {
    if (found.name == name) return &found;
  }
  return nullptr;
}

Mesh textured(const Mesh& mesh, const Texture& texture, const TextureOptions& options = {}) {
  return textured_surface(Topology(mesh), {}, mesh, texture, options);
}

TEST(ColorRamp, PassesThroughItsColours) {
  const std::vector<std::array<double, 3>> colors{{0.2, 0.4, 0.6}, {0.5, 0.3, 0.5}, {0.4, 0.6, 0.3}, {0.7, 0.5, 0.4}};
  const ColorRamp ramp(colors);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Eigen::RowVector3d color = ramp.color(static_cast<double>(i) / 3.0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(color[k], colors[i][k], 1e-15);
  }
}

TEST(ColorRamp, IsALineThroughColoursOnALine) {
  const ColorRamp ramp({{0.1, 0.2, 0.9}, {0.2, 0.3, 0.7}, {0.3, 0.4, 0.5}, {0.4, 0.5, 0.3}});
  for (double t = 0.0; t <= 1.0; t += 0.01) {
    EXPECT_NEAR(ramp.color(t)[0], 0.1 + 0.3 * t, 1e-15);
    EXPECT_NEAR(ramp.color(t)[2], 0.9 - 0.6 * t, 1e-15);
  }
}

TEST(ColorRamp, HasAContinuousSecondDerivative) {
  const ColorRamp ramp({{0.2, 0.4, 0.6}, {0.5, 0.3, 0.5}, {0.4, 0.6, 0.3}, {0.7, 0.5, 0.4}, {0.3, 0.3, 0.3}});
  const double step = 1e-4;
  for (const double knot : {0.25, 0.5, 0.75}) {
    const auto bend = [&](double at) -> Eigen::RowVector3d {
      return ramp.color(at - step) - 2.0 * ramp.color(at) + ramp.color(at + step);
    };
    // A jump would be of the step's second power times the curvature, 1e-7; what is left is the third.
    EXPECT_LT((bend(knot - step) - bend(knot + step)).norm(), 1e-9);
  }
}

TEST(ColorRamp, StaysInRange) {
  const ColorRamp ramp({{0.0, 1.0, 0.0}, {1.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {0.0, 1.0, 1.0}});
  for (double t = -0.5; t <= 1.5; t += 0.01) {
    EXPECT_GE(ramp.color(t).minCoeff(), 0.0);
    EXPECT_LE(ramp.color(t).maxCoeff(), 1.0);
  }
  EXPECT_EQ(ramp.color(7.0), Eigen::RowVector3d(0.0, 1.0, 1.0));
  io_tests::expect_error([] { ColorRamp({}); }, ErrorCode::BadArgument, "needs a colour");
  io_tests::expect_error([] { ColorRamp({{0.0, 0.0, 0.0}, {0.0, 1.5, 0.0}}); }, ErrorCode::BadArgument, "colour 1");
}

TEST(Texture, KeepsTheLimitSurfaceAndGivesEachVertexAColour) {
  for (const Mesh& mesh : {torus(8, 6), grid(4, 4), cube()}) {
    const Mesh surface = surface_mesh(Topology(mesh), {}, mesh, 2);
    for (const TexturePreset preset : kPresets) {
      const Mesh colored = textured(mesh, preset_texture(preset), {2});
      EXPECT_TRUE(io_tests::same_bits(colored.points, surface.points));
      const Attribute* color = attribute(colored, "color");
      ASSERT_NE(color, nullptr);
      EXPECT_EQ(color->values.rows(), colored.vertex_count());
      EXPECT_GE(color->values.minCoeff(), 0.0);
      EXPECT_LE(color->values.maxCoeff(), 1.0);
      EXPECT_NE(attribute(colored, "normal"), nullptr);
    }
  }
}

TEST(Texture, BelongsToThePlaceOfItsVertex) {
  // Features are as large as the model, so neighbours, a fiftieth of it apart, have nearly the same colour.
  NoiseOptions noise;
  noise.frequency = 1.0;
  noise.octaves = 1;
  const ColorRamp greys(std::vector<std::array<double, 3>>{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
  for (const Mesh& mesh : {torus(12, 8), dodecahedron(), triangulated(torus(12, 8))}) {
    TextureOptions options;
    options.levels = 3;
    const Mesh colored = textured(mesh, plain_texture(noise, greys), options);
    const Values& colors = attribute(colored, "color")->values;
    const double range = colors.maxCoeff() - colors.minCoeff();
    EXPECT_GT(range, 0.1);
    double most = 0.0;
    for (Index f = 0; f < colored.face_count(); ++f) {
      const Index* v = colored.face_vertices.data() + colored.face_offsets[f];
      most = std::max(most, std::abs(colors(v[0], 0) - colors(v[1], 0)));
    }
    EXPECT_LT(most, 0.25 * range);
  }
}

TEST(Texture, ColoursAMeshAsItIs) {
  TextureOptions options;
  options.flat = true;
  Mesh mesh = test::jittered(torus(8, 6), 0.05, 1);
  mesh.creases = {{0, 1, 2.0}};
  const Mesh colored = textured(mesh, preset_texture(TexturePreset::Clouds), options);
  EXPECT_TRUE(io_tests::same_bits(colored.points, mesh.points));
  EXPECT_EQ(colored.creases.size(), 1U);
  EXPECT_NE(attribute(colored, "color"), nullptr);
}

TEST(Texture, IsTheSameForTheSameSeedOnly) {
  const Mesh mesh = torus(8, 6);
  for (const TexturePreset preset : kPresets) {
    const auto colors = [&](std::uint64_t seed, int threads) {
      const ThreadLimit limit(threads);
      return attribute(textured(mesh, preset_texture(preset, {seed}), {3}), "color")->values;
    };
    const Values once = colors(5, 1);
    EXPECT_TRUE(io_tests::same_bits(once, colors(5, 3)));
    EXPECT_GT((once - colors(6, 1)).cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(Texture, IsTheSameOnAModelInAnyUnit) {
  const Mesh mesh = torus(8, 6);
  Mesh far = mesh;
  far.points = (1024.0 * mesh.points).rowwise() + Eigen::RowVector3d(4096.0, -8192.0, 0.0);
  const Texture wood = preset_texture(TexturePreset::Clouds);
  const Values near_colors = attribute(textured(mesh, wood), "color")->values;
  const Values far_colors = attribute(textured(far, wood), "color")->values;
  // Coordinates of 8192 lose 13 bits less than the shape's size has, 1e-12 of it; the finest octave is 500 times as
  // steep.
  EXPECT_LT((near_colors - far_colors).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Texture, DisplacesAlongTheNormalByTheNoise) {
  const Mesh mesh = icosahedron();
  TextureOptions options;
  options.levels = 4;
  const Texture texture = preset_texture(TexturePreset::Rust);
  const Mesh flat = textured(mesh, texture, options);
  options.displacement = 0.02;
  const Mesh raised = textured(mesh, texture, options);
  const Points moved = raised.points - flat.points;
  const Values& normals = attribute(flat, "normal")->values;
  double squares = 0.0;
  for (Index v = 0; v < flat.vertex_count(); ++v) {
    const double along = moved.row(v).dot(normals.row(v));
    EXPECT_NEAR((moved.row(v) - along * normals.row(v)).norm(), 0.0, 1e-14);
    squares += along * along;
  }
  // The noise's standard deviation is 1 over the seeds; over one surface it strays.
  EXPECT_NEAR(std::sqrt(squares / flat.vertex_count()) / 0.02, 1.0, 0.4);
  EXPECT_EQ(attribute(raised, "normal"), nullptr);
}

TEST(Texture, MovesACreaseBetweenItsSides) {
  Mesh mesh = cube();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (int i = 0; i < 4; ++i) {
      const Index* v = mesh.face_vertices.data() + mesh.face_offsets[f];
      if (v[i] < v[(i + 1) % 4]) mesh.creases.push_back({v[i], v[(i + 1) % 4], 10.0});
    }
  }
  TextureOptions options{1};
  const Texture texture = preset_texture(TexturePreset::Clouds);
  const Mesh flat = textured(mesh, texture, options);
  options.displacement = 0.1;
  const Mesh raised = textured(mesh, texture, options);
  for (Index v = 8; v < 20; ++v) {  // the middles of the edges
    const Eigen::RowVector3d outward = flat.points.row(v).normalized();
    const Eigen::RowVector3d moved = raised.points.row(v) - flat.points.row(v);
    EXPECT_NEAR((moved - moved.dot(outward) * outward).norm(), 0.0, 1e-14);
  }
}

TEST(Texture, NeedsAPatternAndAFiniteDisplacement) {
  const Mesh mesh = cube();
  Texture empty{{}, nullptr, ColorRamp({{0.0, 0.0, 0.0}})};
  io_tests::expect_error([&] { textured(mesh, empty); }, ErrorCode::BadArgument, "pattern");
  TextureOptions options;
  options.displacement = std::nan("");
  io_tests::expect_error([&] { textured(mesh, preset_texture(TexturePreset::Wood), options); }, ErrorCode::BadArgument,
                         "displacement");
}

}  // namespace
}  // namespace batten
