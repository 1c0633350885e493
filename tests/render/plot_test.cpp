#include "batten/render/plot.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "batten/render/ticks.h"
#include "render/pixels.h"

namespace batten {
namespace {

using test::code_of;
using test::Pixel;
using test::pixel;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Falls by ten a step: on a logarithmic axis a straight line from the upper left to the lower right.
Plot falling() {
  Plot plot;
  plot.title = "Falling";
  plot.x_label = "step";
  plot.y_label = "size";
  plot.log_y = true;
  PlotLine line{"one", {}, {}, false};
  for (int i = 0; i <= 80; ++i) {
    line.x.push_back(0.1 * i);
    line.y.push_back(std::pow(10.0, -0.1 * i));
  }
  plot.lines.push_back(line);
  return plot;
}

bool is_blue(const Pixel& p) { return p[2] > p[0] + 50; }

TEST(Plot, LogarithmicLineIsStraightAcrossTheArea) {
  const Picture picture = draw_plot(falling(), 640, 400);
  // The line's left and right ends, then every column between them has ink on the straight line.
  int left = -1;
  int right = -1;
  std::vector<double> centre(640, -1.0);
  for (int x = 0; x < 540; ++x) {
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < picture.height; ++y) {
      if (!is_blue(pixel(picture, x, y))) continue;
      sum += y;
      ++count;
    }
    if (count == 0) continue;
    if (left < 0) left = x;
    right = x;
    centre[x] = sum / count;
  }
  ASSERT_GT(right - left, 400);
  for (int x = left + 4; x < right - 4; ++x) {
    const double along = static_cast<double>(x - left) / (right - left);
    EXPECT_NEAR(centre[x], centre[left] + along * (centre[right] - centre[left]), 2.5) << x;
  }
  EXPECT_GT(centre[right] - centre[left], 200);
}

TEST(Plot, EveryLineHasItsColourAndItsName) {
  Plot plot = falling();
  for (int k = 1; k < 4; ++k) {
    PlotLine line = plot.lines[0];
    line.name = "line " + std::to_string(k);
    for (double& y : line.y) y = std::pow(y, 1.0 / (1 + k));
    plot.lines.push_back(line);
  }
  const Picture picture = draw_plot(plot, 640, 400);
  std::set<Pixel> found;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) found.insert(pixel(picture, x, y));
  }
  for (const Pixel& color : {Pixel{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}})
    EXPECT_EQ(found.count(color), 1U) << color[0];
}

TEST(Plot, LinesThatEndTogetherGetALegend) {
  Plot plot = falling();
  const Picture alone = draw_plot(plot, 640, 400);
  // Twelve lines with one end: no room for twelve names there.
  for (int k = 0; k < 11; ++k) plot.lines.push_back(plot.lines[0]);
  const Picture crowded = draw_plot(plot, 640, 400);
  const auto names = [](const Picture& picture) {
    int rows = 0;
    bool before = false;
    for (int y = 0; y < 340; ++y) {
      bool ink = false;
      for (int x = 605; x < 640; ++x) ink = ink || pixel(picture, x, y)[0] < 120;
      rows += ink && !before ? 1 : 0;
      before = ink;
    }
    return rows;
  };
  EXPECT_LE(names(alone), 1);
  EXPECT_GE(names(crowded), 12);
}

TEST(Plot, GapsBreakTheLineAndZerosAreLeftOutOfLogarithms) {
  Plot plot = falling();
  plot.lines[0].y[4] = 0.0;
  plot.lines[0].y[6] = kNoNumber;
  EXPECT_EQ(draw_plot(plot, 300, 200).pixels.size(), 3U * 300U * 200U);
  // Without a positive number the axis is linear.
  for (double& y : plot.lines[0].y) y = 0.0;
  EXPECT_EQ(draw_plot(plot, 300, 200).width, 300);
  for (double& y : plot.lines[0].y) y = kNoNumber;
  EXPECT_EQ(code_of([&] { draw_plot(plot); }), ErrorCode::BadArgument);
}

TEST(Plot, RefusesWhatIsNoPlot) {
  Plot plot = falling();
  EXPECT_EQ(code_of([&] { draw_plot(plot, 100, 400); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([&] { write_plot("plot.jpg", plot); }), ErrorCode::UnknownFormat);
  plot.lines[0].x[1] = kNoNumber;
  EXPECT_EQ(code_of([&] { draw_plot(plot); }), ErrorCode::NotFinite);
  plot.lines[0].x.pop_back();
  EXPECT_EQ(code_of([&] { draw_plot(plot); }), ErrorCode::BadShape);
}

TEST(Plot, SvgHasTheSameSize) {
  const Buffer<unsigned char> bytes = encode_svg(falling(), 640, 400);
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find("<svg"), std::string::npos);
  EXPECT_NE(text.find("viewBox=\"0 0 640 400\""), std::string::npos) << text.substr(0, 300);
  EXPECT_NE(text.rfind("</svg>"), std::string::npos);
}

std::string texts(const std::vector<render_detail::Tick>& ticks) {
  std::string all;
  for (const render_detail::Tick& tick : ticks) all += (all.empty() ? "" : " ") + tick.text;
  return all;
}

TEST(Ticks, AreRoundNumbers) {
  EXPECT_EQ(texts(render_detail::linear_ticks(0.0, 31.0, 7)), "0 5 10 15 20 25 30");
  EXPECT_EQ(texts(render_detail::linear_ticks(-0.31, 0.3, 4)), "\u22120.2 0 0.2");
  EXPECT_EQ(texts(render_detail::linear_ticks(0.0, 1000.0, 5)), "0 200 400 600 800 1000");
  EXPECT_EQ(texts(render_detail::linear_ticks(0.0, 3e-7, 3)),
            "0 1\u00D710\u207B\u2077 2\u00D710\u207B\u2077 3\u00D710\u207B\u2077");
  EXPECT_EQ(texts(render_detail::log_ticks(1e-10, 1.0, 7)),
            "10\u207B\u00B9\u2070 10\u207B\u2078 10\u207B\u2076 10\u207B\u2074 10\u207B\u00B2 1");
  EXPECT_EQ(texts(render_detail::log_ticks(0.9, 7.0, 7)), "1 2 5");
}

TEST(Ticks, NumbersAreShort) {
  EXPECT_EQ(render_detail::number_text(0.0), "0");
  EXPECT_EQ(render_detail::number_text(-1.5), "\u22121.5");
  EXPECT_EQ(render_detail::number_text(0.99999), "1");
  EXPECT_EQ(render_detail::number_text(1234.5), "1234");
  EXPECT_EQ(render_detail::number_text(3.79e-10), "3.79\u00D710\u207B\u00B9\u2070");
  EXPECT_EQ(render_detail::number_text(1e-10), "10\u207B\u00B9\u2070");
}

}  // namespace
}  // namespace batten
