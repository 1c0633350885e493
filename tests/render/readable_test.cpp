/// What a picture tells must be readable from its pixels: colours that measure, colours asked for, lines and dots.
#include <gtest/gtest.h>

#include <algorithm>

#include "batten/render/panels.h"
#include "batten/render/srgb.h"
#include "render/pixels.h"

namespace batten {
namespace {

using test::brightness;
using test::different_pixels;
using test::Pixel;
using test::pixel;
using test::small_front_view;
using test::sphere_scene;

int byte_of(float linear) { return static_cast<int>(std::lround(255.0F * render_detail::encode_srgb(linear))); }

/// A square of side 2 that lies in the plane z = 0, of n by n faces.
Mesh plate(Index n) {
  Mesh mesh = grid(n, n);
  const Eigen::RowVector3d middle = 0.5 * (mesh.points.colwise().minCoeff() + mesh.points.colwise().maxCoeff());
  const double size = mesh.points.col(0).maxCoeff() - mesh.points.col(0).minCoeff();
  mesh.points = (mesh.points.rowwise() - middle) * (2.0 / size);
  return mesh;
}

RenderOptions from_above(int width = 240, int height = 180) {
  RenderOptions options = small_front_view();
  options.width = width;
  options.height = height;
  options.direction = {0.0, 0.0, 1.0};
  options.ground = Ground::None;
  return options;
}

/// One line from (x, -1) to (x, 1) at this height.
Mesh line_at(double x, double z) {
  Mesh mesh;
  mesh.points.resize(2, 3);
  mesh.points << x, -1.0, z, x, 1.0, z;
  mesh.add_face({0, 1});
  return mesh;
}

TEST(ReadableColors, MeasuredOnesAreThoseOfTheBarAndAtMostATenthDarker) {
  Scene scene = sphere_scene();
  scene.scale.low = 0.0;
  scene.scale.high = 1.0;
  for (const double value : {0.0, 0.3, 0.7, 1.0}) {
    scene.scalars = Scalars::Constant(scene.surface.vertex_count(), value);
    const Color color = map_color(ColorMap::Sequential, value);
    const Picture picture = render(scene, small_front_view());
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        if (std::hypot(x - 119.5, y - 89.5) > 72.0) continue;  // the rim is mixed with the background
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_LE(pixel(picture, x, y)[c], byte_of(color[c]) + 1);
          EXPECT_GE(pixel(picture, x, y)[c], byte_of(0.9F * color[c]) - 1);
        }
      }
    }
  }
}

/// The median of a channel over the pixels that are not background.
int median_of(const Picture& picture, std::size_t channel) {
  const Pixel background = pixel(picture, 0, 0);
  std::vector<int> values;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (pixel(picture, x, y) != background) values.push_back(pixel(picture, x, y)[channel]);
    }
  }
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

TEST(ReadableColors, AskedOnesComeOutWithinThreePercentInTheMedian) {
  for (const Mesh& shape : {test::sphere(96, 48), plate(4), torus(60, 30)}) {
    for (const Color& color : {Color{0.5F, 0.5F, 0.5F}, {0.7F, 0.1F, 0.05F}, {0.05F, 0.1F, 0.4F}, {0.8F, 0.8F, 0.8F}}) {
      Scene scene;
      scene.surface = shape;
      scene.colors.resize(shape.vertex_count(), 3);
      for (Eigen::Index c = 0; c < 3; ++c) scene.colors.col(c).setConstant(color[static_cast<std::size_t>(c)]);
      RenderOptions options = small_front_view();
      options.direction = {0.5, -1.0, 0.8};
      options.ground = Ground::None;
      const Picture picture = render(scene, options);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(median_of(picture, c), byte_of(color[c]), 0.03 * byte_of(color[c]));
    }
  }
}

TEST(ReadableColors, WhiteOnesStandOffFromTheBackground) {
  Scene scene = sphere_scene();
  const PictureStyle usual;
  EXPECT_EQ(style_beside(scene, usual).background, usual.background);
  scene.colors = Values::Constant(scene.surface.vertex_count(), 3, 0.3);
  EXPECT_EQ(style_beside(scene, usual).background, usual.background);
  scene.colors.setConstant(0.97);
  RenderOptions options = small_front_view();
  options.style = style_beside(scene, usual);
  const Picture picture = render(scene, options);
  EXPECT_GT(brightness(pixel(picture, 120, 90)) - brightness(pixel(picture, 3, 3)), 100);
}

TEST(ReadableLines, BehindTheSurfaceTheyAreFaint) {
  Scene scene;
  scene.surface = plate(2);
  const Picture without = render(scene, from_above());
  const auto darker = [&](double z) {
    Scene with = scene;
    with.lines = line_at(0.0, z);
    const Picture picture = render(with, from_above());
    int most = 0;
    for (int x = 110; x < 130; ++x)
      most = std::max(most, brightness(pixel(without, x, 90)) - brightness(pixel(picture, x, 90)));
    return most;
  };
  const int front = darker(0.1);
  const int just_below = darker(-0.05);
  const int far_below = darker(-0.5);
  EXPECT_GT(front, 80);
  EXPECT_LT(just_below, front / 2);
  EXPECT_GT(just_below, far_below);
  EXPECT_GE(far_below, 4);
}

TEST(ReadableLines, InTheSurfaceTheyDoNotSinkOrFlicker) {
  Scene scene;
  scene.surface = plate(2);
  // From 0.002 above the surface at one end to 0.002 below it at the other: within the thickness of the line.
  scene.lines = line_at(0.31, 0.002);
  scene.lines.points(1, 2) = -0.002;
  const Picture picture = render(scene, from_above());
  int lightest = 0;
  int darkest = 765;
  for (int y = 25; y < 155; ++y) {
    int across = 765;
    for (int x = 120; x < 160; ++x) across = std::min(across, brightness(pixel(picture, x, y)));
    lightest = std::max(lightest, across);
    darkest = std::min(darkest, across);
  }
  EXPECT_LT(lightest - darkest, 60);
  EXPECT_LT(lightest, 480);
}

TEST(ReadableLines, AreThinInPicturesOfAnySize) {
  Scene scene;
  scene.surface = plate(2);
  scene.lines = line_at(0.0, 0.01);
  for (const int height : {180, 720}) {
    const Picture picture = render(scene, from_above(height * 4 / 3, height));
    int dark = 0;
    const int plain = brightness(pixel(picture, picture.width / 2 + height / 10, height / 2));
    for (int x = picture.width / 2 - height / 10; x < picture.width / 2 + height / 10; ++x)
      dark += brightness(pixel(picture, x, height / 2)) < plain - 60 ? 1 : 0;
    EXPECT_GE(dark, 1) << height;
    EXPECT_LE(dark, 3) << height;
  }
}

TEST(ReadableLines, AreLeftOutWhereTheyWouldCoverMoreThanAFifth) {
  Scene scene;
  scene.surface = plate(2);
  const Picture without = render(scene, from_above());
  std::vector<std::string> notes;
  scene.lines = plate(90);
  EXPECT_EQ(different_pixels(render(scene, from_above(), {}, &notes), without), 0);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].find("the lines are not drawn: they would cover "), 0U) << notes[0];
  // Fewer lines cover less, and of as many as just fit all are drawn, thinner.
  notes.clear();
  scene.lines = plate(16);
  const int changed = different_pixels(render(scene, from_above(), {}, &notes), without);
  EXPECT_GT(changed, 1000);
  EXPECT_TRUE(notes.empty());
}

TEST(ReadableLines, ThatMeasureHaveTheColoursOfTheBarAndStay) {
  Scene scene;
  scene.surface = plate(2);
  scene.lines = line_at(0.0, 0.01);
  scene.line_scalars = Scalars::Constant(1, 1.0);
  const Picture picture = render(scene, from_above(960, 720));
  const Color top = map_color(ColorMap::Sequential, 1.0);
  const Pixel middle = pixel(picture, 480, 360);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(middle[c], byte_of(top[c]), 2);
  scene.lines = plate(90);
  scene.line_scalars = Scalars::Constant(scene.lines.face_count(), 1.0);
  std::vector<std::string> notes;
  render(scene, from_above(), {}, &notes);
  EXPECT_TRUE(notes.empty());
  scene.line_scalars = Scalars::Constant(3, 1.0);
  EXPECT_EQ(test::code_of([&] { render(scene); }), ErrorCode::BadShape);
}

TEST(ReadableShadow, FadesBeforeTheFrame) {
  Scene scene = sphere_scene();
  scene.surface.points.col(2) *= 0.3;
  RenderOptions options = small_front_view();
  options.direction = {0.4, -1.0, 0.6};
  const Picture picture = render(scene, options);
  // No step between neighbours in the outer twelve pixels of the picture, and nothing at its edge.
  for (int y = 1; y < picture.height; ++y) {
    for (int x = 1; x < picture.width; ++x) {
      if (std::min({x, y, picture.width - x, picture.height - y}) > 12) continue;
      EXPECT_LE(std::abs(brightness(pixel(picture, x, y)) - brightness(pixel(picture, x - 1, y))), 12);
      EXPECT_LE(std::abs(brightness(pixel(picture, x, y)) - brightness(pixel(picture, x, y - 1))), 12);
    }
  }
}

TEST(PanelRows, StandBelowEachOtherTheLastCentred) {
  const auto plain = [](unsigned char value) {
    Picture picture{4, 2, 3, {}};
    picture.pixels.assign(24, value);
    return Panel{picture, ""};
  };
  const Picture picture = in_rows({plain(10), plain(20), plain(30), plain(40), plain(50)}, 3);
  EXPECT_EQ(picture.width, 12);
  EXPECT_EQ(picture.height, 4);
  EXPECT_EQ(pixel(picture, 9, 0)[0], 30);
  EXPECT_EQ(pixel(picture, 1, 3), (Pixel{250, 250, 249}));
  EXPECT_EQ(pixel(picture, 2, 3)[0], 40);
  EXPECT_EQ(pixel(picture, 9, 3)[0], 50);
  EXPECT_EQ(test::code_of([&] { in_rows({plain(1)}, 0); }), ErrorCode::BadArgument);
}

TEST(PanelRows, WordsKeepTheirSizeInLowPictures) {
  PictureStyle style;
  style.text_size = 30.0;
  ColorScale scale;
  scale.title = "a title";
  EXPECT_EQ(draw_color_bar(scale, 400, style).width, draw_color_bar(scale, 1200, style).width);
  const auto ink = [&](int height) {
    Picture plain{400, height, 3, {}};
    plain.pixels.assign(static_cast<std::size_t>(1200 * height), 200);
    const Picture picture = in_rows({{plain, "caption"}}, 1, style);
    int count = 0;
    EXPECT_EQ(picture.height, height + caption_height(style));
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < 400; ++x) {
        if (brightness(pixel(picture, x, y)) > 400) continue;
        EXPECT_GE(y, height);  // below the picture, not over it
        ++count;
      }
    }
    return count;
  };
  EXPECT_GT(ink(200), 300);
  EXPECT_EQ(ink(200), ink(400));
}

}  // namespace
}  // namespace batten
