#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/render/canvas.h"
#include "batten/render/color_scale.h"
#include "batten/render/ticks.h"

namespace batten {
namespace {

using namespace render_detail;

constexpr int kStripes = 256;  // each of one colour

/// "2 % up to 31.4": what lies beyond an end.
std::string beyond_text(double share, const char* words, double extreme) {
  const double percent = 100.0 * share;
  const std::string amount = percent < 0.1 ? "< 0.1" : number_text(percent, percent < 1.0 ? 1 : 2);
  return amount + " % " + words + " " + number_text(extreme);
}

struct Words {
  std::string text;
  Spot at;
  TextStyle style;
};

/// The positions of all parts in pixels. The width is known once all labels are known.
class BarLayout {
 public:
  BarLayout(const ColorScale& scale, int height, const PictureStyle& style)
      : scale_(scale), unit_(unit_of(height, style)), ink_(text_ink(style)), measure_(1, 1, Canvas::Kind::Picture) {
    const double centre = 0.5 * height + 30 * unit_;
    const double reach = std::clamp(0.5 * height - kWords * unit_, unit_, 320 * unit_);
    top_ = centre - reach;
    bottom_ = centre + reach;
    TextStyle title{30 * unit_, ink_, Align::Left, true};
    add({scale.title, {0.0, top_ - 132 * unit_}, title});
    add({scale.unit, {0.0, top_ - 92 * unit_}, {26 * unit_, soft()}});
    for (const Tick& tick : ticks()) {
      const double y = level(tick.value);
      tick_heights_.push_back(y);
      add({tick.text, {kBar * unit_ + 20 * unit_, y + 9.5 * unit_}, {26 * unit_, ink_}});
    }
    if (reaches_above())
      add({beyond_text(scale.share_above, "up to", scale.highest), {0.0, top_ - 46 * unit_}, {24 * unit_, soft()}});
    if (reaches_below())
      add({beyond_text(scale.share_below, "down to", scale.lowest), {0.0, bottom_ + 64 * unit_}, {24 * unit_, soft()}});
  }

  int width() const { return static_cast<int>(std::ceil(right_ + 2 * kEdge * unit_)); }

  void draw(Canvas& canvas) const {
    const double left = kEdge * unit_;
    const double step = (bottom_ - top_) / kStripes;
    for (int i = 0; i < kStripes; ++i) {
      // Each stripe extends under the next one to hide seams.
      const double y = top_ + i * step;
      canvas.rectangle({left, y}, {kBar * unit_, std::min(step + 1.0, bottom_ - y)},
                       ink_of(map_color(scale_.map, (kStripes - 1 - i) / (kStripes - 1.0))));
    }
    arrow(canvas, top_, -1.0, 1.0, reaches_above());
    arrow(canvas, bottom_, 1.0, 0.0, reaches_below());
    for (const double y : tick_heights_)
      canvas.line({{left + kBar * unit_, y}, {left + (kBar + 10) * unit_, y}}, {2 * unit_, ink_});
    for (const Words& words : words_) canvas.text(words.at + Spot(left, 0.0), words.text, words.style);
  }

 private:
  static constexpr double kBar = 44;
  static constexpr double kEdge = 40;
  static constexpr double kArrow = 26;

  static constexpr double kWords = 135;  // above the bar, and below it

  /// A bar of 640 units, in a picture of 1200.
  static double unit_of(int height, const PictureStyle& style) {
    return style.text_size > 0.0 ? 34.0 * style.text_size / 1200.0 : height / 1200.0;
  }

  Ink soft() const { return {ink_.red, ink_.green, ink_.blue, 0.72}; }
  bool reaches_above() const { return scale_.highest > scale_.high + 1e-9 * std::abs(scale_.high); }
  bool reaches_below() const { return scale_.lowest < scale_.low - 1e-9 * std::abs(scale_.low); }
  double level(double value) const { return bottom_ - scale_.position(value) * (bottom_ - top_); }

  std::vector<Tick> ticks() const {
    constexpr double kPerTick = 90;  // units
    const int wanted = std::clamp(static_cast<int>((bottom_ - top_) / (kPerTick * unit_)), 2, 6);
    if (scale_.log) return log_ticks(scale_.low, scale_.high, std::min(7, wanted + 1));
    const double range = scale_.high - scale_.low;
    std::vector<Tick> found =
        linear_ticks(scale_.low, scale_.high, scale_.whole ? std::clamp(static_cast<int>(range), 1, wanted) : wanted);
    if (scale_.whole) std::erase_if(found, [](const Tick& tick) { return tick.value != std::round(tick.value); });
    return found;
  }

  void add(Words words) {
    if (words.text.empty()) return;
    right_ = std::max(right_, words.at.x() + measure_.text_width(words.text, words.style));
    words_.push_back(std::move(words));
  }

  void arrow(Canvas& canvas, double y, double way, double position, bool shown) const {
    if (!shown) return;
    const double left = kEdge * unit_;
    canvas.polygon({{left, y}, {left + kBar * unit_, y}, {left + 0.5 * kBar * unit_, y + way * kArrow * unit_}},
                   ink_of(map_color(scale_.map, position)));
  }

  const ColorScale& scale_;
  double unit_;
  Ink ink_;
  Canvas measure_;
  double top_;
  double bottom_;
  double right_ = 0.0;
  std::vector<Words> words_;
  std::vector<double> tick_heights_;
};

}  // namespace

Picture draw_color_bar(const ColorScale& scale, int height, const PictureStyle& style) {
  if (height < 16 || height > 32768)
    throw Error(ErrorCode::BadArgument, "a colour bar's height must be 16 to 32768 pixels");
  const BarLayout layout(scale, height, style);
  Canvas canvas(layout.width(), height, style.transparent ? Canvas::Kind::Clear : Canvas::Kind::Picture);
  if (!style.transparent) canvas.fill(ink_of(style.background));
  layout.draw(canvas);
  return canvas.picture();
}

}  // namespace batten
