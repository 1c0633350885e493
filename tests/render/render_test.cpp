#include "batten/render/render.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/parallel/parallel.h"
#include "render/pixels.h"

namespace batten {
namespace {

using test::brightness;
using test::code_of;
using test::different_pixels;
using test::Pixel;
using test::pixel;
using test::small_front_view;
using test::sphere_scene;

const Pixel kBackground = {250, 250, 249};  // sRGB of 0.96, 0.96, 0.95

Picture picture_without_ground(const Scene& scene) {
  RenderOptions options = small_front_view();
  options.ground = Ground::None;
  return render(scene, options);
}

TEST(Render, SphereCoversItsProjectedDisc) {
  const Picture picture = picture_without_ground(sphere_scene());
  double covered = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) covered += pixel(picture, x, y) != kBackground ? 1.0 : 0.0;
  }
  // The fit makes the sphere's silhouette a circle of 85 % of the height; pixels at its rim count in part.
  const double radius = 0.5 * 0.85 * picture.height;
  const double rim = 2.0 * std::numbers::pi * radius;
  EXPECT_NEAR(covered, std::numbers::pi * radius * radius + 0.5 * rim, 0.35 * rim);
}

TEST(Render, SphereIsCentredAndRound) {
  const Picture picture = picture_without_ground(sphere_scene());
  int left = picture.width;
  int right = 0;
  int top = picture.height;
  int bottom = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (pixel(picture, x, y) == kBackground) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  EXPECT_NEAR(left + right, picture.width - 1, 1);
  EXPECT_NEAR(top + bottom, picture.height - 1, 1);
  EXPECT_NEAR(right - left, bottom - top, 2);
  EXPECT_NEAR(bottom - top + 1, 0.85 * picture.height, 1.5);
}

TEST(Render, SurfaceIsWarmAndLitFromTheUpperLeft) {
  const Picture picture = picture_without_ground(sphere_scene());
  const Pixel centre = pixel(picture, 120, 90);
  EXPECT_GT(centre[0], centre[1] + 15);
  EXPECT_GT(centre[1], centre[2] + 25);
  EXPECT_GT(centre[0], 150);
  EXPECT_LT(centre[0], 250);
  EXPECT_GT(brightness(pixel(picture, 90, 60)), brightness(pixel(picture, 150, 130)) + 100);
}

TEST(Render, GivenColorsAreDrawn) {
  Scene scene = sphere_scene();
  scene.colors = Values::Zero(scene.surface.vertex_count(), 3);
  scene.colors.col(2).setConstant(0.6);
  const Pixel centre = pixel(picture_without_ground(scene), 120, 90);
  EXPECT_GT(centre[2], centre[0] + 60);
}

TEST(Render, ScalarsAreDrawnInTheColoursOfTheirScale) {
  Scene scene = sphere_scene();
  scene.scalars = scene.surface.points.col(0);
  scene.scale = fit_color_scale(scene.scalars, {"x", "", ColorMap::Diverging, 0.0, false, false, 0.0});
  const Picture picture = picture_without_ground(scene);
  const Pixel left = pixel(picture, 60, 90);
  const Pixel right = pixel(picture, 180, 90);
  EXPECT_GT(left[2], left[0] + 60);
  EXPECT_GT(right[0], right[2] + 40);
  const Pixel middle = pixel(picture, 120, 90);
  EXPECT_NEAR(middle[0], middle[2], 14);
  scene.scalars.setConstant(std::numeric_limits<double>::quiet_NaN());
  const Pixel missing = pixel(picture_without_ground(scene), 60, 90);
  EXPECT_NEAR(missing[0], missing[2], 20);
  scene.scalars.resize(3);
  EXPECT_EQ(code_of([&] { render(scene); }), ErrorCode::BadShape);
}

/// Changes between light and dark along the middle row.
int bands(const Picture& picture) {
  int changes = 0;
  int before = -1;
  for (int x = 0; x < picture.width; ++x) {
    const int light = brightness(pixel(picture, x, picture.height / 2));
    if (light > 250 && light < 450) continue;  // an edge between bands
    const int side = light >= 450 ? 1 : 0;
    changes += before >= 0 && side != before ? 1 : 0;
    before = side;
  }
  return changes;
}

TEST(Render, ZebraHasBandsOnASphereAndNoneOnAPlane) {
  Scene scene = sphere_scene();
  RenderOptions options = small_front_view();
  options.ground = Ground::None;
  EXPECT_LE(bands(render(scene, options)), 4);
  options.shading = Shading::Zebra;
  EXPECT_GE(bands(render(scene, options)), 12);
  scene.surface = grid(4, 4);
  options.direction = {0.0, 0.0, 1.0};
  EXPECT_LE(bands(render(scene, options)), 6);
}

TEST(Render, ZebraBreaksWhereCornerNormalsDo) {
  // A sphere whose right half has its normals bent: the bands jump at the seam, and only there.
  Scene scene = sphere_scene();
  RenderOptions options = small_front_view();
  options.shading = Shading::Zebra;
  const Picture smooth = render(scene, options);
  Values normals(static_cast<Eigen::Index>(scene.surface.face_vertices.size()), 3);
  for (std::size_t c = 0; c < scene.surface.face_vertices.size(); ++c)
    normals.row(static_cast<Eigen::Index>(c)) = scene.surface.points.row(scene.surface.face_vertices[c]);
  scene.normals = normals;
  const Picture same = render(scene, options);
  for (Index f = 0; f < scene.surface.face_count(); ++f) {
    double across = 0.0;
    for (Index c = scene.surface.face_offsets[f]; c < scene.surface.face_offsets[f + 1]; ++c)
      across += scene.surface.points(scene.surface.face_vertices[c], 0);
    if (across <= 0.0) continue;
    for (Index c = scene.surface.face_offsets[f]; c < scene.surface.face_offsets[f + 1]; ++c)
      scene.normals.row(c) += Eigen::RowVector3d(0.4, 0.0, 0.0);
  }
  const Picture bent = render(scene, options);
  const auto changed = [&](const Picture& picture, int from, int to) {
    int count = 0;
    for (int y = 40; y < 140; ++y) {
      for (int x = from; x < to; ++x)
        count += std::abs(brightness(pixel(picture, x, y)) - brightness(pixel(smooth, x, y))) > 90 ? 1 : 0;
    }
    return count;
  };
  EXPECT_LT(changed(same, 60, 180), 60);
  EXPECT_LT(changed(bent, 60, 117), 60);
  EXPECT_GT(changed(bent, 123, 180), 1000);
}

TEST(Render, TransparentOverItsBackgroundIsTheOpaquePicture) {
  RenderOptions options = small_front_view();
  options.direction = {0.3, -1.0, 0.6};
  const Picture opaque = render(sphere_scene(), options);
  options.style.transparent = true;
  const Picture clear = render(sphere_scene(), options);
  ASSERT_EQ(clear.channels, 4);
  double sum = 0.0;
  for (std::size_t i = 0; i < clear.pixels.size() / 4; ++i) {
    const double alpha = clear.pixels[4 * i + 3] / 255.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double over = alpha * clear.pixels[4 * i + c] + (1.0 - alpha) * kBackground[c];
      sum += std::abs(over - opaque.pixels[3 * i + c]);
    }
  }
  // The shadow is a little bluer than black, and edges are blended in sRGB instead of in light.
  EXPECT_LT(sum / static_cast<double>(opaque.pixels.size()), 0.6);
  EXPECT_EQ(clear.pixels[3], 0);                           // a corner
  EXPECT_EQ(clear.pixels[4 * (90 * 240 + 120) + 3], 255);  // the middle
}

TEST(Render, BackSidesAreCooler) {
  Scene scene;
  scene.surface = grid(4, 4);
  RenderOptions options = small_front_view();
  options.direction = {0.0, -0.1, 1.0};
  const Pixel front = pixel(render(scene, options), 120, 90);
  options.direction = {0.0, -0.1, -1.0};
  const Pixel back = pixel(render(scene, options), 120, 90);
  EXPECT_GT(front[0], front[2]);
  EXPECT_LT(back[0], back[2]);
}

TEST(Render, EdgesOfThePictureAreBackground) {
  const Picture picture = render(sphere_scene(), small_front_view());
  for (int x = 0; x < picture.width; ++x) {
    EXPECT_EQ(pixel(picture, x, 0), kBackground);
    EXPECT_EQ(pixel(picture, x, picture.height - 1), kBackground);
  }
  for (int y = 0; y < picture.height; ++y) {
    EXPECT_EQ(pixel(picture, 0, y), kBackground);
    EXPECT_EQ(pixel(picture, picture.width - 1, y), kBackground);
  }
}

TEST(Render, ShadowFallsOnTheGroundAwayFromTheKeyLight) {
  RenderOptions options = small_front_view();
  options.direction = {0.0, -1.0, 0.6};
  const Picture shadow = render(sphere_scene(), options);
  options.ground = Ground::None;
  const Picture none = render(sphere_scene(), options);
  // Beside the sphere's foot: dark to the right, where the key light does not reach, light to the left.
  const int right = brightness(pixel(shadow, 200, 120));
  const int left = brightness(pixel(shadow, 40, 120));
  EXPECT_LT(right, brightness(kBackground) - 60);
  EXPECT_GT(left, right + 40);
  EXPECT_EQ(pixel(none, 200, 120), kBackground);
}

TEST(Render, OneBodyShadesAnother) {
  Scene scene;
  scene.surface = grid(8, 8);
  RenderOptions options = small_front_view();
  options.direction = {0.0, -0.3, 1.0};
  const int open = brightness(pixel(render(scene, options), 120, 90));
  // A plate over a quarter of the sheet, between its middle and the light, but out of the eye's way.
  Mesh plate = grid(1, 1);
  const Index first = scene.surface.vertex_count();
  Points both(first + 4, 3);
  both.topRows(first) = scene.surface.points;
  both.bottomRows(4) = 0.3 * plate.points;
  both.bottomRows(4).rowwise() += Eigen::RowVector3d(-0.35, -0.15, 0.6);
  scene.surface.points = both;
  scene.surface.add_face({first, first + 1, first + 3, first + 2});
  const Picture picture = render(scene, options);
  int darkest = open;
  for (int y = 60; y < 120; ++y) {
    for (int x = 120; x < 150; ++x) darkest = std::min(darkest, brightness(pixel(picture, x, y)));
  }
  EXPECT_LT(darkest, open - 100);
}

TEST(Render, MarkerIsADarkBlueDot) {
  Scene scene = sphere_scene();
  const Picture without = picture_without_ground(scene);
  scene.markers.resize(1, 3);
  scene.markers.row(0) << 0.0, -1.0, 0.0;
  RenderOptions options = small_front_view();
  options.ground = Ground::None;
  options.marker_radius = 0.1;
  const Picture with = render(scene, options);
  const Pixel centre = pixel(with, 120, 90);
  EXPECT_LT(brightness(centre), 300);
  EXPECT_GT(centre[2], centre[0]);
  // The eye is about 5 radii away: the marker shows larger than on the silhouette, by 1.25.
  const double radius = 0.1 * 1.25 * 0.5 * 0.85 * 180;
  EXPECT_NEAR(different_pixels(with, without), std::numbers::pi * radius * radius,
              0.35 * std::numbers::pi * radius * radius);
}

TEST(Render, TooManyMarkersAreDroppedUnlessARadiusIsGiven) {
  Scene scene = sphere_scene();
  RenderOptions options = small_front_view();
  const Picture without = render(scene, options);
  scene.markers = Points::Zero(20001, 3);
  for (Index i = 0; i < 20001; ++i) scene.markers.row(i) = scene.surface.points.row(i % scene.surface.vertex_count());
  EXPECT_EQ(different_pixels(render(scene, options), without), 0);
  options.marker_radius = 0.01;
  EXPECT_GT(different_pixels(render(scene, options), without), 100);
}

TEST(Render, LinesAreDrawnOncePerEdge) {
  Scene scene = sphere_scene();
  RenderOptions options = small_front_view();
  const Picture without = render(scene, options);
  scene.lines = cube();
  scene.lines.points *= 0.8;  // its edges stand out of the sphere, its faces do not
  const Picture with = render(scene, options);
  EXPECT_GT(different_pixels(with, without), 100);
  EXPECT_LT(different_pixels(with, without), 5000);
}

TEST(Render, SameBitsForAnyNumberOfThreads) {
  Scene scene;
  scene.surface = torus(300, 150);
  scene.markers = scene.surface.points.topRows(500);
  scene.lines = torus(20, 10);
  RenderOptions options;
  options.width = 333;
  options.height = 251;
  const Picture free = render(scene, options);
  const ThreadLimit limit(1);
  EXPECT_EQ(render(scene, options).pixels, free.pixels);
}

TEST(Render, SamplesConvergeToTheSamePicture) {
  RenderOptions options = small_front_view();
  const Picture two = render(sphere_scene(), options);
  options.samples = 6;
  const Picture six = render(sphere_scene(), options);
  double sum = 0.0;
  for (std::size_t i = 0; i < two.pixels.size(); ++i) sum += std::abs(int{two.pixels[i]} - int{six.pixels[i]});
  EXPECT_LT(sum / static_cast<double>(two.pixels.size()), 0.6);
}

TEST(Render, FarAwayAndTinyShapesLookTheSame) {
  Scene scene;
  scene.surface = cube();
  const RenderOptions options = small_front_view();
  const Picture plain = render(scene, options);
  scene.surface.points *= 1e-6;
  scene.surface.points.rowwise() += Eigen::RowVector3d(8.0, -4.0, 2.0);
  EXPECT_LT(different_pixels(render(scene, options), plain), 30);
}

TEST(Render, RefusesWhatItCannotDraw) {
  EXPECT_EQ(code_of([] { render(Scene()); }), ErrorCode::BadArgument);
  Scene scene = sphere_scene();
  scene.surface.points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([&] { render(scene); }), ErrorCode::NotFinite);
  scene = sphere_scene();
  scene.normals = Values::Zero(2, 3);
  EXPECT_EQ(code_of([&] { render(scene); }), ErrorCode::BadShape);
  scene = sphere_scene();
  scene.surface.face_vertices[0] = 100000;
  EXPECT_EQ(code_of([&] { render(scene); }), ErrorCode::IndexOutOfRange);
  RenderOptions options;
  options.width = 0;
  EXPECT_EQ(code_of([&] { render(sphere_scene(), options); }), ErrorCode::BadArgument);
  options = {};
  options.direction = {0.0, 0.0, 0.0};
  EXPECT_EQ(code_of([&] { render(sphere_scene(), options); }), ErrorCode::BadArgument);
  options = {};
  options.marker_radius = -1.0;
  EXPECT_EQ(code_of([&] { render(sphere_scene(), options); }), ErrorCode::BadArgument);
}

TEST(Render, ProgressGrowsAndCancels) {
  double last = -1.0;
  render(sphere_scene(), small_front_view(), [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  const Progress stop = [](double done) { return done < 0.5; };
  EXPECT_EQ(code_of([&] { render(sphere_scene(), small_front_view(), stop); }), ErrorCode::Cancelled);
}

TEST(Render, DrawsASinglePointAndASinglePixel) {
  Scene scene;
  scene.markers = Points::Zero(1, 3);
  RenderOptions options = small_front_view();
  options.marker_radius = 0.01;
  EXPECT_LT(brightness(pixel(render(scene, options), 120, 90)), 300);
  options = {};
  options.width = 1;
  options.height = 1;
  EXPECT_EQ(render(sphere_scene(), options).pixels.size(), 3U);
}

}  // namespace
}  // namespace batten
