#include "batten/render/color_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "batten/render/panels.h"
#include "batten/render/srgb.h"
#include "render/pixels.h"

namespace batten {
namespace {

using test::brightness;
using test::code_of;
using test::Pixel;
using test::pixel;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

float luminance(const Color& color) { return 0.2126F * color[0] + 0.7152F * color[1] + 0.0722F * color[2]; }

ScaleRequest request(ColorMap map, double outliers = 0.0) {
  ScaleRequest asked{"height", "m", map};
  asked.outliers = outliers;
  return asked;
}

TEST(ColorMap, SequentialGrowsLighterAllTheWay) {
  for (int i = 0; i < 100; ++i)
    EXPECT_LT(luminance(map_color(ColorMap::Sequential, 0.01 * i)),
              luminance(map_color(ColorMap::Sequential, 0.01 * (i + 1))));
}

TEST(ColorMap, DivergingIsGreyInTheMiddleBlueBelowAndRedAbove) {
  const Color middle = map_color(ColorMap::Diverging, 0.5);
  EXPECT_EQ(middle[0], middle[1]);
  EXPECT_EQ(middle[1], middle[2]);
  EXPECT_EQ(map_color(ColorMap::Warm, 0.0), middle);
  for (int i = 1; i <= 10; ++i) {
    const Color cool = map_color(ColorMap::Diverging, 0.5 - 0.05 * i);
    const Color warm = map_color(ColorMap::Diverging, 0.5 + 0.05 * i);
    EXPECT_GT(cool[2], cool[0]);
    EXPECT_GT(warm[0], warm[2]);
    EXPECT_NEAR(luminance(cool), luminance(warm), 0.06F);
  }
}

TEST(ColorScale, DivergingReachesAsFarToBothSidesOfItsMiddle) {
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(101, -1.0, 3.0);
  const ColorScale scale = fit_color_scale(values, request(ColorMap::Diverging));
  EXPECT_EQ(scale.low, -3.0);
  EXPECT_EQ(scale.high, 3.0);
  EXPECT_EQ(scale.lowest, -1.0);
  EXPECT_EQ(scale.position(0.0), 0.5);
  EXPECT_EQ(scale.position(1e9), 1.0);
  EXPECT_TRUE(std::isnan(scale.position(kNaN)));
}

TEST(ColorScale, OneSidedNumbersHaveAOneSidedBar) {
  ColorScale scale = fit_color_scale(Eigen::VectorXd::LinSpaced(11, 0.1, 2.0), request(ColorMap::Diverging));
  EXPECT_EQ(scale.map, ColorMap::Warm);
  EXPECT_EQ(scale.low, 0.0);  // it would start near the middle
  EXPECT_EQ(scale.high, 2.0);
  scale = fit_color_scale(Eigen::VectorXd::LinSpaced(11, -5.0, -4.0), request(ColorMap::Diverging));
  EXPECT_EQ(scale.map, ColorMap::Cool);
  EXPECT_EQ(scale.low, -5.0);
  EXPECT_EQ(scale.high, -4.0);
  EXPECT_EQ(map_color(ColorMap::Cool, 1.0), map_color(ColorMap::Diverging, 0.5));
  EXPECT_EQ(map_color(ColorMap::Cool, 0.0), map_color(ColorMap::Diverging, 0.0));
  ScaleRequest around_four = request(ColorMap::Diverging);
  around_four.middle = 4.0;
  scale = fit_color_scale(Eigen::VectorXd::LinSpaced(3, 4.0, 6.0), around_four);
  EXPECT_EQ(scale.map, ColorMap::Warm);
  EXPECT_EQ(scale.low, 4.0);
}

TEST(ColorScale, OutliersDoNotTakeTheBar) {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(1001, 5.0, 6.0);
  values[3] = 1e6;
  values[7] = -1e6;
  values[9] = kNaN;
  const ColorScale scale = fit_color_scale(values, request(ColorMap::Sequential, 0.01));
  EXPECT_NEAR(scale.low, 5.0, 0.02);
  EXPECT_NEAR(scale.high, 6.0, 0.02);
  EXPECT_EQ(scale.lowest, -1e6);
  EXPECT_EQ(scale.highest, 1e6);
}

TEST(ColorScale, AFewNumbersDoNotTakeTheBarByDefault) {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(1000, 0.0, 1.0);
  values[500] = 1e6;
  const ColorScale scale = fit_color_scale(values, {"height", "m"});
  EXPECT_LE(scale.high, 1.0);
  EXPECT_GT(scale.high, 0.9);
  EXPECT_NEAR(scale.share_above, 0.02, 0.002);
  EXPECT_EQ(scale.share_below, 0.0);
  EXPECT_EQ(scale.highest, 1e6);
}

TEST(ColorScale, WhatFewNumbersOnlyDifferByIsShown) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(1000);
  values[7] = 3.0;
  const ColorScale scale = fit_color_scale(values, {"moved", "m"});
  EXPECT_EQ(scale.low, 0.0);
  EXPECT_EQ(scale.high, 3.0);
  EXPECT_EQ(scale.share_above, 0.0);
}

TEST(ColorScale, ARangeIsTakenAsItIs) {
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(101, -1.0, 3.0);
  for (const ColorMap map : {ColorMap::Sequential, ColorMap::Diverging}) {
    ScaleRequest asked = request(map);
    asked.range = {-0.5, 2.0};
    const ColorScale scale = fit_color_scale(values, asked);
    EXPECT_EQ(scale.low, -0.5);
    EXPECT_EQ(scale.high, 2.0);
    EXPECT_NEAR(scale.share_below, 13.0 / 101.0, 1e-12);
    EXPECT_NEAR(scale.share_above, 25.0 / 101.0, 1e-12);
    asked.range = {2.0, 2.0};
    EXPECT_EQ(code_of([&] { fit_color_scale(values, asked); }), ErrorCode::BadArgument);
  }
}

TEST(ColorScale, LogarithmsHaveEqualStepsForEqualRatios) {
  Eigen::VectorXd values(5);
  values << 0.0, 1e-12, 1e-10, 1e-8, 1e-6;
  ScaleRequest asked = request(ColorMap::Sequential);
  asked.log = true;
  const ColorScale scale = fit_color_scale(values, asked);
  EXPECT_TRUE(scale.log);
  EXPECT_NEAR(scale.position(1e-9), 0.5, 1e-12);
  EXPECT_EQ(scale.position(0.0), 0.0);
  EXPECT_FALSE(fit_color_scale(Eigen::VectorXd::Zero(4), asked).log);
}

TEST(ColorScale, OneNumberStillMakesABar) {
  for (const double value : {0.0, 4.0, -2.5, 1e-300}) {
    for (const ColorMap map : {ColorMap::Sequential, ColorMap::Diverging, ColorMap::Warm}) {
      const ColorScale scale = fit_color_scale(Eigen::VectorXd::Constant(3, value), request(map));
      EXPECT_LT(scale.low, scale.high);
      EXPECT_TRUE(std::isfinite(scale.position(value)));
    }
  }
  EXPECT_LT(fit_color_scale(Eigen::VectorXd(), request(ColorMap::Sequential)).low, 1.0);
  EXPECT_EQ(code_of([] { fit_color_scale(Eigen::VectorXd(), request(ColorMap::Sequential, 0.5)); }),
            ErrorCode::BadArgument);
}

/// Rows of a column where the pixels are that colour, to within a byte or two.
int rows_of(const Picture& picture, int x, const Color& color) {
  const auto byte = [](float c) { return static_cast<int>(std::lround(255.0F * render_detail::encode_srgb(c))); };
  int rows = 0;
  for (int y = 0; y < picture.height; ++y) {
    const Pixel p = pixel(picture, x, y);
    bool same = true;
    for (std::size_t c = 0; c < 3; ++c) same = same && std::abs(p[c] - byte(color[c])) <= 2;
    rows += same ? 1 : 0;
  }
  return rows;
}

TEST(ColorBar, RunsThroughTheMapWithTicksWhereTheyBelong) {
  ColorScale scale = fit_color_scale(Eigen::VectorXd::LinSpaced(11, 0.0, 10.0), request(ColorMap::Sequential));
  const int height = 1200;
  const Picture bar = draw_color_bar(scale, height);
  ASSERT_GT(bar.width, 150);
  const int inside = 60;  // 40 pixels of edge, then 44 of bar
  std::vector<int> rows;
  for (int y = 1; y < height; ++y) {
    const bool coloured = pixel(bar, inside, y)[1] < 240 || pixel(bar, inside, y)[2] < 200;
    const bool tick = brightness(pixel(bar, 90, y)) < 300;
    if (coloured && tick && (rows.empty() || y > rows.back() + 5)) rows.push_back(y);
  }
  // 0, 2, 4, 6, 8, 10 at equal distances, from the bottom to the top of 640 pixels.
  ASSERT_GE(rows.size(), 5U);  // the bottom one's row may be the first below the bar
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_NEAR(rows[i] - rows[i - 1], 128, 2);
  EXPECT_GT(rows_of(bar, inside, map_color(ColorMap::Sequential, 1.0)), 0);
  EXPECT_GT(rows_of(bar, inside, map_color(ColorMap::Sequential, 0.0)), 0);
}

TEST(ColorBar, EndsInAnArrowOnlyWhereNumbersLieBeyond) {
  ColorScale scale = fit_color_scale(Eigen::VectorXd::LinSpaced(11, 0.0, 10.0), request(ColorMap::Sequential));
  const Color top = map_color(ColorMap::Sequential, 1.0);
  const int middle = 62;
  const int without = rows_of(draw_color_bar(scale, 1200), middle, top);
  scale.highest = 99.0;
  EXPECT_NEAR(rows_of(draw_color_bar(scale, 1200), middle, top) - without, 26, 2);
}

TEST(Panels, StandBesideEachOther) {
  Picture red{4, 6, 3, Buffer<unsigned char>(72)};
  for (std::size_t i = 0; i < red.pixels.size(); ++i) red.pixels[i] = i % 3 == 0 ? 255 : 0;
  Picture blue{2, 2, 4, Buffer<unsigned char>(16)};
  for (std::size_t i = 0; i < blue.pixels.size(); ++i) blue.pixels[i] = i % 4 >= 2 ? 255 : 0;
  const Picture both = beside({{red, ""}, {blue, ""}});
  EXPECT_EQ(both.width, 6);
  EXPECT_EQ(both.height, 6);
  EXPECT_EQ(pixel(both, 3, 5), (Pixel{255, 0, 0}));
  EXPECT_EQ(pixel(both, 4, 2), (Pixel{0, 0, 255}));
  EXPECT_EQ(pixel(both, 4, 1), (Pixel{250, 250, 249}));
  PictureStyle clear;
  clear.transparent = true;
  const Picture over = beside({{red, ""}, {blue, ""}}, clear);
  EXPECT_EQ(over.channels, 4);
  EXPECT_EQ(over.pixels[4 * (1 * 6 + 4) + 3], 0);
  EXPECT_EQ(over.pixels[4 * (2 * 6 + 4) + 3], 255);
  EXPECT_EQ(code_of([] { beside({}); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([] { beside({{Picture(), ""}}); }), ErrorCode::BadShape);
}

TEST(Panels, CaptionsAreWrittenAtTheFoot) {
  Picture plain{300, 200, 3, {}};
  plain.pixels.assign(180000, 200);
  const Picture picture = beside({{plain, "before"}, {plain, "after"}});
  int ink = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 600; ++x) {
      if (brightness(pixel(picture, x, y)) > 540) continue;
      ++ink;
      EXPECT_GT(y, 180);
    }
  }
  EXPECT_GT(ink, 30);
}

}  // namespace
}  // namespace batten
